// The steps between the deviation texture and its blurs, value by value; see model/deviation.rs.
// WHAT: 0 the deviation d = range x tanh(B t), 1 the gradient with respect to B t, 2 the difference of the two blurs'
// adjoints. BAND: 0 if no second blur is subtracted.

struct Parameters {
    count: u32,
    range: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> a: array<f32>;
@group(0) @binding(2) var<storage, read> b: array<f32>;
// d, for its gradient.
@group(0) @binding(3) var<storage, read> d: array<f32>;
@group(0) @binding(4) var<storage, read_write> result: array<f32>;

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
    var value = a[at];
    let range = parameters.range;
    if WHAT == 1u {
        value += b[at];
        value *= range - d[at] * d[at] / range;
    } else {
        if BAND == 1u {
            value -= b[at];
        }
        if WHAT == 0u {
            value = range * (1.0 - 2.0 / (exp(min(2.0 * value, 80.0)) + 1.0));
        }
    }
    result[at] = value;
}
