// Highlights of a light, and their derivatives with respect to the normals: one thread per sample. See
// transport/highlights.rs; the lobes are those of transport/skin.rs.

struct Parameters {
    samples: u32,
    cells: u32,
    scale: f32,
    f0: f32,
    grazing: f32,
    opposite: f32,
    // Roughness and weight of two lobes.
    rough_a: f32,
    weight_a: f32,
    rough_b: f32,
    weight_b: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Blocks of 16 cells with seven rows: direction from the sky's centre, R, G, B, luminance.
@group(0) @binding(1) var<storage, read> lit: array<f32>;
@group(0) @binding(2) var<storage, read> visible: array<f32>;
// The row of every sample, and the place of every row.
@group(0) @binding(3) var<storage, read> row: array<u32>;
@group(0) @binding(4) var<storage, read> places: array<f32>;
// Rows: normal, view, reflectance at normal incidence, factor on the roughness.
@group(0) @binding(5) var<storage, read> surface: array<f32>;
// Rows: R, G, B, derivatives of the luminance with respect to the normal's x, y, z.
@group(0) @binding(6) var<storage, read_write> highlights: array<f32>;

// The sum of the lobes, and its derivatives with respect to n.h, n.v and n.l.
struct Lobes {
    value: f32,
    by_c: f32,
    by_nv: f32,
    by_nl: f32,
}

fn lobe(roughness: f32, weight: f32, c: f32, nv: f32, nl: f32) -> Lobes {
    let a = roughness * roughness;
    let spread = 1.0 / (c * c * (a - 1.0) + 1.0);
    let d = weight * a * 0.31830987 * spread * spread;
    let rv = sqrt(a + (1.0 - a) * nv * nv);
    let rl = sqrt(a + (1.0 - a) * nl * nl);
    let iv = 1.0 / (nv + rv);
    let il = 1.0 / (nl + rl);
    let all = d * iv * il;
    return Lobes(
        all * nl,
        all * nl * 4.0 * c * (1.0 - a) * spread,
        -all * nl * iv * (1.0 + (1.0 - a) * nv / rv),
        all * il * a / rl,
    );
}

fn unit(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(max(dot(v, v), parameters.opposite));
}

fn direction(i: u32, row: u32) -> vec3<f32> {
    return vec3(surface[place(i, row, 8u)], surface[place(i, row + 1u, 8u)],
        surface[place(i, row + 2u, 8u)]);
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
    let n = direction(i, 0u);
    let v = direction(i, 3u);
    let reflectance = surface[place(i, 6u, 8u)];
    let roughness = surface[place(i, 7u, 8u)];
    let rough_a = min(parameters.rough_a * roughness, 1.0);
    let rough_b = min(parameters.rough_b * roughness, 1.0);
    let nv = max(dot(n, v), parameters.grazing);
    let here = 3u * row[i];
    let seen_from = vec3(places[here], places[here + 1u], places[here + 2u]);
    var colour = vec3(0.0);
    var slope = vec3(0.0);
    for (var cell = 0u; cell < parameters.cells; cell++) {
        let at = cell / 16u * 112u + cell % 16u;
        let l = unit(vec3(lit[at], lit[at + 16u], lit[at + 32u]) - seen_from);
        let nl = dot(n, l);
        let towards = visible[row[i] * parameters.cells + cell];
        if nl <= 0.0 || towards == 0.0 {
            continue;
        }
        let h = unit(v + l);
        let c = dot(n, h);
        let a = lobe(rough_a, parameters.weight_a, c, nv, nl);
        let b = lobe(rough_b, parameters.weight_b, c, nv, nl);
        let grazing = 1.0 - clamp(dot(v, h), 0.0, 1.0);
        let squared = grazing * grazing;
        let weight =
            towards * (parameters.f0 + (1.0 - parameters.f0) * squared * squared * grazing);
        colour += weight * (a.value + b.value) * vec3(lit[at + 48u], lit[at + 64u], lit[at + 80u]);
        slope += weight * lit[at + 96u]
            * (h * (a.by_c + b.by_c) + v * (a.by_nv + b.by_nv) + l * (a.by_nl + b.by_nl));
    }
    colour *= parameters.scale * reflectance;
    slope *= parameters.scale * reflectance;
    #for k in 0..3
        highlights[place(i, k, 6u)] = colour[k];
        highlights[place(i, 3u + k, 6u)] = slope[k];
    #end
}
