//! Every instruction set against the model written out in f64, value by value, and its derivatives
//! by central differences in f64.

use super::*;
use crate::config::Config;
use crate::model::normals::DIRECTIONS;
use crate::model::taps::Taps;

/// More than a chunk, and not a whole number of blocks.
const LEN: usize = 8192 + 300;
/// Samples that the reference evaluates: the first ones and the last.
const CHECKED: [usize; 4] = [0, 255, 256, LEN - 1];

fn noise(seed: usize, index: usize) -> f32 {
    let x = ((seed * 7919 + index) as f64 * 12.9898).sin() * 43758.5453;
    (x - x.floor()) as f32
}

fn planes<const R: usize>(seed: usize, low: f32, high: f32) -> Planes {
    let value = |i: usize, row: usize| low + (high - low) * noise(seed + row, i);
    Planes::from_fn::<R>(LEN, |i| std::array::from_fn(|row| value(i, row)))
}

/// Only the samples in `weighted` count, so that a gradient can be compared with theirs alone.
fn samples(weighted: &[usize]) -> Samples {
    Samples {
        position: planes::<3>(1, -1.0, 1.0),
        normal: planes::<3>(2, -1.0, 1.0),
        view: planes::<3>(3, -1.0, 1.0),
        fresnel: planes::<1>(4, 0.04, 1.0),
        target: planes::<3>(5, 0.0, 2.0),
        weight: Planes::from_fn(LEN, |i| {
            [if weighted.contains(&i) { 1.0 + noise(9, i) } else { 0.0 }]
        }),
        taps: Taps::sorted(16, &[]).0,
        pixel: vec![0; LEN],
        view_index: vec![0; LEN],
    }
}

fn networks() -> Networks {
    // Seed 2 closes some of the ReLUs and leaves others open.
    Networks::new(&Config::default().networks, 2)
}

/// The outputs of one network in f64.
fn perceptron(networks: &Networks, p: &[f64], network: Network, x: [f64; 3]) -> Vec<f64> {
    let mut values = x.to_vec();
    for layer in 0..networks.layers() {
        let (weights, biases) = networks.place(network, layer);
        let inputs = values.len();
        let row = |j: usize| -> f64 {
            let sum: f64 = (0..inputs).map(|k| p[weights.start + j * inputs + k] * values[k]).sum();
            sum + p[biases.start + j]
        };
        let next: Vec<f64> = (0..biases.len()).map(row).collect();
        let last = layer + 1 == networks.layers();
        let activate = |z: f64| match (last, network) {
            (false, _) => z.max(0.0),
            (true, Network::Light) => z.exp(),
            (true, _) => z.exp().ln_1p(),
        };
        values = next.into_iter().map(activate).collect();
    }
    values
}

/// The model's inputs at one sample, in f64.
#[derive(Clone)]
struct Point {
    position: [f64; 3],
    directions: [f64; 6],
    albedo: [f64; 4],
    fresnel: f64,
    target: [f64; 3],
    weight: f64,
}

fn point(s: &Samples, directions: &Planes, albedo: &Planes, i: usize) -> Point {
    let wide = |x: f32| f64::from(x);
    Point {
        position: s.position.sample::<3>(i, 0).map(wide),
        directions: directions.sample::<6>(i, 0).map(wide),
        albedo: albedo.sample::<4>(i, 0).map(wide),
        fresnel: wide(s.fresnel.get(0, i)),
        target: s.target.sample::<3>(i, 0).map(wide),
        weight: wide(s.weight.get(0, i)),
    }
}

fn loss(networks: &Networks, p: &[f64], points: &[Point]) -> f64 {
    let one = |q: &Point| {
        let light = perceptron(networks, p, Network::Light, q.position);
        let [nx, ny, nz, rx, ry, rz] = q.directions;
        let diffuse = perceptron(networks, p, Network::Diffuse, [nx, ny, nz]);
        let specular = perceptron(networks, p, Network::Specular, [rx, ry, rz]);
        let dot = |k: &[f64]| -> f64 { light.iter().zip(k).map(|(l, k)| l * k).sum() };
        let highlight = q.fresnel * q.albedo[3] * dot(&specular);
        let residual = |c: usize| (q.albedo[c] * dot(&diffuse) + highlight - q.target[c]).abs();
        q.weight * (0..3).map(residual).sum::<f64>()
    };
    points.iter().map(one).sum::<f64>() / (3.0 * LEN as f64)
}

fn central(value: impl Fn(f64) -> f64) -> f64 {
    (value(1e-6) - value(-1e-6)) / 2e-6
}

/// f32 against f64: a few units in the last place, amplified by sums of both signs.
fn assert_close(got: f32, expected: f64, scale: f64, what: &str) {
    let error = (f64::from(got) - expected).abs();
    assert!(error <= 2e-5 * scale, "{what}: {got} instead of {expected} (scale {scale})");
}

/// Two shapes: the published one, and one with other numbers of layers and neurons.
#[test]
fn joint_gradients_match_central_differences_for_every_kind_of_parameter() {
    let mut narrow = Config::default().networks;
    (narrow.width, narrow.hidden_layers, narrow.outputs) = (20, 3, 4);
    check_joint(&networks());
    check_joint(&Networks::new(&narrow, 2));
}

fn check_joint(networks: &Networks) {
    let (samples, directions, albedo) =
        (samples(&CHECKED), planes::<DIRECTIONS>(20, -1.0, 1.0), planes::<4>(30, 0.1, 1.0));
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let points: Vec<Point> =
        CHECKED.iter().map(|i| point(&samples, &directions, &albedo, *i)).collect();
    for level in Level::available() {
        let got = Cpu::at(level).joint(networks, &samples, &directions, &albedo);
        assert!((got.loss / loss(networks, &p, &points) - 1.0).abs() < 1e-5, "{level}");
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
                    let what = format!("{level} {network:?} layer {layer} parameter {at}");
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
                let what = format!("{level} albedo {row} of sample {i}");
                assert_close(got.albedo.get(row, i), expected, expected.abs().max(1e-6), &what);
            }
        }
        assert_eq!(got.albedo.sample::<4>(7, 0), [0.0; 4], "weight 0");
    }
}

#[test]
fn bend_gradients_match_central_differences() {
    let (samples, directions, albedo) =
        (samples(&CHECKED), planes::<DIRECTIONS>(21, -1.0, 1.0), planes::<4>(31, 0.1, 1.0));
    let networks = networks();
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let points: Vec<Point> =
        CHECKED.iter().map(|i| point(&samples, &directions, &albedo, *i)).collect();
    for level in Level::available() {
        let cpu = Cpu::at(level);
        let light = cpu.light(&networks, &samples.position);
        let (value, gradient) = cpu.bend(&networks, &samples, &light, &directions, &albedo);
        assert!((value / loss(&networks, &p, &points) - 1.0).abs() < 1e-5, "{level}");
        for (index, i) in CHECKED.into_iter().enumerate() {
            for row in 0..BENT {
                let expected = central(|step| {
                    let mut moved = points.clone();
                    match moved[index].directions.get_mut(row) {
                        Some(direction) => *direction += step,
                        None => moved[index].albedo[3] += step,
                    }
                    loss(&networks, &p, &moved)
                });
                let what = format!("{level} row {row} of sample {i}");
                assert_close(gradient.get(row, i), expected, expected.abs().max(1e-5), &what);
            }
        }
    }
}

#[test]
fn shading_matches_the_reference_and_the_levels_agree() {
    let (samples, directions, albedo) = (
        samples(&(0..LEN).collect::<Vec<_>>()),
        planes::<DIRECTIONS>(22, -1.0, 1.0),
        planes::<4>(32, 0.1, 1.0),
    );
    let networks = networks();
    let p: Vec<f64> = networks.parameters.iter().map(|w| f64::from(*w)).collect();
    let reference = Cpu::at(Level::Portable).joint(&networks, &samples, &directions, &albedo);
    for level in Level::available() {
        let cpu = Cpu::at(level);
        let light = cpu.light(&networks, &samples.position);
        let shading = cpu.shade(&networks, &light, &directions);
        for i in CHECKED {
            let q = point(&samples, &directions, &albedo, i);
            let [nx, ny, nz, ..] = q.directions;
            let light = perceptron(&networks, &p, Network::Light, q.position);
            let kernel = perceptron(&networks, &p, Network::Diffuse, [nx, ny, nz]);
            let expected: f64 = light.iter().zip(kernel).map(|(l, k)| l * k).sum();
            assert_close(shading.get(0, i), expected, expected, "diffuse shading");
        }
        let joint = cpu.joint(&networks, &samples, &directions, &albedo);
        assert!((joint.loss / reference.loss - 1.0).abs() < 1e-6, "{level}");
        let norm: f32 = reference.networks.iter().map(|g| g * g).sum::<f32>().sqrt();
        let pairs = joint.networks.iter().zip(&reference.networks);
        let error: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt();
        assert!(error < 1e-5 * norm, "{level} differs from portable by {error} of {norm}");
    }
}
