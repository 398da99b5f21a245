//! What this machine can compute with.

/// A graphics adapter that wgpu sees.
#[derive(Clone, Debug)]
pub struct Adapter {
    /// Its name.
    pub name: String,
    /// Vulkan, Metal or DirectX 12.
    pub api: String,
    /// Driver and version.
    pub driver: String,
    /// True for a software adapter, which is never chosen in place of a GPU.
    pub software: bool,
}

/// The adapters in a fixed order; none if there is no driver.
pub fn adapters() -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let mut adapters: Vec<Adapter> = found
        .iter()
        .map(|adapter| {
            let info = adapter.get_info();
            Adapter {
                name: info.name,
                api: info.backend.to_string(),
                driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
                software: info.device_type == wgpu::DeviceType::Cpu,
            }
        })
        .collect();
    adapters.sort_by(|a, b| (a.software, &a.name, &a.api).cmp(&(b.software, &b.name, &b.api)));
    adapters
}
