//! Bilinear taps, computed once: textures are sampled per pixel, gradients are gathered per texel.
//!
//! Samples are sorted by texel. The gradient of a texture row then comes from two contiguous runs
//! of samples, read in a fixed order: no atomics, and the same sums for any number of threads.

use glam::Vec2;
use rayon::prelude::*;

use super::planes::Planes;

/// The four texels around each sample, with bilinear weights; outside the texture it is clamped.
#[derive(Clone, Debug)]
pub struct Taps {
    size: usize,
    /// Upper left texel of each sample, row-major, ascending.
    cell: Vec<u32>,
    /// Position between that texel's centre and the next ones', right and down, 0 to 1.
    fraction: Vec<[f32; 2]>,
    /// First sample of every row of cells, and the number of samples.
    row_start: Vec<usize>,
}

impl Taps {
    /// Sorts samples by texel: returns the taps, and for each of them which `uvs` it came from.
    pub fn sorted(size: usize, uvs: &[Vec2]) -> (Self, Vec<usize>) {
        let place = |uv: &Vec2| {
            let clamp = |x: f32| (x * size as f32 - 0.5).clamp(0.0, (size - 1) as f32);
            let (x, y) = (clamp(uv.x), clamp(1.0 - uv.y));
            let (x0, y0) = ((x as usize).min(size - 2), (y as usize).min(size - 2));
            ((y0 * size + x0) as u32, [x - x0 as f32, y - y0 as f32])
        };
        let placed: Vec<_> = uvs.par_iter().map(place).collect();
        let mut order: Vec<usize> = (0..uvs.len()).collect();
        order.par_sort_by_key(|sample| (placed[*sample].0, *sample));
        let cell: Vec<u32> = order.iter().map(|sample| placed[*sample].0).collect();
        let fraction = order.iter().map(|sample| placed[*sample].1).collect();
        let row_start = (0..=size)
            .map(|row| cell.partition_point(|cell| (*cell as usize) < row * size))
            .collect();
        (Self { size, cell, fraction, row_start }, order)
    }

    /// Texture side, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Upper left texel of every sample, row-major, ascending.
    pub fn cells(&self) -> &[u32] {
        &self.cell
    }

    /// Of every sample, its place between that texel's centre and the next ones', right and down.
    pub fn fractions(&self) -> &[[f32; 2]] {
        &self.fraction
    }

    /// Samples a texture of `C` interleaved channels.
    pub fn sample<const C: usize>(&self, texture: &[f32]) -> Planes {
        let (texels, _) = texture.as_chunks::<C>();
        Planes::from_fn(self.cell.len(), |i| {
            let at = self.cell[i] as usize;
            let [fx, fy] = self.fraction[i];
            let [top, bottom] = [at, at + self.size].map(|left| {
                let (a, b) = (&texels[left], &texels[left + 1]);
                std::array::from_fn::<f32, C, _>(|c| a[c] + fx * (b[c] - a[c]))
            });
            std::array::from_fn::<f32, C, _>(|c| top[c] + fy * (bottom[c] - top[c]))
        })
    }

    /// The adjoint of [`Taps::sample`]: sums the samples' gradients (rows `first..first + C`) into
    /// the texels they were interpolated from.
    pub fn gather<const C: usize>(&self, gradient: &Planes, first: usize) -> Vec<f32> {
        let mut texels = vec![0.0; self.size * self.size * C];
        texels.par_chunks_mut(self.size * C).enumerate().for_each(|(row, line)| {
            let (line, _) = line.as_chunks_mut::<C>();
            if row > 0 {
                self.add_cells(row - 1, line, gradient, first, |fy| fy);
            }
            self.add_cells(row, line, gradient, first, |fy| 1.0 - fy);
        });
        texels
    }

    fn add_cells<const C: usize>(
        &self,
        row: usize,
        line: &mut [[f32; C]],
        gradient: &Planes,
        first: usize,
        vertical: impl Fn(f32) -> f32,
    ) {
        for i in self.row_start[row]..self.row_start[row + 1] {
            let x = self.cell[i] as usize - row * self.size;
            let [fx, fy] = self.fraction[i];
            let value = gradient.sample::<C>(i, first).map(|g| g * vertical(fy));
            for c in 0..C {
                line[x][c] += (1.0 - fx) * value[c];
                line[x + 1][c] += fx * value[c];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize) -> Vec<Vec2> {
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs().fract();
        (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect()
    }

    #[test]
    fn a_linear_texture_is_reproduced_and_clamped() {
        let size = 8;
        let ramp: Vec<f32> = (0..64).flat_map(|t| [(t % 8) as f32, (t / 8) as f32]).collect();
        let uvs = points(500);
        let (taps, order) = Taps::sorted(size, &uvs);
        let values = taps.sample::<2>(&ramp);
        for (i, source) in order.iter().enumerate() {
            let uv = uvs[*source];
            let expected = [uv.x, 1.0 - uv.y].map(|t| (t * 8.0 - 0.5).clamp(0.0, 7.0));
            for (c, expected) in expected.into_iter().enumerate() {
                assert!((values.get(c, i) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn gather_is_the_transpose_of_sample() {
        let (taps, _) = Taps::sorted(16, &points(1000));
        let texture: Vec<f32> = (0..16 * 16 * 3).map(|i| (i as f32 * 0.37).sin()).collect();
        let gradient = Planes::from_fn(1000, |i| [1.0, 2.0, 3.0].map(|k| (i as f32 * k).cos()));
        let sampled = taps.sample::<3>(&texture);
        let gathered = taps.gather::<3>(&gradient, 0);
        let left: f64 = (0..1000)
            .flat_map(|i| (0..3).map(move |c| (c, i)))
            .map(|(c, i)| f64::from(sampled.get(c, i)) * f64::from(gradient.get(c, i)))
            .sum();
        let right: f64 =
            gathered.iter().zip(&texture).map(|(g, t)| f64::from(*g) * f64::from(*t)).sum();
        assert!((left - right).abs() < 1e-3 * left.abs().max(1.0), "{left} {right}");
    }
}
