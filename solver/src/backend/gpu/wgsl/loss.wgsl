// The loss of a step: partial losses of samples and of the prior, added in a fixed order.

struct Factors {
    unused: array<vec4<u32>, 1>,
    padding: vec3<u32>,
    step: u32,
}

struct Parameters {
    samples: u32,
    prior: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> by_samples: array<f32>;
@group(0) @binding(2) var<storage, read> by_prior: array<f32>;
@group(0) @binding(3) var<storage, read_write> losses: array<f32>;
@group(1) @binding(0) var<uniform> factors: Factors;

var<workgroup> sums: array<f32, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) t: u32) {
    var sum = 0.0;
    for (var at = t; at < parameters.samples; at += 256u) {
        sum += by_samples[at];
    }
    for (var at = t; at < parameters.prior; at += 256u) {
        sum += by_prior[at];
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    if t == 0u {
        losses[factors.step] = sums[0];
    }
}
