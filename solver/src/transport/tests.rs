use super::*;
use crate::config::Config;
use crate::testing;

fn config(size: usize) -> TransportConfig {
    TransportConfig { texture_size: size, ..Config::unshade().transport }
}

fn plain(mesh: &Mesh, config: &TransportConfig, seed: u64) -> Transport {
    Transport::new(mesh, &Sky::even(config.rows), config, seed, Beside::Nothing)
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

/// The inside of a sphere under light from all sides is as bright as under the open sky if its
/// walls are white: what a ray meets shines as what it hides.
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

#[test]
fn a_wall_shadows_the_floor_from_one_side() {
    // A floor in y = 0 seen from above and a wall along its edge at x = 1, both in the chart.
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
    let config = TransportConfig { bounces: 0, ..config(32) };
    let transport = plain(&mesh, &config, 0);
    let light_from = |x: f32| {
        let sky = Sky::even(config.rows).rays(1, 0);
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
