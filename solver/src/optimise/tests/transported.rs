//! Light and albedo under explicit transport.

use super::*;
use crate::optimise::transported::Transported;
use crate::transport::{Beside, CHANNELS, Sky, Transport};

/// Of the sky in the gradient test, in the unit of its gain.
const NEARNESS: f32 = 0.4;

#[test]
fn gradients_reach_light_albedo_networks_and_the_penalties() {
    let Problem { mut config, samples, state } = problem();
    config.transport.texture_size = SIDE;
    config.transport.rows = 4;
    config.transport.prior = 20.0;
    config.transport.grey_texel = 0.1;
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
