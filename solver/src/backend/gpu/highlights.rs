//! Light and diffuse albedo with the highlights of the same light.

use super::computing::Gpu;
use super::matrix::{Matrix, Shading, by_light};
use super::pass::{Pass, THREADS};
use super::pieces::{DeviceTaps, Pieces};
use super::program::{Moved, Program, light_colour, prior};
use crate::backend::resident::HighlightsJob;
use crate::transport::CHANNELS;

/// The fit of light and albedo together.
pub(super) fn program<'a>(gpu: &'a Gpu, job: &HighlightsJob) -> Program<'a> {
    let device = &gpu.device;
    let samples = job.samples;
    let size = samples.taps.size();
    let texels = CHANNELS * size * size;
    let parts = job.transport.parts();
    let cells = parts.cells;
    let shading = Shading::new(device, &parts);
    let log_light = Moved::new(device, "light", CHANNELS * cells);
    let diffuse = Moved::new(device, "diffuse albedo", texels);
    let layer = device.floats("diffuse layer", texels);

    // A sample's row of the reflection has a weight for every cell.
    let pieces = Pieces::new(device, samples.len(), cells);
    let taps = DeviceTaps::new(device, &pieces, &samples.taps);
    let rows = job.reflection.rows();
    let reflection = |piece: &std::ops::Range<usize>| {
        Matrix::new(device, cells, &rows[cells * piece.start..cells * piece.end])
    };
    let reflections: Vec<Matrix> = pieces.0.iter().map(reflection).collect();
    let values = |name, piece: &std::ops::Range<usize>| device.floats(name, CHANNELS * piece.len());
    let highlights: Vec<_> = pieces.0.iter().map(|piece| values("highlights", piece)).collect();
    let sampled = pieces.zeros(device, "sampled layer", CHANNELS);
    let pixels = pieces.upload(device, "pixels", &[&samples.target, &samples.weight]);
    let groups: Vec<usize> = pieces.0.iter().map(|piece| piece.len().div_ceil(THREADS)).collect();
    let losses = device.floats("partial losses", groups.iter().sum());

    let light = &shading.light;
    let mut passes = shading.passes(device, &log_light.values);
    passes.push(shading.lit(device, &diffuse.values, &layer, false));
    passes.extend(taps.sample(device, &layer, CHANNELS, &sampled, [0, CHANNELS]));
    let source = include_str!("wgsl/highlights.wgsl");
    let kernel = device.kernel("highlights", source, &[], "urwww");
    let scale = 1.0 / (CHANNELS * samples.len()) as f32;
    let mut first = 0;
    for (at, (piece, groups)) in pieces.0.iter().zip(&groups).enumerate() {
        passes.push(reflections[at].product(device, light, &highlights[at]));
        let parameters = device.uniform(&[piece.len() as u32, first as u32, scale.to_bits()]);
        let buffers = [&parameters, &pixels[at], &sampled[at], &highlights[at], &losses];
        let pass = Pass::new(device, &kernel, &buffers, *groups);
        passes.push(pass.doing(piece.len(), 8 * CHANNELS, 1 + 5 * CHANNELS));
        first += groups;
    }
    let by_layer = &layer;
    passes.extend(taps.gather(device, &sampled, [0, CHANNELS], by_layer, CHANNELS, false));
    let (prior_pass, prior_sums) = prior(device, &diffuse, size, job.prior).unzip();
    let add = prior_pass.is_some();
    passes.extend(prior_pass);
    passes.push(shading.lit(device, by_layer, &diffuse.gradient, add));
    passes.push(shading.by_shading(device, [by_layer, &diffuse.values]));
    let mut matrices = vec![(&shading.matrix, &shading.by_row)];
    matrices.extend(reflections.iter().zip(&highlights));
    passes.extend(by_light(device, &matrices, light, &log_light.gradient));
    let (colour_pass, colour_sums) = light_colour(device, &log_light, job.light_colour).unzip();
    passes.extend(colour_pass);

    let mut losses = vec![(losses, first)];
    losses.extend(prior_sums);
    losses.extend(colour_sums);
    Program::new(gpu, passes, &losses, vec![log_light, diffuse])
}
