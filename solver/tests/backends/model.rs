//! The pixel model in f64, and test inputs.

use solver::config::PaperConfig;
use solver::model::networks::{Network, Networks};
use solver::model::planes::Planes;
use solver::model::samples::Samples;
use solver::model::taps::Taps;

/// More than a chunk, and not a whole number of blocks.
pub const LEN: usize = 8192 + 300;
/// Samples that the reference evaluates: the first ones and the last.
pub const CHECKED: [usize; 4] = [0, 255, 256, LEN - 1];

pub fn noise(seed: usize, index: usize) -> f32 {
    let x = ((seed * 7919 + index) as f64 * 12.9898).sin() * 43758.5453;
    (x - x.floor()) as f32
}

pub fn planes<const R: usize>(seed: usize, low: f32, high: f32) -> Planes {
    let value = |i: usize, row: usize| low + (high - low) * noise(seed + row, i);
    Planes::from_fn::<R>(LEN, |i| std::array::from_fn(|row| value(i, row)))
}

/// Only the samples in `weighted` have weights above 0, so that a gradient can be compared with theirs.
pub fn samples(weighted: &[usize]) -> Samples {
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

pub fn networks() -> Networks {
    // Seed 2 closes some of the ReLUs and leaves others open.
    Networks::new(&PaperConfig::default().networks, 2)
}

/// The outputs of one network in f64.
pub fn perceptron(networks: &Networks, p: &[f64], network: Network, x: [f64; 3]) -> Vec<f64> {
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
pub struct Point {
    pub position: [f64; 3],
    pub directions: [f64; 6],
    pub albedo: [f64; 4],
    pub fresnel: f64,
    pub target: [f64; 3],
    pub weight: f64,
}

pub fn point(s: &Samples, directions: &Planes, albedo: &Planes, i: usize) -> Point {
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

pub fn loss(networks: &Networks, p: &[f64], points: &[Point]) -> f64 {
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
