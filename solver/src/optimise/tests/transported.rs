//! Light and albedo under explicit transport.

use super::*;
use crate::optimise::context::{SolveContext, TransportSetup};
use crate::optimise::recolour::recolour;
use crate::optimise::transported::Transported;
use crate::transport::{Beside, CHANNELS, Sky, Transport};

/// Nearness of the sky in the gradient test, in the unit of its gain.
const NEARNESS: f32 = 0.4;

#[test]
fn gradients_reach_light_albedo_networks_and_the_penalties() {
    let Problem { mut config, samples, state } = problem();
    config.transport.texture_size = SIDE;
    config.transport.rows = 4;
    config.transport.prior = 20.0;
    config.transport.grey_texel = 0.1;
    config.transport.light_colour = 0.3;
    let sky = Sky::even(4);
    let transport =
        Transport::new(&testing::dome(12), &sky, &config.transport, 0, Beside::Nearness);
    let backend = Cpu::new();
    let cells = CHANNELS * transport.cells();
    let light: Vec<f32> = (0..cells).map(|i| (i as f32 * 0.37).sin()).collect();
    let gradient = |state: &State, light: &[f32], nearness: f32| {
        let mut stage = Transported::new(&config, &transport, &samples, state, light.to_vec());
        stage.set_nearness(nearness);
        stage.gradient(state, &backend)
    };
    let found = gradient(&state, &light, NEARNESS);
    let loss = |state: &State| gradient(state, &light, NEARNESS).loss;
    assert_gradient("diffuse", &state, &found.diffuse, |s| &mut s.diffuse, 2e-3, loss);
    assert_gradient("specular", &state, &found.specular, |s| &mut s.specular, 1e-2, loss);
    fn networks(state: &mut State) -> &mut Vec<f32> {
        &mut state.networks.parameters
    }
    assert_gradient("networks", &state, &found.networks, networks, 1e-3, loss);
    let largest = found.light.iter().fold(0.0f32, |m, g| m.max(g.abs()));
    for at in (0..cells).filter(|at| found.light[*at].abs() > 0.3 * largest).step_by(3) {
        let moved = |step: f32| {
            let mut light = light.clone();
            light[at] += step;
            gradient(&state, &light, NEARNESS).loss
        };
        let expected = (moved(3e-3) - moved(-3e-3)) / 6e-3;
        let error = (f64::from(found.light[at]) - expected).abs();
        assert!(error < 0.01 * f64::from(largest), "{at}: {} not {expected}", found.light[at]);
    }
    let moved = |step: f32| gradient(&state, &light, NEARNESS + step).loss;
    let expected = (moved(1e-2) - moved(-1e-2)) / 2e-2;
    let error = (f64::from(found.nearness) - expected).abs();
    assert!(error < 0.01 * expected.abs(), "nearness: {} not {expected}", found.nearness);
}

/// Light that falls off to one side: on an unoccluded surface its irradiance is pi (1 + 2/3 a n).
const FALL: Vec3 = Vec3::new(0.9, 0.0, 0.0);

#[test]
fn under_a_known_light_hair_in_the_shade_gets_its_own_colour_and_skin_stays() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = testing::dome(24);
    let shade = |p: Vec3| {
        let (label, albedo) = region(p);
        (albedo * (1.0 + 2.0 / 3.0 * FALL.dot(p.normalize())), label)
    };
    let views: Vec<View> =
        testing::rig(6, 128).iter().map(|camera| testing::view(&mesh, camera, shade)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    let capture = Capture::open(folder.path()).unwrap();
    let mut config = small();
    config.transport.bounces = 0;
    config.transport.texture_size = 128;
    let backend = Cpu::new();
    let context = SolveContext::new(&backend, &capture, &config);
    let transport = context.transport(TransportSetup { nearness: 0.0, bounce_albedo: 0.4 });
    let centres = Sky::even(config.transport.rows).centres();
    let light: Vec<f32> = centres.iter().flat_map(|w| [1.0 + FALL.dot(*w); 3]).collect();
    let mut state = context.initial_state();
    state.resize(transport.size());
    state.specular.fill(0.0);
    let before = state.diffuse.clone();
    let samples = context.pictures().samples(&context.space, transport.size());
    recolour(&context, transport, &samples, &light, None, &mut state);
    let of = |diffuse: &[f32], label: u8| -> Vec<Vec3> {
        let atlas = capture::gbuffer::Atlas::new(&mesh, state.size);
        let inside = (0..atlas.positions.len()).filter(|at| {
            let p = atlas.positions[*at];
            let around = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y].map(|d| p + 0.1 * d);
            atlas.inside[*at] && p.z > 0.3 && around.iter().all(|p| region(*p).0 == label)
        });
        inside.map(|at| Vec3::from_slice(&diffuse[3 * at..])).collect()
    };
    let [(skin, _), _, (shaded, albedo)] = REGIONS;
    let off = |texels: &[Vec3]| {
        texels
            .iter()
            .map(|a| (*a / (context.gain * albedo) - 1.0).abs().max_element())
            .fold(0.0, f32::max)
    };
    let [begun, found] = [&before, &state.diffuse].map(|diffuse| off(&of(diffuse, shaded)));
    assert!(begun > 0.2 && found < 0.05, "off by {begun}, then by {found}");
    assert!(of(&before, skin).len() > 50);
    assert!(of(&before, skin) == of(&state.diffuse, skin), "skin has changed");
}
