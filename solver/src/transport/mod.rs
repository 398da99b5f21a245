//! Shadowed diffuse light transport of a known mesh: what a texel receives from each cell of the
//! sky, with the mesh in between and light bounced off it.
//!
//! S_d(t, c) = sum over cells j of T(t, j) l(j, c), with T = T0 + a B T0 + a^2 B B T0. T0 is the
//! cosine-weighted visible solid angle of a cell over pi, by ray casts; B the same for what lies
//! behind the rays that meet the mesh, and a the albedo that bounces are given (precomputed
//! radiance transfer, Sloan et al. 2002, on an albedo held constant). A white texel in full light 1
//! from everywhere has S_d = 1.

mod rays;
mod sky;

use glam::Vec3;
use rayon::prelude::*;

use crate::capture::Mesh;
use crate::config::TransportConfig;
use crate::fill;
use crate::gbuffer::Atlas;
pub use rays::{Impact, Occluder};
pub use sky::{SkyRay, sky_rays};

/// Colour channels of the light.
pub const CHANNELS: usize = 3;
/// A ray starts this far from the surface, as a share of the mesh's longest side: clear of the
/// facets next to its own.
const LIFT: f32 = 1.6e-3;
/// Texels whose contributions to the gradient are summed by one task, in their order.
const CHUNK: usize = 256;
/// Independent sums of a product, which a compiler turns into vectors.
const LANES: usize = 16;

/// The transport of the texels of a chart.
#[derive(Clone, Debug)]
pub struct Transport {
    size: usize,
    cells: usize,
    /// One row per texel inside the chart.
    matrix: Vec<f32>,
    /// Of every texel of the square, its row or that of the nearest texel inside.
    row: Vec<u32>,
}

impl Transport {
    /// Casts all rays; memory is texels inside the chart x cells x 4 bytes, three times that while
    /// bounces are added.
    pub fn new(mesh: &Mesh, config: &TransportConfig, seed: u64) -> Self {
        let size = config.texture_size;
        let atlas = Atlas::new(mesh, size);
        let texels: Vec<usize> = (0..size * size).filter(|texel| atlas.inside[*texel]).collect();
        let mut number = vec![u32::MAX; size * size];
        texels.iter().enumerate().for_each(|(row, texel)| number[*texel] = row as u32);
        let nearest = fill::nearest_known(&atlas.inside, size, size);
        let row: Vec<u32> = nearest.iter().map(|texel| number[*texel as usize]).collect();

        let sky = sky_rays(config.rows, config.rays_per_cell_side, seed);
        let cells = 2 * config.rows * config.rows;
        let caster = Caster { occluder: Occluder::new(mesh), mesh, sky: &sky, row: &row, size };
        let (low, high) = mesh.bounds();
        let lift = LIFT * (high - low).max_element();
        let cast = |texel: &usize| {
            let normal = atlas.normals[*texel];
            caster.texel(atlas.positions[*texel] + lift * normal, normal, cells)
        };
        let (direct, bounces): (Vec<Vec<f32>>, Vec<Bounces>) = texels.par_iter().map(cast).unzip();
        let direct = direct.concat();
        let mut matrix = direct.clone();
        let mut last = direct;
        let mut albedo = 1.0;
        for _ in 0..config.bounces {
            albedo *= config.bounce_albedo;
            last = bounced(&bounces, &last, cells);
            matrix.par_iter_mut().zip(&last).for_each(|(sum, once)| *sum += albedo * once);
        }
        Self { size, cells, matrix, row }
    }

    /// Side of the chart's texture.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Cells of the sky.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Whether the chart covers no texel.
    pub fn is_empty(&self) -> bool {
        self.matrix.is_empty()
    }

    /// The diffuse shading, R, G, B per texel of the square, in a light of R, G, B per cell;
    /// outside the chart that of the nearest texel inside.
    pub fn shading(&self, light: &[f32]) -> Vec<f32> {
        let planes = self.planes(light);
        let rows: Vec<[f32; CHANNELS]> = self
            .matrix
            .par_chunks(self.cells)
            .map(|row| std::array::from_fn(|c| dot(row, &planes[c])))
            .collect();
        self.row.par_iter().flat_map_iter(|row| rows[*row as usize]).collect()
    }

    /// The adjoint of [`Self::shading`]: the gradient by the light.
    pub fn adjoint(&self, by_shading: &[f32]) -> Vec<f32> {
        let mut by_row = vec![[0.0f32; CHANNELS]; self.matrix.len() / self.cells];
        for (row, gradient) in self.row.iter().zip(by_shading.as_chunks::<CHANNELS>().0) {
            let sum = &mut by_row[*row as usize];
            (0..CHANNELS).for_each(|c| sum[c] += gradient[c]);
        }
        let part = |(rows, by_row): (&[f32], &[[f32; CHANNELS]])| {
            let mut sums = vec![0.0f32; CHANNELS * self.cells];
            for (row, gradient) in rows.chunks_exact(self.cells).zip(by_row) {
                for (channel, sums) in sums.chunks_exact_mut(self.cells).enumerate() {
                    let gradient = gradient[channel];
                    sums.iter_mut().zip(row).for_each(|(sum, t)| *sum += gradient * t);
                }
            }
            sums
        };
        let parts: Vec<Vec<f32>> = self
            .matrix
            .par_chunks(CHUNK * self.cells)
            .zip(by_row.par_chunks(CHUNK))
            .map(part)
            .collect();
        let total = |at: usize| parts.iter().map(|part| f64::from(part[at])).sum::<f64>() as f32;
        let at = |i: usize| i % CHANNELS * self.cells + i / CHANNELS;
        (0..CHANNELS * self.cells).map(|i| total(at(i))).collect()
    }

    /// The light, channel by channel.
    fn planes(&self, light: &[f32]) -> [Vec<f32>; CHANNELS] {
        std::array::from_fn(|c| light.iter().skip(c).step_by(CHANNELS).copied().collect())
    }
}

/// Weights of what lies behind the rays of a texel that meet the mesh: row and weight, by row.
type Bounces = Vec<(u32, f32)>;

struct Caster<'a> {
    occluder: Occluder,
    mesh: &'a Mesh,
    sky: &'a [SkyRay],
    row: &'a [u32],
    size: usize,
}

impl Caster<'_> {
    /// The row of T0 and that of B of a point.
    fn texel(&self, origin: Vec3, normal: Vec3, cells: usize) -> (Vec<f32>, Bounces) {
        let mut direct = vec![0.0; cells];
        let mut bounces = Bounces::new();
        for ray in self.sky {
            let cosine = normal.dot(ray.direction);
            if cosine <= 0.0 {
                continue;
            }
            let weight = cosine * ray.solid_angle * std::f32::consts::FRAC_1_PI;
            match self.occluder.first_hit(origin, ray.direction) {
                None => direct[ray.cell as usize] += weight,
                Some(hit) if hit.front => bounces.push((self.row_at(&hit), weight)),
                // The back of a surface is inside the head: dark.
                Some(_) => {}
            }
        }
        bounces.sort_by_key(|(row, _)| *row);
        bounces.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0.0 };
            same
        });
        (direct, bounces)
    }

    fn row_at(&self, hit: &Impact) -> u32 {
        let corners = self.mesh.triangles[hit.triangle as usize];
        let uv = corners.map(|corner| self.mesh.uvs[corner as usize]);
        let at = uv[0] * hit.barycentric.x + uv[1] * hit.barycentric.y + uv[2] * hit.barycentric.z;
        let texel = |x: f32| ((x * self.size as f32) as usize).min(self.size - 1);
        self.row[texel(1.0 - at.y) * self.size + texel(at.x)]
    }
}

/// B x `rows`.
fn bounced(bounces: &[Bounces], rows: &[f32], cells: usize) -> Vec<f32> {
    let mut out = vec![0.0; rows.len()];
    out.par_chunks_mut(cells.max(1)).zip(bounces).for_each(|(out, bounces)| {
        for (row, weight) in bounces {
            let from = &rows[*row as usize * cells..][..cells];
            out.iter_mut().zip(from).for_each(|(sum, value)| *sum += weight * value);
        }
    });
    out
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0f32; LANES];
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        (0..LANES).for_each(|lane| lanes[lane] += a[lane] * b[lane]);
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests;
