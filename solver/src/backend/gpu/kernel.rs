//! Compute kernels and their bindings.

/// Source in every kernel: the layout of planes, and the index of a workgroup in a grid of two axes.
const COMMON: &str = include_str!("wgsl/common.wgsl");

/// A compiled kernel.
pub(super) struct Kernel {
    pub name: &'static str,
    pub pipeline: wgpu::ComputePipeline,
    pub layout: wgpu::BindGroupLayout,
}

impl Kernel {
    /// The entry point `main` of `source`. `bindings` has a letter for each binding of group 0: `u` a
    /// uniform, `r` a storage buffer that is read, `w` one that is written; `+` at the end stands for
    /// a slot of the step in group 1.
    pub fn new(device: &wgpu::Device, name: &'static str, source: &str, bindings: &str) -> Self {
        let entry = |(binding, letter): (usize, char)| {
            let ty = match letter {
                'u' => wgpu::BufferBindingType::Uniform,
                letter => wgpu::BufferBindingType::Storage { read_only: letter == 'r' },
            };
            wgpu::BindGroupLayoutEntry {
                binding: binding as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }
        };
        let (fixed, dynamic) = match bindings.strip_suffix('+') {
            Some(fixed) => (fixed, true),
            None => (bindings, false),
        };
        let entries: Vec<_> = fixed.chars().enumerate().map(entry).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(name),
            entries: &entries,
        });
        let slots = slot_layout(device);
        let groups = [Some(&layout), Some(&slots)];
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: if dynamic { &groups } else { &groups[..1] },
            immediate_size: 0,
        });
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl((COMMON.to_owned() + source).into()),
        };
        let checks = wgpu::ShaderRuntimeChecks {
            force_loop_bounding: false,
            ..wgpu::ShaderRuntimeChecks::checked()
        };
        // SAFETY: every loop of the kernels counts up to a constant or to a number of samples, texels
        // or workgroups that it was given, or halves a number until it is zero, so that all of them
        // end; indices stay checked. The guard
        // against endless loops would keep drivers from unrolling the networks' short ones.
        let module = unsafe { device.create_shader_module_trusted(descriptor, checks) };
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                // Every kernel writes workgroup memory before it reads it.
                zero_initialize_workgroup_memory: false,
                ..Default::default()
            },
            cache: None,
        });
        Self { name, pipeline, layout }
    }
}

/// The layout of the bindings of a step's slots.
pub(super) fn slot_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("slots"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}
