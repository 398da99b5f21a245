// Only multiply-adds, in independent chains.

struct Parameters {
    factor: f32,
    term: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read_write> result: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let factor = vec4(parameters.factor);
    let term = vec4(parameters.term);
    var a = vec4(f32(t));
    var b = a + 1.0;
    var c = a + 2.0;
    var d = a + 3.0;
    for (var round = 0u; round < ROUNDS; round++) {
        a = a * factor + term;
        b = b * factor + term;
        c = c * factor + term;
        d = d * factor + term;
    }
    let sum = a + b + c + d;
    if at < arrayLength(&result) {
        result[at] = sum.x + sum.y + sum.z + sum.w;
    }
}
