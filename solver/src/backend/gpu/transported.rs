//! Light, its nearness, albedos and networks under explicit transport.

use super::computing::Gpu;
use super::joint::Joint;
use super::layout::Layout;
use super::matrix::{Shading, by_light};
use super::pieces::{DeviceTaps, Pieces};
use super::program::{Moved, Program, light_colour, prior, total};
use crate::backend::ALBEDOS;
use crate::backend::resident::TransportedJob;
use crate::transport::CHANNELS;

/// The stages of the light, and of light and albedo.
pub(super) fn program<'a>(gpu: &'a Gpu, layout: Layout, job: &TransportedJob) -> Program<'a> {
    let device = &gpu.device;
    let samples = job.samples;
    let size = samples.taps.size();
    let texels = CHANNELS * size * size;
    let parts = job.transport.parts();
    let shading = Shading::new(device, &parts);
    let channels = CHANNELS * parts.cells;
    let log_light = Moved::new(device, "light", channels);
    let nearness = Moved::new(device, "nearness", 1);
    let diffuse = Moved::new(device, "diffuse albedo", texels);
    let specular = Moved::new(device, "specular albedo", size * size);
    let weights = Moved::new(device, "networks", 4 * layout.vectors());
    let layer = device.floats("diffuse layer", texels);
    let by_layer = device.floats("by diffuse layer", texels);

    let pieces = Pieces::new(device, samples.len(), ALBEDOS);
    let taps = DeviceTaps::new(device, &pieces, &samples.taps);
    let albedo = pieces.zeros(device, "albedos", ALBEDOS);
    let joint = Joint::new(device, &layout, pieces, albedo).layered();

    let mut passes = shading.passes(device, &log_light.values, &nearness.values);
    passes.push(shading.lit(device, &diffuse.values, &layer, false));
    passes.extend(taps.sample(device, &layer, CHANNELS, &joint.albedo, [0, ALBEDOS]));
    passes.extend(taps.sample(device, &specular.values, 1, &joint.albedo, [3, ALBEDOS]));
    let (values, gradient) = (&weights.values, &weights.gradient);
    passes.extend(joint.passes(device, &layout, samples, job.directions, values, gradient));
    let by_albedo = &joint.by_albedo;
    passes.extend(taps.gather(device, by_albedo, [0, ALBEDOS], &by_layer, CHANNELS, false));
    passes.extend(taps.gather(device, by_albedo, [3, ALBEDOS], &specular.gradient, 1, false));
    let (prior_pass, prior_sums) = prior(device, &diffuse, size, job.prior).unzip();
    let add = prior_pass.is_some();
    passes.extend(prior_pass);
    passes.push(shading.lit(device, &by_layer, &diffuse.gradient, add));
    let grey = [job.grey_mean, job.grey_texel];
    passes.extend(shading.by_shading(device, [&by_layer, &diffuse.values], grey));
    let matrices = [(&shading.matrix, &shading.by_row)];
    let light = [&shading.light, &nearness.values];
    passes.extend(by_light(device, &matrices, light, &log_light.gradient));
    let (colour_pass, colour_sums) = light_colour(device, &log_light, job.light_colour).unzip();
    passes.extend(colour_pass);
    let groups = shading.groups();
    let (penalties, by_nearness) = ([0, groups], [groups, groups]);
    passes.extend(total(device, &shading.partial, by_nearness, &nearness.gradient, false, false));

    let samples_loss = (joint.losses, joint.groups.iter().sum());
    let mut losses = vec![samples_loss, (shading.partial, penalties[1])];
    losses.extend(prior_sums);
    losses.extend(colour_sums);
    let moved = vec![log_light, nearness, diffuse, specular, weights.in_layout(layout)];
    Program::new(gpu, passes, &losses, moved)
}
