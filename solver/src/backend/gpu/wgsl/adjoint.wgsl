// A matrix's adjoint, summed over chunks of ROWS rows: one cell a thread, a chunk a workgroup and 256
// cells.

struct Parameters {
    rows: u32,
    cells: u32,
    // Where the sums of its chunks begin.
    first: u32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> transport: array<f32>;
@group(0) @binding(2) var<storage, read> by_row: array<f32>;
@group(0) @binding(3) var<storage, read_write> partial_sums: array<f32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let across = (parameters.cells + 255u) / 256u;
    let cell = number % across * 256u + t;
    let first = number / across * ROWS;
    if cell >= parameters.cells || first >= parameters.rows {
        return;
    }
    var sum = vec3(0.0);
    for (var row = first; row < min(first + ROWS, parameters.rows); row++) {
        let at = row * parameters.cells + cell;
        let weight = transport[at];
        sum += weight * vec3(by_row[3u * row], by_row[3u * row + 1u], by_row[3u * row + 2u]);
    }
    let out = 3u * ((parameters.first + first / ROWS) * parameters.cells + cell);
    partial_sums[out] = sum.x;
    partial_sums[out + 1u] = sum.y;
    partial_sums[out + 2u] = sum.z;
}
