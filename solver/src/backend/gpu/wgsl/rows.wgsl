// The gradient by the shading of every row: of the pictures, over the row's texels, and of the penalties on
// colour. Beside it, by workgroup, the penalties themselves and the gradient by the nearness.

struct Parameters {
    rows: u32,
    // The weight of a texel's colour over the terms of the mean.
    scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// The texels of a row are `texel[start[row]..start[row + 1]]`.
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> texel: array<u32>;
@group(0) @binding(3) var<storage, read> by_layer: array<f32>;
@group(0) @binding(4) var<storage, read> diffuse: array<f32>;
@group(0) @binding(5) var<storage, read> shading: array<f32>;
// Gains of the shading, then the result of grey.wgsl.
@group(0) @binding(6) var<storage, read> gains: array<f32>;
@group(0) @binding(7) var<storage, read_write> by_row: array<f32>;
// The penalty of every workgroup, then the gradient by the nearness of every workgroup.
@group(0) @binding(8) var<storage, read_write> partial_sums: array<f32>;

var<workgroup> sums: array<vec2<f32>, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let row = number * 256u + t;
    let mean_penalty = 3u * parameters.rows;
    var sum = vec2(0.0);
    if row < parameters.rows {
        let first = 3u * row;
        let own = vec3(shading[first], shading[first + 1u], shading[first + 2u]);
        let grey = (own.x + own.y + own.z) / 3.0;
        let signs = sign(own - grey);
        // What no light reaches has no colour; the divisor counts as given.
        let inverse = select(0.0, 1.0 / grey, grey > 0.0);
        let off = abs(own - grey) * inverse;
        let by_texel = parameters.scale * (signs - (signs.x + signs.y + signs.z) / 3.0) * inverse;
        let by_mean = vec3(gains[mean_penalty], gains[mean_penalty + 1u], gains[mean_penalty + 2u]);
        let end = start[row + 1u];
        let texels = f32(end - start[row]);
        var gradient = texels * (by_mean + by_texel);
        for (var at = start[row]; at < end; at++) {
            let here = 3u * texel[at];
            gradient.x += by_layer[here] * diffuse[here];
            gradient.y += by_layer[here + 1u] * diffuse[here + 1u];
            gradient.z += by_layer[here + 2u] * diffuse[here + 2u];
        }
        by_row[first] = gradient.x;
        by_row[first + 1u] = gradient.y;
        by_row[first + 2u] = gradient.z;
        let gained = vec3(gains[first], gains[first + 1u], gains[first + 2u]);
        sum = vec2(texels * parameters.scale * (off.x + off.y + off.z), dot(gained, gradient));
        if row == 0u {
            sum.x += gains[mean_penalty + 3u];
        }
    }
    sums[t] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    let all = (parameters.rows + 255u) / 256u;
    if t == 0u && number < all {
        partial_sums[number] = sums[0].x;
        partial_sums[all + number] = sums[0].y;
    }
}
