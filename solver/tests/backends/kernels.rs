//! Every kernel against the model in f64, value by value, and derivatives against central differences in f64.

use solver::backend::cpu::{Cpu, Level};
use solver::backend::{Backend, DIRECTION_ROWS};
use solver::config::PaperConfig;
use solver::model::networks::{Network, Networks};
use solver::model::normals::DIRECTIONS;

use super::model::*;

fn central(value: impl Fn(f64) -> f64) -> f64 {
    (value(1e-6) - value(-1e-6)) / 2e-6
}

/// f32 against f64: a few units in the last place, amplified by sums of both signs.
fn assert_close(got: f32, expected: f64, scale: f64, what: &str) {
    let error = (f64::from(got) - expected).abs();
    assert!(error <= 2e-5 * scale, "{what}: {got} instead of {expected} (scale {scale})");
}

/// Two shapes: the published one, and one with other numbers of layers and neurons.
pub fn joint_gradients(backend: &dyn Backend) {
    let mut narrow = PaperConfig::default().networks;
    (narrow.width, narrow.hidden_layers, narrow.outputs) = (20, 3, 4);
    check_joint(backend, &networks());
    check_joint(backend, &Networks::new(&narrow, 2));
}

fn check_joint(backend: &dyn Backend, networks: &Networks) {
    let (samples, directions, albedo) =
        (samples(&CHECKED), planes::<DIRECTIONS>(20, -1.0, 1.0), planes::<4>(30, 0.1, 1.0));
    let name = backend.name();
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let points: Vec<Point> =
        CHECKED.iter().map(|i| point(&samples, &directions, &albedo, *i)).collect();
    let got = backend.joint(networks, &samples, &directions, &albedo);
    assert!((got.loss / loss(networks, &p, &points) - 1.0).abs() < 1e-5, "{name}");
    let largest = got.networks.iter().fold(0.0f32, |m, g| m.max(g.abs()));
    assert!(largest > 0.0);
    for network in Network::ALL {
        for layer in 0..networks.layers() {
            let (weights, biases) = networks.place(network, layer);
            for at in weights.step_by(5).chain(biases) {
                let expected = central(|step| {
                    let mut moved = p.clone();
                    moved[at] += step;
                    loss(networks, &moved, &points)
                });
                let what = format!("{name} {network:?} layer {layer} parameter {at}");
                assert_close(got.networks[at], expected, f64::from(largest), &what);
            }
        }
    }
    for (index, i) in CHECKED.into_iter().enumerate() {
        for row in 0..4 {
            let expected = central(|step| {
                let mut moved = points.clone();
                moved[index].albedo[row] += step;
                loss(networks, &p, &moved)
            });
            let what = format!("{name} albedo {row} of sample {i}");
            assert_close(got.albedo.get(row, i), expected, expected.abs().max(1e-6), &what);
        }
    }
    assert_eq!(got.albedo.sample::<4>(7, 0), [0.0; 4], "weight 0");
}

pub fn direction_gradients(backend: &dyn Backend) {
    let (samples, directions, albedo) =
        (samples(&CHECKED), planes::<DIRECTIONS>(21, -1.0, 1.0), planes::<4>(31, 0.1, 1.0));
    let networks = networks();
    let name = backend.name();
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let points: Vec<Point> =
        CHECKED.iter().map(|i| point(&samples, &directions, &albedo, *i)).collect();
    let light = backend.light(&networks, &samples.position);
    let (value, gradient) =
        backend.direction_gradient(&networks, &samples, &light, &directions, &albedo);
    assert!((value / loss(&networks, &p, &points) - 1.0).abs() < 1e-5, "{name}");
    for (index, i) in CHECKED.into_iter().enumerate() {
        for row in 0..DIRECTION_ROWS {
            let expected = central(|step| {
                let mut moved = points.clone();
                match moved[index].directions.get_mut(row) {
                    Some(direction) => *direction += step,
                    None => moved[index].albedo[3] += step,
                }
                loss(&networks, &p, &moved)
            });
            let what = format!("{name} row {row} of sample {i}");
            assert_close(gradient.get(row, i), expected, expected.abs().max(1e-5), &what);
        }
    }
}

pub fn shading(backend: &dyn Backend) {
    let (samples, directions, albedo) = (
        samples(&(0..LEN).collect::<Vec<_>>()),
        planes::<DIRECTIONS>(22, -1.0, 1.0),
        planes::<4>(32, 0.1, 1.0),
    );
    let networks = networks();
    let name = backend.name();
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let reference = Cpu::at(Level::Portable).joint(&networks, &samples, &directions, &albedo);
    let light = backend.light(&networks, &samples.position);
    let shading = backend.shade(&networks, &light, &directions);
    for i in CHECKED {
        let q = point(&samples, &directions, &albedo, i);
        let [nx, ny, nz, ..] = q.directions;
        let light = perceptron(&networks, &p, Network::Light, q.position);
        let kernel = perceptron(&networks, &p, Network::Diffuse, [nx, ny, nz]);
        let expected: f64 = light.iter().zip(kernel).map(|(l, k)| l * k).sum();
        assert_close(shading.get(0, i), expected, expected, "diffuse shading");
    }
    let joint = backend.joint(&networks, &samples, &directions, &albedo);
    assert!((joint.loss / reference.loss - 1.0).abs() < 1e-6, "{name}: {}", joint.loss);
    let norm: f32 = reference.networks.iter().map(|g| g * g).sum::<f32>().sqrt();
    let pairs = joint.networks.iter().zip(&reference.networks);
    let error: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt();
    assert!(error < 1e-5 * norm, "{name} differs from portable by {error} of {norm}");
}
