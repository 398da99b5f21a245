// The gradient with respect to the deviation: of the pictures, direct and through the blur, and of the penalties on the
// deviation and its differences. See unshade/deviation_penalty.rs.

struct Parameters {
    size: u32,
    flatness: f32,
    smoothness: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> deviation: array<f32>;
@group(0) @binding(2) var<storage, read> unblurred: array<f32>;
@group(0) @binding(3) var<storage, read_write> by_deviation: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let at = linear(group, groups) * 256u + t;
    let line = 3u * parameters.size;
    let count = line * parameters.size;
    if at >= count {
        return;
    }
    let value = deviation[at];
    var pull = 0.0;
    if at % line >= 3u {
        pull += value - deviation[at - 3u];
    }
    if at % line + 3u < line {
        pull += value - deviation[at + 3u];
    }
    if at >= line {
        pull += value - deviation[at - line];
    }
    if at + line < count {
        pull += value - deviation[at + line];
    }
    by_deviation[at] += unblurred[at] + parameters.flatness * value + parameters.smoothness * pull;
}
