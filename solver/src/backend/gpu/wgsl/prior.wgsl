// The albedo prior, equation (2): its gradient, and its value by workgroup. See model/prior.rs.

struct Parameters {
    size: u32,
    // The weight over the number of terms of the mean.
    scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> albedo: array<f32>;
@group(0) @binding(2) var<storage, read_write> gradient: array<f32>;
@group(0) @binding(3) var<storage, read_write> losses: array<f32>;

var<workgroup> sums: array<f32, 256>;

// sqrt(1 + d) - 1 without its cancellation.
fn penalty(difference: f32) -> f32 {
    let d = abs(difference);
    return d / (1.0 + sqrt(1.0 + d));
}

fn slope(difference: f32) -> f32 {
    return 0.5 * sign(difference) / sqrt(1.0 + abs(difference));
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let at = number * 256u + t;
    let line = 3u * parameters.size;
    let count = line * parameters.size;
    var sum = 0.0;
    if at < count {
        let value = albedo[at];
        var by_value = 0.0;
        if at % line + 3u < line {
            let difference = albedo[at + 3u] - value;
            sum += penalty(difference);
            by_value -= slope(difference);
        }
        if at % line >= 3u {
            by_value += slope(value - albedo[at - 3u]);
        }
        if at + line < count {
            let difference = albedo[at + line] - value;
            sum += penalty(difference);
            by_value -= slope(difference);
        }
        if at >= line {
            by_value += slope(value - albedo[at - line]);
        }
        gradient[at] = parameters.scale * by_value;
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    if t == 0u && number * 256u < count {
        losses[number] = parameters.scale * sums[0];
    }
}
