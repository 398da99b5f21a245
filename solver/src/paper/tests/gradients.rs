//! Gradients of the published stages, against finite differences; and the same loss from all of them.

use super::*;

/// The loss of a fit.
fn loss(fit: &dyn Fit) -> f64 {
    fit.gradient(&Cpu::new()).0
}

#[test]
fn warm_up_gradients_reach_networks_and_textures() {
    let Problem { config, samples, fields } = problem();
    let of = |fields: &ShadingFields| loss(&WarmUp::new(&config, &samples, fields.clone()));
    let fit = WarmUp::new(&config, &samples, fields.clone());
    let [networks, diffuse, specular] = fit.gradient(&Cpu::new()).1.try_into().unwrap();
    assert_gradient("diffuse", &fields, &diffuse, |f| &mut f.diffuse, 2e-3, of);
    assert_gradient("specular", &fields, &specular, |f| &mut f.specular, 1e-2, of);
    fn parameters(fields: &mut ShadingFields) -> &mut Vec<f32> {
        &mut fields.networks.parameters
    }
    assert_gradient("networks", &fields, &networks, parameters, 1e-3, of);
}

/// Each stage runs freely at every level, so this sees what piles up.
#[test]
fn the_instruction_sets_agree_over_fifty_steps() {
    let mut config = PaperConfig::default();
    config.fine_tuning.deviation_blur = 0.05;
    let mesh = testing::dome(12);
    let views = views(3, 40);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = sample_space(&mesh, &config);
    let samples = space.training(&views, &gbuffers, config.depth_weights(), SIDE);
    let deviation = Deviation::new(&config, SIDE);
    let losses = |level: Level| {
        let backend = Cpu::at(level);
        let mut warm_up = WarmUp::new(&config, &samples, problem().fields);
        let mut losses: Vec<f64> = (0..50).map(|_| warm_up.step(&backend, 1.0)).collect();
        let fields = warm_up.fields;
        let mut normals = Normals::new(&config, &samples, &deviation, &fields, &backend);
        losses.extend((0..10).map(|_| normals.step(&backend, 1.0)));
        let Relief { deviation: bent, specular } = normals.relief;
        let fields = ShadingFields { deviation: bent, specular, ..fields.clone() };
        let mut diffuse = diffuse(&config, &samples, &deviation, &fields, &backend);
        losses.extend((0..10).map(|_| diffuse.step(&backend, 1.0)));
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
    let Problem { config, samples, fields } = problem();
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let found = Normals::new(&config, &samples, &deviation, &fields, &backend).gradient(&backend).1;
    let of = |moved: &ShadingFields| {
        let mut fit = Normals::new(&config, &samples, &deviation, &fields, &backend);
        let (deviation, specular) = (moved.deviation.clone(), moved.specular.clone());
        fit.relief = Relief { deviation, specular };
        loss(&fit)
    };
    assert_gradient("deviation", &fields, &found[0], |f| &mut f.deviation, 5e-2, of);
    assert_gradient("specular", &fields, &found[1], |f| &mut f.specular, 1e-2, of);
}

#[test]
fn diffuse_gradients_include_the_prior() {
    let Problem { config, samples, fields } = problem();
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let of = |moved: &ShadingFields| {
        let mut fit = diffuse(&config, &samples, &deviation, &fields, &backend);
        fit.albedo.clone_from(&moved.diffuse);
        loss(&fit)
    };
    let fit = diffuse(&config, &samples, &deviation, &fields, &backend);
    let gradient = fit.gradient(&backend).1;
    assert_gradient("diffuse", &fields, &gradient[0], |f| &mut f.diffuse, 2e-3, of);
}

#[test]
fn the_stages_see_the_same_loss() {
    let Problem { mut config, samples, mut fields } = problem();
    config.warm_up.prior = 0.0;
    config.fine_tuning.prior = 0.0;
    fields.deviation.fill(0.0);
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let joint = loss(&WarmUp::new(&config, &samples, fields.clone()));
    let normals = loss(&Normals::new(&config, &samples, &deviation, &fields, &backend));
    let diffuse = loss(&diffuse(&config, &samples, &deviation, &fields, &backend));
    assert!((normals / joint - 1.0).abs() < 1e-5, "{normals} {joint}");
    assert!((diffuse / joint - 1.0).abs() < 1e-5, "{diffuse} {joint}");
}
