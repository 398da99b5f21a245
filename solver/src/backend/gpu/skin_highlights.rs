//! Highlights of a light on any normals, on a device.

use super::device::Device;
use super::pass::Pass;
use super::pieces::Pieces;
use crate::backend::resident::DeviceError;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{HIGHLIGHT_ROWS, SkinHighlights};

/// See [`SkinHighlights::on`].
pub(super) fn highlights(
    device: &Device,
    skin_highlights: &SkinHighlights,
    samples: &Samples,
    normals: &Planes,
    specular: &Planes,
) -> Result<Planes, DeviceError> {
    let parts = skin_highlights.parts(samples);
    let cells = parts.visible_solid_angle.len() / parts.from.len().max(1);
    let pieces = Pieces::new(device, samples.len(), HIGHLIGHT_ROWS);
    let surface = pieces.upload(device, "surface", &[normals, &samples.view, specular]);
    let out = pieces.zeros(device, "highlights", HIGHLIGHT_ROWS);
    let lit = device.filled("cells", parts.cells);
    let visible = device.filled("visible", parts.visible_solid_angle);
    let from: Vec<[f32; 3]> = parts.from.iter().map(|from| from.to_array()).collect();
    let from = device.filled("places", &from);
    let kernel =
        device.kernel("skin highlights", include_str!("wgsl/skin_highlights.wgsl"), &[], "urrrrrw");
    let [(a, a_weight), (b, b_weight)] = parts.skin.lobes();
    let [grazing, opposite] = parts.guards;
    let lobes = [a, a_weight, b, b_weight];
    let floats = [[parts.scale, parts.skin.f0, grazing, opposite], lobes].concat();
    let floats: Vec<u32> = floats.into_iter().map(f32::to_bits).collect();
    let pass = |(at, piece): (usize, &std::ops::Range<usize>)| {
        let row = device.filled("rows", &parts.row[piece.clone()]);
        let words = [&[piece.len() as u32, cells as u32], floats.as_slice()].concat();
        let words = device.uniform(&words);
        let buffers = [&words, &lit, &visible, &row, &from, &surface[at], &out[at]];
        Pass::over(device, &kernel, &buffers, piece.len())
    };
    let passes: Vec<Pass> = pieces.0.iter().enumerate().map(pass).collect();
    device.submit(&passes, None, 1);
    Ok(pieces.planes(HIGHLIGHT_ROWS, &device.read(&out.iter().collect::<Vec<_>>())?))
}
