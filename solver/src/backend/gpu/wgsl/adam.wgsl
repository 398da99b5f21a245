// A step of Adam, one thread per value; see fit/adam.rs.

struct Factors {
    // The bias-corrected learning rate, and the factor on the root of the second moment.
    rate: f32,
    root: f32,
    beta1: f32,
    beta2: f32,
    epsilon: f32,
    least: f32,
    // 0: the values are constant.
    moves: u32,
    // Index of the step within its submission.
    step: u32,
    most: f32,
}

struct Parameters {
    count: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read_write> values: array<f32>;
@group(0) @binding(2) var<storage, read> gradient: array<f32>;
@group(0) @binding(3) var<storage, read_write> first: array<f32>;
@group(0) @binding(4) var<storage, read_write> second: array<f32>;
@group(1) @binding(0) var<uniform> factors: Factors;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    if at >= parameters.count || factors.moves == 0u {
        return;
    }
    let g = gradient[at];
    let m = factors.beta1 * first[at] + (1.0 - factors.beta1) * g;
    let v = factors.beta2 * second[at] + (1.0 - factors.beta2) * g * g;
    first[at] = m;
    second[at] = v;
    let moved = values[at] - factors.rate * m / (sqrt(v) * factors.root + factors.epsilon);
    // Unlike max, this preserves a NaN, so that the loss becomes NaN.
    let above = select(moved, factors.least, moved < factors.least);
    values[at] = select(above, factors.most, above > factors.most);
}
