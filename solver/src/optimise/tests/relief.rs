//! The height solve on pictures whose relief is known.

use super::*;
use crate::gbuffer::Atlas;
use crate::model::height::HeightField;
use crate::model::planes::Planes;
use crate::optimise::relief::ReliefSolve;
use crate::optimise::stage::layers;

/// Pictures made by the model itself from a known height are explained by that height.
#[test]
fn a_known_relief_is_found_again() {
    let side = 64;
    let mut config = Config::default();
    config.height.coarsest_pixels = 0.0;
    config.height.smoothness = 0.0;
    config.height.flatness = 0.0;
    config.height.albedo_damping = 1e6;
    config.height.steps = 150;
    config.height.linearisations = 3;
    let mesh = testing::dome(24);
    let views = views(5, 64);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = SampleSpace::new(&mesh, &config);
    let mut samples = space.training(&views, &gbuffers, &config.view_weights, side);
    let texels = side * side;
    let state = State {
        networks: Networks::new(&config.networks, 5),
        size: side,
        diffuse: vec![0.5; 3 * texels],
        specular: vec![0.2; texels],
        deviation: vec![0.0; 3 * texels],
    };
    let atlas = Atlas::new(&mesh, side);
    let field = HeightField::new(&atlas);
    let wave = |at: usize| {
        let (x, y) = ((at % side) as f32, (at / side) as f32);
        0.3 * (0.9 * x).sin() * (0.7 * y).cos()
    };
    let truth = field.bend(&(0..texels).map(wave).collect::<Vec<f32>>());
    let bent = State { deviation: truth.clone(), ..state.clone() };
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, side);
    let shading = layers(&samples, &deviation, &bent, &backend);
    samples.target = Planes::from_fn(samples.len(), |i| {
        let [diffuse, specular]: [f32; 2] = shading.sample(i, 0);
        [0.5 * diffuse + specular; 3]
    });
    let solve = ReliefSolve::new(&config, &backend, &samples, &gbuffers, &atlas, &state, None);
    let mut residuals = vec![];
    let found = solve
        .solve(&mut |residual| {
            residuals.push(residual);
            Ok(())
        })
        .unwrap();
    let seen: Vec<bool> = {
        let ones = Planes::from_fn(samples.len(), |_| [1.0]);
        samples.taps.gather::<1>(&ones, 0).iter().map(|sum| *sum > 0.5).collect()
    };
    let (mut error, mut energy) = (0.0, 0.0);
    for at in (0..texels).filter(|at| seen[*at] && atlas.inside[*at]) {
        let (found, truth) =
            (Vec3::from_slice(&found[3 * at..]), Vec3::from_slice(&truth[3 * at..]));
        error += found.distance_squared(truth);
        energy += truth.length_squared();
    }
    assert!(energy > 1.0, "{energy}");
    // Random networks hardly see some directions, which are therefore not found.
    assert!(error < 0.4 * energy, "{} of the relief is missed", error / energy);
    let (first, last) = (residuals[0], residuals[residuals.len() - 1]);
    assert!(last < 0.1 * first, "{first} {last}");
}
