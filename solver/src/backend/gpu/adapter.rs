//! The adapters of this machine, and the choice of one.

use crate::backend::error::{BackendError, VARIABLE};

/// A graphics adapter that wgpu sees.
#[derive(Clone, Debug)]
pub struct Adapter {
    /// Name of the device, as its driver states it.
    pub name: String,
    /// Vulkan, Metal or DirectX 12.
    pub api: String,
    /// Driver and version.
    pub driver: String,
    /// True for a software adapter, which is never chosen in place of a GPU.
    pub software: bool,
    /// Rank, the fastest kind first.
    rank: u8,
    pub(super) adapter: wgpu::Adapter,
}

impl Adapter {
    fn new(adapter: wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let rank = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::VirtualGpu => 1,
            wgpu::DeviceType::IntegratedGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        };
        Self {
            name: info.name,
            api: info.backend.to_string(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            software: info.device_type == wgpu::DeviceType::Cpu,
            rank,
            adapter,
        }
    }

    /// Whether it can time passes; see [`super::Gpu::timed`].
    pub fn has_clock(&self) -> bool {
        self.adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// The adapter that [`VARIABLE`] names, or else the best real GPU.
    pub fn chosen() -> Result<Self, BackendError> {
        let named = std::env::var(VARIABLE).ok().filter(|name| !name.is_empty());
        Self::among(adapters(), named.as_deref())
    }

    fn among(adapters: Vec<Self>, named: Option<&str>) -> Result<Self, BackendError> {
        let there = adapters.iter().map(|adapter| adapter.name.clone()).collect();
        let wanted = |adapter: &Self| match named {
            Some(part) => adapter.name.to_lowercase().contains(&part.to_lowercase()),
            None => !adapter.software,
        };
        adapters.into_iter().find(wanted).ok_or_else(|| match named {
            Some(named) => BackendError::NotThere { named: named.to_owned(), there },
            None => BackendError::NoGpu { there },
        })
    }
}

/// The adapters, the best first; none if there is no driver.
pub fn adapters() -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let mut adapters: Vec<Adapter> = found.into_iter().map(Adapter::new).collect();
    adapters.sort_by(|a, b| (a.rank, &a.name, &a.api).cmp(&(b.rank, &b.name, &b.api)));
    adapters
}
