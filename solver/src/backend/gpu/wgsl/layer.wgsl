// The loss, and the gradient with respect to a sampled albedo in which the model is linear. CHANNELS: 3 for the diffuse
// albedo, 1 for the specular albedo. See Job::Layer of backend/resident.rs.

struct Parameters {
    samples: u32,
    size: u32,
    first_group: u32,
    scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> cell: array<u32>;
@group(0) @binding(2) var<storage, read> fraction: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> texels: array<f32>;
// Rows: target R, G, B minus the other layer, weight, shading of CHANNELS.
@group(0) @binding(4) var<storage, read> known: array<f32>;
@group(0) @binding(5) var<storage, read_write> by_albedo: array<f32>;
@group(0) @binding(6) var<storage, read_write> losses: array<f32>;

const ROWS: u32 = 4u + CHANNELS;

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
        let above = CHANNELS * cell[i];
        let below = above + CHANNELS * parameters.size;
        let f = fraction[i];
        var value: array<f32, CHANNELS>;
        var by_value: array<f32, CHANNELS>;
        #for c in 0..CHANNELS
            let a = texels[above + c];
            let b = texels[below + c];
            let upper = a + f.x * (texels[above + CHANNELS + c] - a);
            let lower = b + f.x * (texels[below + CHANNELS + c] - b);
            value[c] = upper + f.y * (lower - upper);
        #end
        let weight = known[place(i, 3u, ROWS)];
        #for c in 0..3
            let own = c % CHANNELS;
            let slope = known[place(i, 4u + own, ROWS)];
            let residual = value[own] * slope - known[place(i, c, ROWS)];
            loss += weight * abs(residual);
            by_value[own] += weight * parameters.scale * sign(residual) * slope;
        #end
        #for c in 0..CHANNELS
            by_albedo[place(i, c, CHANNELS)] = by_value[c];
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
    // A grid of two axes may have a few superfluous workgroups.
    if t == 0u && number * 256u < parameters.samples {
        losses[parameters.first_group + number] = parameters.scale * sums[0];
    }
}
