//! Shading under frozen networks, and its gradients.

use super::device::Device;
use super::kernel::Pass;
use super::layout::{Layout, TILE};
use super::pieces::{Pieces, pixels};
use crate::backend::BENT;
use crate::backend::resident::DeviceError;
use crate::model::networks::Networks;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

/// L(p) of every sample.
pub(super) fn light(
    device: &Device,
    networks: &Networks,
    position: &Planes,
) -> Result<Planes, DeviceError> {
    evaluated(device, networks, position, None)
}

/// S_d and S_s of every sample.
pub(super) fn shade(
    device: &Device,
    networks: &Networks,
    light: &Planes,
    directions: &Planes,
) -> Result<Planes, DeviceError> {
    evaluated(device, networks, directions, Some(light))
}

/// The light of positions, or with a light the shading of directions.
fn evaluated(
    device: &Device,
    networks: &Networks,
    inputs: &Planes,
    light: Option<&Planes>,
) -> Result<Planes, DeviceError> {
    let layout = Layout::new(&networks.shape);
    let rows = if light.is_some() { 2 } else { networks.outputs() };
    let pieces = Pieces::new(inputs.len(), networks.outputs());
    let constants = [("WHAT", u32::from(light.is_some()))];
    let source = include_str!("wgsl/shading.wgsl");
    let kernel = layout.kernel(device, "shading", source, &constants, "unrrw");
    let weights = device.filled("networks", &layout.pack(&networks.parameters));
    let inputs = pieces.upload(device, "directions", &[inputs]);
    // Without a light, one of the inputs stands in its place: no kernel reads it.
    let light = light.map(|light| pieces.upload(device, "light", &[light]));
    let out = pieces.zeros(device, "shading", rows);
    let pass = |(at, piece): (usize, &std::ops::Range<usize>)| {
        let parameters = device.uniform(&[piece.len() as u32]);
        let light = light.as_ref().map_or(&inputs[at], |light| &light[at]);
        let buffers = [&parameters, &weights, &inputs[at], light, &out[at]];
        Pass::new(device, &kernel, &buffers, piece.len().div_ceil(TILE))
    };
    let passes: Vec<Pass> = pieces.0.iter().enumerate().map(pass).collect();
    device.submit(&passes, None, 1);
    Ok(pieces.planes(rows, &device.read(&out.iter().collect::<Vec<_>>())?))
}

/// Loss, and gradients by directions and specular albedo.
pub(super) fn bend(
    device: &Device,
    networks: &Networks,
    samples: &Samples,
    light: &Planes,
    directions: &Planes,
    albedo: &Planes,
) -> Result<(f64, Planes), DeviceError> {
    let layout = Layout::new(&networks.shape);
    let pieces = Pieces::new(samples.len(), networks.outputs());
    let source = [include_str!("wgsl/pixel.wgsl"), include_str!("wgsl/bend.wgsl")].concat();
    let kernel = layout.kernel(device, "bent shading", &source, &[], "unrrrrww");
    let weights = device.filled("networks", &layout.pack(&networks.parameters));
    let [directions, light, albedo] =
        [("directions", directions), ("light", light), ("albedos", albedo)]
            .map(|(name, planes)| pieces.upload(device, name, &[planes]));
    let pixels = pixels(device, &pieces, samples);
    let gradient = pieces.zeros(device, "gradient", BENT);
    let groups: usize = pieces.0.iter().map(|piece| piece.len().div_ceil(TILE)).sum();
    let losses = device.floats("partial losses", groups);
    let scale = 1.0 / (3.0 * samples.len() as f32);
    let mut first = 0;
    let mut passes = vec![];
    for (at, piece) in pieces.0.iter().enumerate() {
        let parameters = device.uniform(&[piece.len() as u32, first as u32, scale.to_bits()]);
        let buffers = [
            &parameters,
            &weights,
            &directions[at],
            &light[at],
            &pixels[at],
            &albedo[at],
            &gradient[at],
            &losses,
        ];
        let groups = piece.len().div_ceil(TILE);
        passes.push(Pass::new(device, &kernel, &buffers, groups));
        first += groups;
    }
    device.submit(&passes, None, 1);
    let mut buffers = vec![&losses];
    buffers.extend(&gradient);
    let contents = device.read::<f32>(&buffers)?;
    let loss = contents[0][..first].iter().map(|loss| f64::from(*loss)).sum();
    Ok((loss, pieces.planes(BENT, &contents[1..])))
}
