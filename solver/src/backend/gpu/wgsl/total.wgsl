// Sums in a fixed order, one workgroup per sum: into the slot of the step's loss, or into separate values.

struct Factors {
    unused: array<vec4<u32>, 1>,
    padding: vec3<u32>,
    step: u32,
}

struct Parameters {
    first: u32,
    count: u32,
    // Parts of a workgroup.
    share: u32,
    // 1: into the step's slot.
    by_step: u32,
    // 1: add to the existing value.
    add: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> parts: array<f32>;
@group(0) @binding(2) var<storage, read_write> result: array<f32>;
@group(1) @binding(0) var<uniform> factors: Factors;

var<workgroup> sums: array<f32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let begin = number * parameters.share;
    let end = min(begin + parameters.share, parameters.count);
    var sum = 0.0;
    for (var at = begin + t; at < end; at += 256u) {
        sum += parts[parameters.first + at];
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    // A grid of two axes may have a few superfluous workgroups.
    if t == 0u && (number == 0u || begin < parameters.count) {
        let place = select(number, factors.step, parameters.by_step == 1u);
        let before = select(0.0, result[place], parameters.add == 1u);
        result[place] = before + sums[0];
    }
}
