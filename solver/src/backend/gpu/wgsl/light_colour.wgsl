// The penalty on neighbouring cells of the light whose colours differ: its gradient, added, and its value by
// workgroup. See transport/light_colour.rs.

struct Parameters {
    rows: u32,
    // The weight over the number of cells.
    scale: f32,
    softness: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> log_light: array<f32>;
@group(0) @binding(2) var<storage, read_write> gradient: array<f32>;
@group(0) @binding(3) var<storage, read_write> losses: array<f32>;

var<workgroup> sums: array<f32, 256>;

fn cell(at: u32) -> vec3<f32> {
    return vec3(log_light[3u * at], log_light[3u * at + 1u], log_light[3u * at + 2u]);
}

// By how much the channels differ, less the mean of the three.
fn difference(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let d = a - b;
    return d - (d.x + d.y + d.z) / 3.0;
}

fn roots(d: vec3<f32>) -> vec3<f32> {
    return sqrt(d * d + parameters.softness * parameters.softness);
}

fn slope(d: vec3<f32>) -> vec3<f32> {
    let slopes = d / roots(d);
    return slopes - (slopes.x + slopes.y + slopes.z) / 3.0;
}

fn cost(d: vec3<f32>) -> f32 {
    let costs = roots(d) - parameters.softness;
    return costs.x + costs.y + costs.z;
}

// Length of the edge above a row, over that on the equator.
fn edge(row: u32) -> f32 {
    return sin(3.14159265 * f32(row) / f32(parameters.rows));
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let number = linear(group, groups);
    let at = number * 256u + t;
    let columns = 2u * parameters.rows;
    let count = columns * parameters.rows;
    var sum = 0.0;
    if at < count {
        let row = at / columns;
        let column = at % columns;
        let line = row * columns;
        let own = cell(at);
        let right = difference(own, cell(line + (column + 1u) % columns));
        sum += cost(right);
        var by = slope(right);
        by += slope(difference(own, cell(line + (column + columns - 1u) % columns)));
        if row + 1u < parameters.rows {
            let below = difference(own, cell(at + columns));
            sum += edge(row + 1u) * cost(below);
            by += edge(row + 1u) * slope(below);
        }
        if row > 0u {
            by += edge(row) * slope(difference(own, cell(at - columns)));
        }
        gradient[3u * at] += parameters.scale * by.x;
        gradient[3u * at + 1u] += parameters.scale * by.y;
        gradient[3u * at + 2u] += parameters.scale * by.z;
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
