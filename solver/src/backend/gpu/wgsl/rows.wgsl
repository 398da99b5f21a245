// The gradient by the shading of every row, over the row's texels.

struct Parameters {
    rows: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// The texels of a row are `texel[start[row]..start[row + 1]]`.
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> texel: array<u32>;
@group(0) @binding(3) var<storage, read> by_layer: array<f32>;
@group(0) @binding(4) var<storage, read> albedo: array<f32>;
@group(0) @binding(5) var<storage, read_write> by_row: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let row = linear(group, groups) * 256u + t;
    if row >= parameters.rows {
        return;
    }
    var gradient = vec3(0.0);
    for (var at = start[row]; at < start[row + 1u]; at++) {
        let here = 3u * texel[at];
        gradient.x += by_layer[here] * albedo[here];
        gradient.y += by_layer[here + 1u] * albedo[here + 1u];
        gradient.z += by_layer[here + 2u] * albedo[here + 2u];
    }
    by_row[3u * row] = gradient.x;
    by_row[3u * row + 1u] = gradient.y;
    by_row[3u * row + 2u] = gradient.z;
}
