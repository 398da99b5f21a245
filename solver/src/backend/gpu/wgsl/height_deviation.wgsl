// The deviation of the normal from heights; see model/height.rs.

struct Parameters {
    size: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Derivatives of the deviation with respect to the height's difference to the right (3) and downwards (3), per texel.
@group(0) @binding(1) var<storage, read> basis: array<f32>;
@group(0) @binding(2) var<storage, read> height: array<f32>;
@group(0) @binding(3) var<storage, read_write> deviation: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let size = parameters.size;
    if at >= size * size {
        return;
    }
    var across = vec2(0.0);
    if at % size > 0u && at % size + 1u < size {
        across.x = 0.5 * (height[at + 1u] - height[at - 1u]);
    }
    if at / size > 0u && at / size + 1u < size {
        across.y = 0.5 * (height[at + size] - height[at - size]);
    }
    for (var k = 0u; k < 3u; k++) {
        deviation[3u * at + k] = basis[6u * at + k] * across.x + basis[6u * at + 3u + k] * across.y;
    }
}
