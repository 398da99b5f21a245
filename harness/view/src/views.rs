//! The training views as the page shows them: pictures, cameras, and the texels that each view sees.

use std::path::Path;

use capture::gbuffer::{Atlas, GBuffer};
use capture::projection::{Observation, Projection, per_texel};
use capture::{Capture, View};
use formats::picture::Picture;
use half::f16;
use serde::Serialize;

use crate::error::ViewError;
use crate::packed::{Array, Element, Stored};

/// Pixels of all pictures of a page together, at most; larger pictures are averaged down.
const MOST_PIXELS: usize = 10 * 512 * 512;

/// Bits of a half float's fraction that a picture does without: values are kept to 0.4 %, below the noise.
const DROPPED_BITS: u16 = 3;

/// The code of a pixel that does not show the mesh.
const NOT_A_NUMBER: i64 = 0x7e00;

/// A training view.
#[derive(Serialize)]
pub(crate) struct StoredView {
    name: String,
    width: usize,
    height: usize,
    /// Pixels of the capture's picture along a pixel of this one.
    step: usize,
    focal: [f32; 2],
    centre: [f32; 2],
    /// Camera to world by columns, OpenGL axes.
    camera_to_world: [f32; 16],
    /// Linear radiance; not a number outside the mask.
    picture: Stored,
}

/// The views, and which of them see each texel.
#[derive(Serialize)]
pub(crate) struct Views {
    list: Vec<StoredView>,
    /// For each texel a bit for each view, the first in the lowest bit of the first byte.
    seen: Stored,
}

impl Views {
    /// Writes the pictures of a capture, and the views of each of `size` x `size` texels.
    pub fn write(capture: &Capture, size: usize, folder: &Path) -> Result<Self, ViewError> {
        let pixels: usize = capture.train.iter().map(|view| view.mask.data.len()).sum();
        let step = (1..).find(|step| pixels / (step * step) <= MOST_PIXELS).unwrap_or(1);
        let list = capture.train.iter().enumerate();
        let list = list.map(|(at, view)| store(view, step, at, folder));
        let list = list.collect::<Result<_, _>>()?;
        Ok(Self { list, seen: seen(capture, size).write(folder, "seen")? })
    }
}

fn store(view: &View, step: usize, at: usize, folder: &Path) -> Result<StoredView, ViewError> {
    let scale = 1.0 / step as f32;
    let camera = &view.camera;
    let picture = reduced(view, step);
    let code = |value: &f32| {
        if value.is_nan() {
            return NOT_A_NUMBER;
        }
        let bits = f16::from_f32(value.clamp(0.0, 60_000.0)).to_bits();
        let half_step = 1 << (DROPPED_BITS - 1);
        i64::from((bits + half_step) >> DROPPED_BITS << DROPPED_BITS)
    };
    let Picture { width, height, channels, .. } = picture;
    let codes = picture.data.iter().map(code).collect();
    let array = Array { width, height, channels, element: Element::Half, scale: 1.0, codes };
    Ok(StoredView {
        name: camera.name.clone(),
        width,
        height,
        step,
        focal: camera.focal.map(|value| value * scale),
        centre: camera.centre.map(|value| value * scale),
        camera_to_world: camera.camera_to_world.to_cols_array(),
        picture: array.write(folder, &format!("view-{at}"))?,
    })
}

/// The picture averaged over the pixels of `step` x `step` that show the mesh; not a number where none does.
fn reduced(view: &View, step: usize) -> Picture {
    let (width, height) = (view.image.width.div_ceil(step), view.image.height.div_ceil(step));
    let mut sums = Picture::new(width, height, 3);
    let mut counts = vec![0.0f32; width * height];
    for y in 0..view.image.height {
        for x in 0..view.image.width {
            if view.mask.data[y * view.mask.width + x] == 255 {
                let target = sums.pixel_mut(x / step, y / step);
                target.iter_mut().zip(view.image.pixel(x, y)).for_each(|(sum, v)| *sum += v);
                counts[y / step * width + x / step] += 1.0;
            }
        }
    }
    for (pixel, count) in sums.data.chunks_exact_mut(3).zip(counts) {
        pixel.iter_mut().for_each(|sum| *sum = if count > 0.0 { *sum / count } else { f32::NAN });
    }
    sums
}

fn seen(capture: &Capture, size: usize) -> Array {
    let gbuffers = GBuffer::of_views(&capture.mesh, &capture.train);
    let projections = Projection::of_views(&capture.train, &gbuffers);
    let atlas = Atlas::new(&capture.mesh, size);
    let bytes = capture.train.len().div_ceil(8);
    let bits = |seen: &[(usize, Observation)]| {
        let mut bits = vec![0i64; bytes];
        seen.iter().for_each(|(view, _)| bits[view / 8] |= 1 << (view % 8));
        bits
    };
    let found = per_texel(&atlas, &projections, bits);
    let none = vec![0; bytes];
    let codes = found.iter().flat_map(|bits| if bits.is_empty() { &none } else { bits });
    let codes = codes.copied().collect();
    Array { width: size, height: size, channels: bytes, element: Element::U8, scale: 1.0, codes }
}
