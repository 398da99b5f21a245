// The penalty on a coloured mean of the shading: its gradient by the shading of any texel (3), its value.
// See optimise/transported.rs.

struct Parameters {
    rows: u32,
    texels: f32,
    weight: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// First texel of every row, see rows.wgsl.
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> shading: array<f32>;
// Behind the rows' gains.
@group(0) @binding(3) var<storage, read_write> result: array<f32>;

var<workgroup> sums: array<vec3<f32>, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) t: u32) {
    var sum = vec3(0.0);
    for (var row = t; row < parameters.rows; row += 256u) {
        let texels = f32(start[row + 1u] - start[row]);
        sum += texels * vec3(shading[3u * row], shading[3u * row + 1u], shading[3u * row + 2u]);
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
        let means = sums[0] / parameters.texels;
        let mean = (means.x + means.y + means.z) / 3.0;
        let off = means / mean - 1.0;
        let pull = dot(off, means) / mean;
        let gradient = 2.0 * parameters.weight * (off - pull / 3.0) / (mean * parameters.texels);
        let first = 3u * parameters.rows;
        result[first] = gradient.x;
        result[first + 1u] = gradient.y;
        result[first + 2u] = gradient.z;
        result[first + 3u] = parameters.weight * dot(off, off);
    }
}
