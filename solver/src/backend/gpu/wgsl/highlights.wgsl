// Loss of the diffuse layer and the highlights that the light makes on it, and its gradient by their sum, which
// takes the place of both.

struct Parameters {
    samples: u32,
    first_group: u32,
    scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Rows: target R, G, B, weight.
@group(0) @binding(1) var<storage, read> pixels: array<f32>;
// Rows: R, G, B.
@group(0) @binding(2) var<storage, read_write> layer: array<f32>;
// R, G, B of every sample.
@group(0) @binding(3) var<storage, read_write> highlights: array<f32>;
@group(0) @binding(4) var<storage, read_write> losses: array<f32>;

var<workgroup> sums: array<f32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let i = number * 256u + t;
    var loss = 0.0;
    if i < parameters.samples {
        let weight = parameters.scale * pixels[place(i, 3u, 4u)];
        #for c in 0..3
            let here = place(i, c, 3u);
            let residual = layer[here] + highlights[3u * i + c] - pixels[place(i, c, 4u)];
            loss += weight * abs(residual);
            layer[here] = weight * sign(residual);
            highlights[3u * i + c] = layer[here];
        #end
    }
    sums[t] = loss;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    // A grid of two axes may have a few workgroups too many.
    if t == 0u && number * 256u < parameters.samples {
        losses[parameters.first_group + number] = sums[0];
    }
}
