// The gradient by the light's logarithm: the chunks of adjoint.wgsl in their order, times the light.

struct Parameters {
    // Channels of all cells.
    count: u32,
    chunks: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> partial_sums: array<f32>;
@group(0) @binding(2) var<storage, read> light: array<f32>;
@group(0) @binding(3) var<storage, read_write> gradient: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    if at >= parameters.count {
        return;
    }
    var sum = 0.0;
    for (var chunk = 0u; chunk < parameters.chunks; chunk++) {
        sum += partial_sums[chunk * parameters.count + at];
    }
    gradient[at] = sum * light[at];
}
