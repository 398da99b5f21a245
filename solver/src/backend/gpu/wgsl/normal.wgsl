// The product of one sample's unknowns with the normal equations' matrix, in place: the colour of the linear model,
// weighted and multiplied by the transpose. See unshade/height_solve.rs.

struct Parameters {
    samples: u32,
    // The removed share of a colour's component along the diffuse layer.
    diffuse_share: f32,
}

// Least squared norm of a diffuse layer's colour, by which is divided.
const LEAST_SQUARE: f32 = 1e-12;

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Derivatives with respect to n_s (3), n_d of R, G, B (9) and the albedo (3); then the weight.
@group(0) @binding(1) var<storage, read> slopes: array<f32>;
// Both deviations and the albedo's unknowns.
@group(0) @binding(2) var<storage, read_write> unknowns: array<f32>;

fn slope(i: u32, row: u32) -> vec3<f32> {
    return vec3(
        slopes[place(i, row, 16u)], slopes[place(i, row + 1u, 16u)], slopes[place(i, row + 2u, 16u)]);
}

fn unknown(i: u32, row: u32) -> vec3<f32> {
    return vec3(
        unknowns[place(i, row, 9u)], unknowns[place(i, row + 1u, 9u)], unknowns[place(i, row + 2u, 9u)]);
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
    let specular = slope(i, 0u);
    // Columns: R, G, B.
    let diffuse = mat3x3(slope(i, 3u), slope(i, 6u), slope(i, 9u));
    let shading = slope(i, 12u);
    let explained = unknown(i, 3u) * diffuse + dot(specular, unknown(i, 0u)) + shading * unknown(i, 6u);
    let along = dot(shading, explained) / max(dot(shading, shading), LEAST_SQUARE);
    let z = slopes[place(i, 15u, 16u)] * (explained - parameters.diffuse_share * along * shading);
    let by_specular = specular * (z.x + z.y + z.z);
    let by_diffuse = diffuse * z;
    let by_albedo = shading * z;
    for (var k = 0u; k < 3u; k++) {
        unknowns[place(i, k, 9u)] = by_specular[k];
        unknowns[place(i, 3u + k, 9u)] = by_diffuse[k];
        unknowns[place(i, 6u + k, 9u)] = by_albedo[k];
    }
}
