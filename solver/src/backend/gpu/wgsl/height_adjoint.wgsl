// The product of the normal equations' matrix with a vector: the adjoint of height_deviation.wgsl, and the damping of
// the unknowns.

struct Parameters {
    size: u32,
    height_damping: f32,
    albedo_damping: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> basis: array<f32>;
@group(0) @binding(2) var<storage, read> by_bend: array<f32>;
@group(0) @binding(3) var<storage, read> unknowns: array<f32>;
// The part of the albedo has the gradient of the pictures.
@group(0) @binding(4) var<storage, read_write> image: array<f32>;

// The gradient with respect to the height's difference at a texel: 0 to the right, 3 downwards.
fn along(at: u32, axis: u32) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < 3u; k++) {
        sum += basis[6u * at + axis + k] * by_bend[3u * at + k];
    }
    return sum;
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let size = parameters.size;
    let texels = size * size;
    if at >= 4u * texels {
        return;
    }
    if at >= texels {
        image[at] += parameters.albedo_damping * unknowns[at];
        return;
    }
    let x = at % size;
    let y = at / size;
    var sum = 0.0;
    // A texel's height also contributes at neighbours that have both of their neighbours.
    if x >= 2u {
        sum += along(at - 1u, 0u);
    }
    if x + 2u < size {
        sum -= along(at + 1u, 0u);
    }
    if y >= 2u {
        sum += along(at - size, 3u);
    }
    if y + 2u < size {
        sum -= along(at + size, 3u);
    }
    image[at] = 0.5 * sum + parameters.height_damping * unknowns[at];
}
