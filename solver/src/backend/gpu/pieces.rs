//! Samples on the device, in pieces that fit the bindings which every adapter allows.

use std::ops::Range;
use std::sync::Arc;

use super::device::{Device, PIECE_ROWS};
use super::kernel::Kernel;
use super::pass::Pass;
use crate::model::planes::{BLOCK, Planes, Row};
use crate::model::samples::Samples;
use crate::model::taps::Taps;

/// Ranges of samples, whole blocks each.
#[derive(Clone)]
pub(super) struct Pieces(pub Vec<Range<usize>>);

impl Pieces {
    /// Pieces of `len` samples whose widest planes have `rows` rows.
    pub fn new(device: &Device, len: usize, rows: usize) -> Self {
        let piece = (device.piece * PIECE_ROWS / rows.max(PIECE_ROWS) / BLOCK * BLOCK).max(BLOCK);
        let cut = |first: usize| first..len.min(first + piece);
        Self((0..len).step_by(piece).map(cut).collect())
    }

    /// Planes of `rows` rows for every piece, all zero.
    pub fn zeros(&self, device: &Device, name: &'static str, rows: usize) -> Vec<wgpu::Buffer> {
        self.0.iter().map(|piece| device.floats(name, padded(piece) * rows)).collect()
    }

    /// The planes, side by side.
    pub fn upload(
        &self,
        device: &Device,
        name: &'static str,
        planes: &[&Planes],
    ) -> Vec<wgpu::Buffer> {
        let rows: usize = planes.iter().map(|planes| planes.rows()).sum();
        let one = |piece: &Range<usize>| {
            let blocks = piece.start / BLOCK..piece.end.div_ceil(BLOCK);
            let parts = blocks
                .flat_map(|block| planes.iter().flat_map(move |planes| planes.block(block)))
                .map(|row: &Row| row.0.as_slice());
            device.rows(name, padded(piece) * rows, parts)
        };
        self.0.iter().map(one).collect()
    }

    /// Planes of `rows` rows from what is in the buffers of the pieces.
    pub fn planes(&self, rows: usize, contents: &[Vec<f32>]) -> Planes {
        let len = self.0.last().map_or(0, |piece| piece.end);
        let mut planes = Planes::new(rows, len);
        let values = contents.iter().flat_map(|content| content.as_chunks::<BLOCK>().0);
        planes.data_mut().iter_mut().zip(values).for_each(|(row, values)| row.0 = *values);
        clear_padding(&mut planes);
        planes
    }
}

/// Samples of whole blocks.
pub(super) fn padded(piece: &Range<usize>) -> usize {
    piece.len().next_multiple_of(BLOCK)
}

/// The padding of the last block is zero on the host.
fn clear_padding(planes: &mut Planes) {
    let (rows, used) = (planes.rows(), planes.len() % BLOCK);
    if used > 0 {
        let first = planes.data_mut().len() - rows;
        planes.data_mut()[first..].iter_mut().for_each(|row| row.0[used..].fill(0.0));
    }
}

/// Rows of a sample's pixel: Fresnel factor, target R, G, B, weight.
pub(super) fn pixels(device: &Device, pieces: &Pieces, samples: &Samples) -> Vec<wgpu::Buffer> {
    pieces.upload(device, "pixels", &[&samples.fresnel, &samples.target, &samples.weight])
}

/// Taps on the device.
pub(super) struct DeviceTaps {
    pieces: Pieces,
    size: usize,
    len: usize,
    pub cell: Vec<wgpu::Buffer>,
    pub fraction: Vec<wgpu::Buffer>,
    start: wgpu::Buffer,
    cells: Vec<[u32; 2]>,
}

impl DeviceTaps {
    pub fn new(device: &Device, pieces: &Pieces, taps: &Taps) -> Self {
        let (cell, fraction) = (taps.cells(), taps.fractions());
        let size = taps.size();
        let mut start = vec![0u32; size * size + 1];
        cell.iter().for_each(|cell| start[*cell as usize + 1] += 1);
        (0..size * size).for_each(|at| start[at + 1] += start[at]);
        let of = |piece: &Range<usize>| [cell[piece.start], cell[piece.end - 1]];
        Self {
            pieces: pieces.clone(),
            size,
            len: cell.len(),
            cell: pieces
                .0
                .iter()
                .map(|piece| device.filled("cells", &cell[piece.clone()]))
                .collect(),
            fraction: pieces
                .0
                .iter()
                .map(|piece| device.filled("fractions", &fraction[piece.clone()]))
                .collect(),
            start: device.filled("first samples", &start),
            cells: pieces.0.iter().map(of).collect(),
        }
    }

    /// Samples a texture of `channels` channels into the rows from `row` on of planes of `rows` rows.
    pub fn sample(
        &self,
        device: &Device,
        texture: &wgpu::Buffer,
        channels: usize,
        planes: &[wgpu::Buffer],
        rows: [usize; 2],
    ) -> Vec<Pass> {
        self.sample_from(device, (texture, 0), channels, planes, rows)
    }

    /// [`Self::sample`] of a texture that begins within its buffer.
    pub fn sample_from(
        &self,
        device: &Device,
        (texture, first): (&wgpu::Buffer, usize),
        channels: usize,
        planes: &[wgpu::Buffer],
        [row, rows]: [usize; 2],
    ) -> Vec<Pass> {
        let constants = [("CHANNELS", channels as u32)];
        let source = include_str!("wgsl/sample.wgsl");
        let kernel = device.kernel("sampling", source, &constants, "urrrw");
        let one = |(at, piece): (usize, &Range<usize>)| {
            let words = [piece.len(), self.size, row, rows, first].map(|word| word as u32);
            let parameters = device.uniform(&words);
            let buffers = [&parameters, &self.cell[at], &self.fraction[at], texture, &planes[at]];
            let pass = Pass::over(device, &kernel, &buffers, piece.len());
            pass.doing(piece.len(), 6 * channels, 3 + channels).doing(
                self.texels(piece),
                0,
                channels,
            )
        };
        self.pieces.0.iter().enumerate().map(one).collect()
    }

    /// Gathers the rows from `row` on of planes of `rows` rows into a gradient of `channels` channels;
    /// `add` to what is there.
    pub fn gather(
        &self,
        device: &Device,
        planes: &[wgpu::Buffer],
        [row, rows]: [usize; 2],
        gradient: &wgpu::Buffer,
        channels: usize,
        add: bool,
    ) -> Vec<Pass> {
        self.gather_to(device, planes, [row, rows], (gradient, 0), channels, add)
    }

    /// [`Self::gather`] into a gradient that begins within its buffer.
    pub fn gather_to(
        &self,
        device: &Device,
        planes: &[wgpu::Buffer],
        [row, rows]: [usize; 2],
        (gradient, offset): (&wgpu::Buffer, usize),
        channels: usize,
        add: bool,
    ) -> Vec<Pass> {
        // As many threads to a texel as keep a few samples for each.
        let each = 4 * self.len / (self.size * self.size);
        let lanes = [64, 16, 4].into_iter().find(|lanes| each >= 4 * lanes).unwrap_or(1);
        let kernel = gathering(device, channels, lanes);
        let one = |(at, piece): (usize, &Range<usize>)| {
            // The first dispatch writes all texels, the others add to those they reach.
            let [first, last] = match at {
                0 => [0, self.size * self.size - 1],
                _ => {
                    let [first, last] = self.cells[at].map(|cell| cell as usize);
                    [first, (last + self.size + 1).min(self.size * self.size - 1)]
                }
            };
            let texels = last + 1 - first;
            let add = usize::from(add || at > 0);
            let words =
                [self.size, first, texels, piece.start, piece.len(), row, rows, add, offset];
            let parameters = device.uniform(&words.map(|word| word as u32));
            let buffers = [&parameters, &self.start, &self.fraction[at], &planes[at], gradient];
            let pass = Pass::new(device, &kernel, &buffers, texels.div_ceil(64 / lanes));
            pass.doing(piece.len(), 12 + 8 * channels, 2 + channels).doing(
                self.texels(piece),
                0,
                1 + channels,
            )
        };
        self.pieces.0.iter().enumerate().map(one).collect()
    }

    /// Texels around a piece's samples, about.
    pub fn texels(&self, piece: &Range<usize>) -> usize {
        (self.size * self.size * piece.len() / self.len.max(1)).min(4 * piece.len())
    }
}

fn gathering(device: &Device, channels: usize, lanes: usize) -> Arc<Kernel> {
    let constants = [("CHANNELS", channels as u32), ("LANES", lanes as u32)];
    device.kernel("gather", include_str!("wgsl/gather.wgsl"), &constants, "urrrw")
}
