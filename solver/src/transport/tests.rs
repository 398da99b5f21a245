use super::*;
use crate::testing;

fn config(size: usize) -> TransportConfig {
    TransportConfig { texture_size: size, ..TransportConfig::default() }
}

fn plain(mesh: &Mesh, config: &TransportConfig, seed: u64) -> Transport {
    Transport::new(mesh, &Sky::lat_long(config.rows), config, seed)
}

#[test]
fn a_convex_surface_sees_its_whole_hemisphere() {
    let mesh = testing::dome(16);
    let transport = plain(&mesh, &config(32), 0);
    let light = vec![1.0; CHANNELS * transport.cells()];
    for shading in transport.shading(&light) {
        assert!((shading - 1.0).abs() < 0.03, "{shading}");
    }
}

/// The inside of a white sphere in uniform light is as bright as an unoccluded surface: a hit surface has the radiance
/// of the sky behind it.
#[test]
fn an_open_box_gathers_bounced_light() {
    let mut mesh = testing::dome(16);
    mesh.triangles.iter_mut().for_each(|triangle| triangle.reverse());
    mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
    let shading = |bounces: usize| {
        let config = TransportConfig { bounces, bounce_albedo: 1.0, ..config(32) };
        let transport = plain(&mesh, &config, 0);
        let all = transport.shading(&vec![1.0; CHANNELS * transport.cells()]);
        all.iter().sum::<f32>() / all.len() as f32
    };
    let (direct, once, often) = (shading(0), shading(1), shading(40));
    assert!(direct < 0.9 && direct < once && once < often, "{direct} {once} {often}");
    assert!((often - 1.0).abs() < 0.03, "{often}");
}

/// A floor in y = 0 seen from above and a wall along its edge at x = 1, both in the chart.
fn floor_and_wall() -> Mesh {
    let square = testing::square();
    let floor = square.positions.iter().map(|p| Vec3::new(p.x, 0.0, -p.y));
    let wall = square.positions.iter().map(|p| Vec3::new(1.0, 1.0 + p.y, p.x));
    let mut mesh = square.clone();
    mesh.positions = floor.chain(wall).collect();
    mesh.normals = [Vec3::Y; 4].into_iter().chain([-Vec3::X; 4]).collect();
    let half =
        |shift: f32| square.uvs.iter().map(move |uv| glam::Vec2::new(0.45 * uv.x + shift, uv.y));
    mesh.uvs = half(0.0).chain(half(0.55)).collect();
    mesh.triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    mesh
}

#[test]
fn a_wall_shadows_the_floor_from_one_side() {
    let mesh = floor_and_wall();
    let config = TransportConfig { bounces: 0, ..config(32) };
    let transport = plain(&mesh, &config, 0);
    let light_from = |x: f32| {
        let sky = Sky::lat_long(config.rows).rays(1, 0);
        let lit = |cell: usize| {
            let direction = sky[cell].direction;
            let low = direction.y > 0.0 && direction.y < 0.5;
            if low && direction.x * x > 0.8 { 1.0 } else { 0.0 }
        };
        let cells: Vec<f32> = (0..transport.cells()).map(lit).collect();
        let light: Vec<f32> = cells.iter().flat_map(|value| [*value; CHANNELS]).collect();
        let shading = transport.shading(&light);
        // The floor's middle.
        shading[CHANNELS * (16 * 32 + 7)]
    };
    assert!(light_from(-1.0) > 0.02, "{}", light_from(-1.0));
    assert!(light_from(1.0) < 1e-3, "{}", light_from(1.0));
}

#[test]
fn adjoint_is_the_transpose() {
    let transport = plain(&testing::dome(8), &config(16), 1);
    let wave =
        |count: usize, k: f32| (0..count).map(|i| (i as f32 * k).sin()).collect::<Vec<f32>>();
    let light = wave(CHANNELS * transport.cells(), 0.37);
    let gradient = wave(CHANNELS * 16 * 16, 0.71);
    let product = |a: &[f32], b: &[f32]| {
        a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>()
    };
    let left = product(&transport.shading(&light), &gradient);
    let right = product(&light, &transport.adjoint(&gradient));
    assert!((left - right).abs() < 1e-4 * left.abs().max(1.0), "{left} {right}");
}

#[test]
fn threads_do_not_change_a_bit() {
    let mesh = testing::dome(8);
    let build = || {
        let transport = plain(&mesh, &config(16), 1);
        let gradient = transport.adjoint(&vec![0.3; CHANNELS * 256]);
        (transport.matrix.rows, gradient)
    };
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
    assert_eq!(pool(1).install(build), pool(3).install(build));
}

/// A lamp of one cell on a sphere of radius 2 around a convex surface, against the integral over the lamp's area
/// (cosines at both ends over the squared distance).
#[test]
fn a_near_lamp_follows_the_inverse_square() {
    let mesh = testing::dome(16);
    let config = TransportConfig { rays_per_cell_side: 8, ..config(32) };
    let sky = Sky::lat_long(8).at(0.5);
    let transport = Transport::new(&mesh, &sky, &config, 0);
    let centres = sky.centres();
    let front = |a: &usize, b: &usize| centres[*a].z.total_cmp(&centres[*b].z);
    let lamp = (0..sky.len()).max_by(front).unwrap();
    let mut light = vec![0.0; CHANNELS * sky.len()];
    light[CHANNELS * lamp..][..CHANNELS].fill(1.0);
    let found = transport.shading(&light);
    let atlas = Atlas::new(&mesh, 32);
    let (low, high) = mesh.bounds();
    let centre = 0.5 * (low + high);
    let rays: Vec<_> = sky.rays(8, 3).into_iter().filter(|ray| ray.cell as usize == lamp).collect();
    let mut checked = 0;
    for texel in (0..32 * 32).filter(|texel| atlas.inside[*texel]) {
        let expected: f32 = rays
            .iter()
            .map(|ray| {
                let from = centre + 2.0 * ray.direction - atlas.positions[texel];
                let (distance, towards) = (from.length(), from.normalize());
                let area = 4.0 * ray.solid_angle;
                let cosines =
                    atlas.normals[texel].dot(towards).max(0.0) * ray.direction.dot(towards);
                area * cosines / (distance * distance) / std::f32::consts::PI
            })
            .sum();
        let error = (found[CHANNELS * texel] - expected).abs();
        assert!(
            error < 0.02 * expected + 2e-4,
            "{texel}: {} not {expected}",
            found[CHANNELS * texel]
        );
        checked += usize::from(expected > 0.01);
    }
    assert!(checked > 100, "{checked} lit texels test too little");
}

#[test]
fn the_derivative_with_respect_to_nearness_is_the_change_to_a_nearer_sky() {
    let mesh = testing::dome(16);
    let far = Transport::with_nearness(&mesh, &Sky::lat_long(8), &config(32), 0);
    let near = Sky::lat_long(8).at(far.nearness_unit());
    let near = Transport::new(&mesh, &near, &config(32), 0);
    let light: Vec<f32> = (0..CHANNELS * far.cells()).map(|i| 1.0 + (i as f32).sin()).collect();
    let (found, _) = far.shading_nearer(&light, 1.0);
    for (found, expected) in found.into_iter().zip(near.shading(&light)) {
        assert!((found - expected).abs() < 0.02, "{found} {expected}");
    }
    assert!(near.shading_nearer(&light, 1.0).1.is_none());
}

/// On a convex surface the shading under a bent normal is that of the bent normal.
#[test]
fn shading_by_normal_is_the_change_of_shading_with_the_normal() {
    let mesh = testing::dome(16);
    let config = TransportConfig { bounces: 0, rays_per_cell_side: 6, ..config(32) };
    let sky = Sky::lat_long(8);
    let transport = Transport::new(&mesh, &sky, &config, 0);
    // A lamp in front, far above the horizon of the tested texels.
    let lit = |direction: Vec3| if direction.dot(Vec3::Z) > 0.85 { 1.0 } else { 0.0 };
    let light: Vec<f32> = sky.centres().iter().flat_map(|d| [lit(*d); CHANNELS]).collect();
    let slopes = transport.shading_by_normal(&light);
    let shading = transport.shading(&light);
    let atlas = Atlas::new(&mesh, 32);
    let front = |texel: &usize| atlas.inside[*texel] && atlas.normals[*texel].z > 0.8;
    let texels: Vec<usize> = (0..32 * 32).filter(front).collect();
    assert!(texels.len() > 20);
    for texel in texels {
        let slope = Vec3::from_slice(&slopes[3 * CHANNELS * texel..]);
        // Linear in the normal: the shading itself, and that of a normal bent by a tenth.
        let normal = atlas.normals[texel];
        assert!((slope.dot(normal) - shading[CHANNELS * texel]).abs() < 0.01);
        let bent = (normal + 0.1 * normal.any_orthonormal_vector()).normalize();
        let expected: f32 = sky
            .rays(6, 0)
            .iter()
            .map(|ray| {
                let cell = light[CHANNELS * ray.cell as usize];
                cell * ray.solid_angle * bent.dot(ray.direction).max(0.0) / std::f32::consts::PI
            })
            .sum();
        assert!((slope.dot(bent) - expected).abs() < 0.01, "{} {expected}", slope.dot(bent));
    }
}

/// At grazing angles, the cosine with a direction may round to zero where the cosine with its unit vector does not.
#[test]
fn solid_angles_of_grazing_light_are_finite() {
    let mesh = testing::dome(4);
    let sky = Sky::lat_long(16).at(0.01);
    let rays = sky.rays(4, 0);
    let caster = Caster {
        occluder: Occluder::new(&mesh),
        mesh: &mesh,
        rays: &rays,
        centre: Vec3::ZERO,
        nearness: sky.nearness,
        nearer: 0.0,
        row: &[0; 4],
        size: 2,
    };
    let origin = Vec3::new(0.3, -0.2, 2.0);
    // A cell has 16 rays, so that every cell, and every place in a cell, is among these.
    for ray in rays.iter().step_by(15) {
        let towards = ray.direction - sky.nearness * origin;
        let (across, up) = towards.normalize().any_orthonormal_pair();
        for normal in [across, up, (across + up).normalize(), (across - up).normalize()] {
            let [mut direct, mut visible] = [(); 2].map(|()| vec![0.0; sky.len()]);
            let rows =
                RowsOfTexel { direct: &mut direct, visible: &mut visible, by_nearness: &mut [] };
            caster.texel(origin, normal, rows);
            assert!(visible.iter().all(|v| (0.0..0.1).contains(v)), "{normal}");
        }
    }
}

#[test]
fn the_peak_is_the_largest_unoccluded_shading() {
    let transport = plain(&testing::dome(16), &config(32), 0);
    let light = vec![0.7; CHANNELS * transport.cells()];
    let peak = transport.peak(&light);
    assert!((peak - 0.7).abs() < 0.03, "{peak}");
}

#[test]
fn the_edge_of_a_lamps_shadow_is_uncertain_and_a_uniform_sky_has_none() {
    let config = TransportConfig { bounces: 0, rays_per_cell_side: 4, ..config(32) };
    let transport = plain(&floor_and_wall(), &config, 0);
    let lamp = Sky::lat_long(config.rows).rays(1, 0).into_iter().position(|ray| {
        ray.direction.x > 0.35 && ray.direction.y > 0.8 && ray.direction.z.abs() < 0.1
    });
    let lamp = CHANNELS * lamp.unwrap();
    let mut light = vec![0.0; CHANNELS * transport.cells()];
    light[lamp..lamp + CHANNELS].fill(1.0);
    let (shading, edges) = (transport.shading(&light), transport.shadow_edges(&light));
    let floor = |texel: usize| texel % 32 < 14;
    let shadings = || shading.iter().step_by(CHANNELS).enumerate().filter(|(at, _)| floor(*at));
    let most = shadings().map(|(_, s)| *s).fold(0.0, f32::max);
    let mut counts = [0; 3];
    for (at, s) in shadings() {
        // Inside and outside of the shadow nothing is uncertain; half hidden, half of the lamp's light is.
        let (part, edge) = (s / most, edges[at] / most);
        match part {
            _ if part < 0.02 => counts[0] += 1,
            _ if part > 0.98 => counts[1] += 1,
            _ => counts[2] += usize::from((0.3..0.7).contains(&part)),
        }
        assert!(edge < 0.65 && (!(0.3..0.7).contains(&part) || edge > 0.3), "{part}: {edge}");
        assert!((0.02..0.98).contains(&part) || edge < 0.2, "{part}: {edge}");
    }
    assert!(counts.iter().all(|count| *count > 5), "{counts:?}");
    let uniform = transport.shadow_edges(&vec![1.0; CHANNELS * transport.cells()]);
    assert!(uniform.iter().all(|edge| *edge < 0.05));
}
