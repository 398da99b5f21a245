//! Gradients of the published stages, against finite differences; and the same loss from all of them.

use super::*;

#[test]
fn warm_up_gradients_reach_networks_and_textures() {
    let Problem { config, samples, state } = problem();
    let backend = Cpu::new();
    let stage = WarmUp::new(&config, &samples, &state);
    let gradient = stage.gradient(&state, &backend);
    let loss = |state: &State| stage.gradient(state, &backend).loss;
    assert_gradient("diffuse", &state, &gradient.diffuse, |s| &mut s.diffuse, 2e-3, loss);
    assert_gradient("specular", &state, &gradient.specular, |s| &mut s.specular, 1e-2, loss);
    fn networks(state: &mut State) -> &mut Vec<f32> {
        &mut state.networks.parameters
    }
    assert_gradient("networks", &state, &gradient.networks, networks, 1e-3, loss);
}

/// Fifty warm-up steps and ten of each other kind from the same state: what rounding does to the losses.
#[test]
fn the_instruction_sets_agree_over_fifty_steps() {
    let mut config = Config::preset("paper").unwrap();
    config.fine_tuning.deviation_blur = 0.05;
    let mesh = testing::dome(12);
    let views = views(3, 40);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = SampleSpace::new(&mesh, &config);
    let samples = space.training(&views, &gbuffers, &config.view_weights, SIDE);
    let deviation = Deviation::new(&config, SIDE);
    let losses = |level: Level| {
        let backend = Cpu::at(level);
        let mut state = State { size: SIDE, ..problem().state };
        let mut losses = vec![];
        let mut warm_up = WarmUp::new(&config, &samples, &state);
        losses.extend((0..50).map(|_| warm_up.step(&mut state, &backend, 1.0)));
        let mut normals = Normals::new(&config, &samples, &deviation, &state, &backend, 1);
        losses.extend((0..10).map(|_| normals.step(&mut state, &backend, 1.0)));
        let mut diffuse = Diffuse::new(&config, &samples, &deviation, &state, &backend, 1);
        losses.extend((0..10).map(|_| diffuse.step(&mut state, &backend, 1.0)));
        losses
    };
    let expected = losses(Level::Portable);
    assert!(expected[49] < 0.9 * expected[0], "{} {}", expected[0], expected[49]);
    for level in Level::available() {
        for (step, (loss, expected)) in losses(level).iter().zip(&expected).enumerate() {
            let error = (loss / expected - 1.0).abs();
            assert!(error < 1e-5, "{level}, step {step}: {loss} instead of {expected}");
        }
    }
}

#[test]
fn relief_gradients_pass_through_reflection_normals_tanh_and_blur() {
    let Problem { config, samples, state } = problem();
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let stage = || Normals::new(&config, &samples, &deviation, &state, &backend, 1);
    let found = stage().gradient(&state, &backend).1;
    let loss = |state: &State| stage().gradient(state, &backend).0;
    assert_gradient("deviation", &state, &found.deviation, |s| &mut s.deviation, 5e-2, loss);
    assert_gradient("specular", &state, &found.specular, |s| &mut s.specular, 1e-2, loss);
}

#[test]
fn diffuse_gradients_include_the_prior() {
    let Problem { config, samples, state } = problem();
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let stage = Diffuse::new(&config, &samples, &deviation, &state, &backend, 1);
    let (_, gradient) = stage.gradient(&state);
    let loss = |state: &State| stage.gradient(state).0;
    assert_gradient("diffuse", &state, &gradient, |s| &mut s.diffuse, 2e-3, loss);
}

/// The stages must agree about the same model: the loss with frozen networks is that of the
/// warm-up with the same state, as long as nothing is bent.
#[test]
fn the_stages_see_the_same_loss() {
    let Problem { mut config, samples, mut state } = problem();
    config.warm_up.prior = 0.0;
    config.fine_tuning.prior = 0.0;
    state.deviation.fill(0.0);
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let joint = WarmUp::new(&config, &samples, &state).gradient(&state, &backend).loss;
    let normals = Normals::new(&config, &samples, &deviation, &state, &backend, 1);
    let normals = normals.gradient(&state, &backend).0;
    let diffuse =
        Diffuse::new(&config, &samples, &deviation, &state, &backend, 1).gradient(&state).0;
    assert!((normals / joint - 1.0).abs() < 1e-5, "{normals} {joint}");
    assert!((diffuse / joint - 1.0).abs() < 1e-5, "{diffuse} {joint}");
}
