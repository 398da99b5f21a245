//! Numbers of samples around the widths of vectors, workgroups and blocks, and textures of a few texels.

use glam::Vec2;
use solver::backend::Backend;
use solver::backend::cpu::{Cpu, Level};
use solver::model::networks::Networks;
use solver::model::planes::Planes;
use solver::model::samples::Samples;
use solver::model::taps::Taps;

use super::model::{networks, noise};

/// Numbers of samples; an interpreter has time for two of them.
const LENGTHS: &[usize] = if cfg!(miri) { &[1, 17] } else { &[0, 1, 15, 16, 17, 63, 65] };

/// Inputs of the kernels for the samples `first..first + len`.
struct Inputs {
    samples: Samples,
    directions: Planes,
    albedo: Planes,
}

impl Inputs {
    fn new(first: usize, len: usize) -> Self {
        fn planes<const R: usize>(first: usize, len: usize, seed: usize) -> Planes {
            let value = |i: usize, row: usize| 0.1 + 0.8 * noise(seed + row, first + i);
            Planes::from_fn::<R>(len, |i| std::array::from_fn(|row| value(i, row)))
        }
        let samples = Samples {
            position: planes::<3>(first, len, 1),
            normal: planes::<3>(first, len, 4),
            view: planes::<3>(first, len, 7),
            fresnel: planes::<1>(first, len, 10),
            target: planes::<3>(first, len, 11),
            weight: planes::<1>(first, len, 14),
            taps: Taps::sorted(16, &[]).0,
            pixel: vec![0; len],
            view_index: vec![0; len],
        };
        let (directions, albedo) = (planes::<6>(first, len, 15), planes::<4>(first, len, 21));
        Self { samples, directions, albedo }
    }

    fn evaluated(&self, backend: &dyn Backend, networks: &Networks) -> Evaluated {
        let Self { samples, directions, albedo } = self;
        let joint = backend.joint(networks, samples, directions, albedo);
        let light = backend.light(networks, &samples.position);
        let (loss, gradient) =
            backend.direction_gradient(networks, samples, &light, directions, albedo);
        let shading = backend.shade(networks, &light, directions);
        Evaluated {
            losses: [joint.loss, loss],
            networks: joint.networks,
            planes: [joint.albedo, gradient, light, shading],
        }
    }
}

/// All results of a backend.
struct Evaluated {
    losses: [f64; 2],
    networks: Vec<f32>,
    /// Gradients with respect to albedos and directions, light, shading.
    planes: [Planes; 4],
}

/// The results of any number of samples are those of the portable kernels for each sample.
pub fn samples(backend: &dyn Backend) {
    let (networks, portable) = (networks(), Cpu::at(Level::Portable));
    for &len in LENGTHS {
        let got = Inputs::new(0, len).evaluated(backend, &networks);
        let one = |first: usize| Inputs::new(first, 1).evaluated(&portable, &networks);
        let ones: Vec<Evaluated> = (0..len).map(one).collect();
        // The loss is a mean.
        let weight = 1.0 / len.max(1) as f64;
        let close = |got: f64, expected: f64, scale: f64, what: &str| {
            assert!(
                (got - expected).abs() <= 2e-5 * scale,
                "{what} of {len} samples: {got} instead of {expected}"
            );
        };
        for at in 0..2 {
            let expected = ones.iter().map(|one| one.losses[at]).sum::<f64>() * weight;
            close(got.losses[at], expected, expected, "loss");
        }
        let sum = |parameter: usize| -> f64 {
            ones.iter().map(|one| f64::from(one.networks[parameter])).sum::<f64>() * weight
        };
        let expected: Vec<f64> = (0..got.networks.len()).map(sum).collect();
        let largest = expected.iter().fold(0.0, |maximum: f64, value| maximum.max(value.abs()));
        assert!(len == 0 || largest > 0.0);
        for (got, expected) in got.networks.iter().zip(expected) {
            close(f64::from(*got), expected, largest, "gradient");
        }
        for (at, planes) in got.planes.iter().enumerate() {
            assert_eq!(planes.len(), len);
            let factor = if at < 2 { weight } else { 1.0 };
            for (i, one) in ones.iter().enumerate() {
                for row in 0..planes.rows() {
                    let expected = f64::from(one.planes[at].get(row, 0)) * factor;
                    let got = f64::from(planes.get(row, i));
                    close(got, expected, expected.abs().max(1e-3 * factor), "value");
                }
            }
            // Sums over whole blocks count on it.
            for block in 0..planes.blocks() {
                for row in planes.block(block) {
                    assert!(row.0[len - 256 * block..].iter().all(|value| *value == 0.0));
                }
            }
        }
    }
}

/// Sampling and its adjoint, against a loop over texels.
pub fn textures() {
    const CHANNELS: usize = 4;
    let sizes: &[usize] = if cfg!(miri) { &[2, 3] } else { &[2, 3, 64] };
    for (&size, &len) in sizes.iter().flat_map(|size| LENGTHS.iter().map(move |len| (size, len))) {
        // From beyond one border to beyond the other.
        let uv = |i: usize| Vec2::new(noise(1, i), noise(2, i)) * 1.2 - 0.1;
        let (taps, _) = Taps::sorted(size, &(0..len).map(uv).collect::<Vec<_>>());
        let texture: Vec<f32> = (0..CHANNELS * size * size).map(|i| noise(3, i)).collect();
        let by_sample = Planes::from_fn::<CHANNELS>(len, |i| {
            std::array::from_fn(|channel| noise(4 + channel, i) - 0.5)
        });
        let sampled = taps.sample::<CHANNELS>(&texture);
        let gathered = taps.gather::<CHANNELS>(&by_sample, 0);
        let mut expected = vec![0.0f32; texture.len()];
        for i in 0..len {
            let (cell, [fx, fy]) = (taps.cells()[i] as usize, taps.fractions()[i]);
            for channel in 0..CHANNELS {
                let mut value = 0.0;
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let across = if dx == 1 { fx } else { 1.0 - fx };
                    let factor = across * if dy == 1 { fy } else { 1.0 - fy };
                    let at = CHANNELS * (cell + dx + dy * size) + channel;
                    value += factor * texture[at];
                    expected[at] += factor * by_sample.get(channel, i);
                }
                let got = sampled.get(channel, i);
                assert!((got - value).abs() < 1e-6, "{len} samples of {size}²: {got}, {value}");
            }
        }
        for (got, expected) in gathered.iter().zip(&expected) {
            assert!((got - expected).abs() < 1e-5, "{len} into {size}²: {got}, {expected}");
        }
    }
}
