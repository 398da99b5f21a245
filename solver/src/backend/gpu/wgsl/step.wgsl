// The vectors of the conjugate gradients. WHAT: 0 the initial residual, from the right-hand side in `residual`; 1 a
// step; 2 the next direction.

struct Scalars {
    residual_norm2: f32,
    tolerance: f32,
    alpha: f32,
    beta: f32,
}

struct Parameters {
    count: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> scalars: Scalars;
@group(0) @binding(2) var<storage, read> a_direction: array<f32>;
@group(0) @binding(3) var<storage, read_write> x: array<f32>;
@group(0) @binding(4) var<storage, read_write> residual: array<f32>;
@group(0) @binding(5) var<storage, read_write> direction: array<f32>;

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
    if WHAT == 0u {
        residual[at] -= a_direction[at];
        direction[at] = residual[at];
    } else if WHAT == 1u {
        x[at] += scalars.alpha * direction[at];
        residual[at] -= scalars.alpha * a_direction[at];
    } else {
        direction[at] = residual[at] + scalars.beta * direction[at];
    }
}
