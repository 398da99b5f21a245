// Shading of every row of the transport's matrix in the light: a workgroup a row. See transport/mod.rs.

struct Parameters {
    rows: u32,
    cells: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> transport: array<f32>;
@group(0) @binding(2) var<storage, read> light: array<f32>;
// R, G, B of every row.
@group(0) @binding(3) var<storage, read_write> shading: array<f32>;

var<workgroup> sums: array<vec3<f32>, 64>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let row = linear(group, groups);
    if row >= parameters.rows {
        return;
    }
    var own = vec3(0.0);
    for (var cell = t; cell < parameters.cells; cell += 64u) {
        let l = vec3(light[3u * cell], light[3u * cell + 1u], light[3u * cell + 2u]);
        own += transport[row * parameters.cells + cell] * l;
    }
    sums[t] = own;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half /= 2u) {
        if t < half {
            sums[t] += sums[t + half];
        }
        workgroupBarrier();
    }
    if t < 3u {
        shading[3u * row + t] = sums[0][t];
    }
}
