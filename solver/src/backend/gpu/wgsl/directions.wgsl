// Directions from sampled deviations, and the adjoint; see model/normals.rs. WHAT: 0 the directions, 1 the adjoint,
// which overwrites the gradients with respect to the directions.

struct Parameters {
    samples: u32,
    normal_scale: f32,
    reflection_scale: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Rows: d (3), its blur (3).
@group(0) @binding(1) var<storage, read> deviation: array<f32>;
// Rows: normal (3), direction to the camera (3).
@group(0) @binding(2) var<storage, read> surface: array<f32>;
// 6 rows of directions, or 7 of gradients.
@group(0) @binding(3) var<storage, read_write> directions: array<f32>;

const ROWS: u32 = 6u + WHAT;

fn vector(i: u32, row: u32) -> vec3<f32> {
    return vec3(directions[place(i, row, ROWS)], directions[place(i, row + 1u, ROWS)],
        directions[place(i, row + 2u, ROWS)]);
}

fn write(i: u32, row: u32, value: vec3<f32>) {
    #for k in 0..3
        directions[place(i, row + k, ROWS)] = value[k];
    #end
}

fn normalize_adjoint(v: vec3<f32>, gradient: vec3<f32>) -> vec3<f32> {
    let inverse = inverseSqrt(dot(v, v));
    let unit = v * inverse;
    return (gradient - unit * dot(unit, gradient)) * inverse;
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) t: u32,
) {
    let i = linear(group, groups) * 256u + t;
    if i >= parameters.samples {
        return;
    }
    var rows: array<vec3<f32>, 4>;
    #for k in 0..3
        rows[0][k] = deviation[place(i, k, 6u)];
        rows[1][k] = deviation[place(i, 3u + k, 6u)];
        rows[2][k] = surface[place(i, k, 6u)];
        rows[3][k] = surface[place(i, 3u + k, 6u)];
    #end
    let sharp = rows[2] + rows[0];
    let soft = rows[2] + rows[1];
    let view = rows[3];
    let specular = normalize(sharp);
    if WHAT == 0u {
        write(i, 0u, normalize(soft) * parameters.normal_scale);
        let reflected = 2.0 * dot(specular, view) * specular - view;
        write(i, 3u, reflected * parameters.reflection_scale);
        return;
    }
    let by_diffuse = vector(i, 0u) * parameters.normal_scale;
    let by_reflected = vector(i, 3u) * parameters.reflection_scale;
    let by_specular =
        2.0 * (dot(specular, by_reflected) * view + dot(specular, view) * by_reflected);
    write(i, 0u, normalize_adjoint(sharp, by_specular));
    write(i, 3u, normalize_adjoint(soft, by_diffuse));
}
