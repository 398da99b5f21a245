//! One of the albedos under known shading.

use super::computing::Gpu;
use super::pass::{Pass, THREADS};
use super::pieces::{DeviceTaps, Pieces};
use super::program::{Moved, Program, prior};
use crate::model::planes::Planes;
use crate::model::taps::Taps;

/// Rows before the shading; see [`crate::backend::resident::Job::Layer`].
const FIRST: usize = 4;

/// The fit of one albedo under fixed shading.
pub(super) fn program<'a>(gpu: &'a Gpu, taps: &Taps, known: &Planes, weight: f32) -> Program<'a> {
    let device = &gpu.device;
    let channels = known.rows() - FIRST;
    let pieces = Pieces::new(device, known.len(), known.rows());
    let size = taps.size();
    let taps = DeviceTaps::new(device, &pieces, taps);
    let albedo = Moved::new(device, "albedo", channels * size * size);
    let shading = pieces.upload(device, "shading", &[known]);
    let by_albedo = pieces.zeros(device, "albedo gradients", channels);
    let groups: Vec<usize> = pieces.0.iter().map(|piece| piece.len().div_ceil(THREADS)).collect();
    let losses = device.floats("partial losses", groups.iter().sum());

    let constants = [("CHANNELS", channels as u32)];
    let source = include_str!("wgsl/layer.wgsl");
    let kernel = device.kernel("albedo", source, &constants, "urrrrww");
    let scale = 1.0 / (3.0 * known.len() as f32);
    let mut first = 0;
    let mut passes = vec![];
    for (at, (piece, groups)) in pieces.0.iter().zip(&groups).enumerate() {
        let words = [piece.len() as u32, size as u32, first as u32, scale.to_bits()];
        let buffers = [
            &device.uniform(&words),
            &taps.cell[at],
            &taps.fraction[at],
            &albedo.values,
            &shading[at],
            &by_albedo[at],
            &losses,
        ];
        let pass = Pass::new(device, &kernel, &buffers, *groups)
            .doing(piece.len(), 20 * channels, 3 + known.rows() + channels)
            .doing(taps.texels(piece), 0, channels);
        passes.push(pass);
        first += groups;
    }
    let (prior_pass, prior_sums) = prior(device, &albedo, size, weight).unzip();
    let add = prior_pass.is_some();
    passes.extend(prior_pass);
    let rows = [0, channels];
    passes.extend(taps.gather(device, &by_albedo, rows, &albedo.gradient, channels, add));
    let mut losses = vec![(losses, first)];
    losses.extend(prior_sums);
    Program::new(gpu, passes, &losses, vec![albedo])
}
