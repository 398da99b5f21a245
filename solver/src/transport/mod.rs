//! Shadowed diffuse light transport of a known mesh: what a texel receives from each cell of the
//! sky, with the mesh in between and light bounced off it.
//!
//! S_d(t, c) = sum over cells j of T(t, j) l(j, c), with T = T0 + a B T0 + a^2 B B T0. T0 is the
//! cosine-weighted visible solid angle of a cell over pi, by ray casts; B the same for what lies
//! behind the rays that meet the mesh, and a the albedo that bounces are given (precomputed
//! radiance transfer, Sloan et al. 2002, on an albedo held constant). A white texel in full light 1
//! from everywhere has S_d = 1.
//!
//! The cells lie on a sphere around the head's centre. Real lamps are a metre away, not infinitely
//! far: a cell of nearness k (inverse radius) in direction w from the centre lies along w - k x from a
//! point x, and brings it the cosine-weighted solid angle
//! dw (1 - k w.x) n.(w - k x) / |w - k x|^4.

mod channels;
mod highlights;
mod light_colour;
mod matrix;
mod reflection;
pub mod skin;
mod sky;
mod specular_term;

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::rays::{Impact, Occluder};
use formats::{cancel, fill};
use glam::Vec3;
use rayon::prelude::*;

use crate::config::TransportConfig;
pub use channels::CHANNELS;
pub(crate) use channels::LUMINANCE;
pub use highlights::{HIGHLIGHT_ROWS, SkinHighlights};
pub(crate) use light_colour::light_colour;
pub(crate) use matrix::add_scaled;
use matrix::{Bounces, Matrix};
pub use reflection::Reflection;
pub use sky::{Sky, SkyRay, contrast};
pub use specular_term::SpecularTerm;

/// Distance of a ray's start from the surface over the mesh's longest side: clear of the facets next to its own.
pub(crate) const RAY_OFFSET: f32 = 1.6e-3;
/// The change of the shading with the nearness is taken between a sphere of this radius and one at infinity, in halves
/// of the mesh's longest side: about a metre around a head.
const NEAR_RADIUS: f32 = 6.0;
/// Least radius of the sphere of the light, in the same unit.
const LEAST_RADIUS: f32 = 2.5;
/// Exponent of the cosine lobe through which highlights see the light: 10 degrees, about a cell, which is as sharp as
/// the cells describe a light.
pub(crate) const LIGHT_EXPONENT: i32 = 64;

/// The transport of the texels of a chart.
#[derive(Clone, Debug)]
pub struct Transport {
    size: usize,
    /// One row per texel inside the chart, one column per cell.
    matrix: Matrix,
    /// The gain of `matrix` when the sky comes nearer by [`Self::near`].
    gain: Option<Matrix>,
    /// Visible solid angle over pi.
    open: Matrix,
    /// Nearness that `gain` stands for, per metre.
    near: f32,
    /// From the sky's centre, of every row.
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    sky: Sky,
    /// The row of every texel of the square, or that of the nearest texel inside.
    row: Vec<u32>,
}

impl Transport {
    /// Casts all rays under a sky that stays where it is. Memory is texels inside the chart x cells x 8 bytes, three
    /// times that while bounces are added.
    pub fn new(mesh: &Mesh, sky: &Sky, config: &TransportConfig, seed: u64) -> Self {
        Self::cast(mesh, sky, config, seed, false)
    }

    /// Likewise, with the change of the shading as the sky comes nearer: half as much memory again.
    pub fn with_nearness(mesh: &Mesh, sky: &Sky, config: &TransportConfig, seed: u64) -> Self {
        Self::cast(mesh, sky, config, seed, true)
    }

    fn cast(
        mesh: &Mesh,
        sky: &Sky,
        config: &TransportConfig,
        seed: u64,
        has_nearness: bool,
    ) -> Self {
        let size = config.texture_size;
        let atlas = Atlas::new(mesh, size);
        let texels: Vec<usize> = (0..size * size).filter(|texel| atlas.inside[*texel]).collect();
        let mut number = vec![u32::MAX; size * size];
        texels.iter().enumerate().for_each(|(row, texel)| number[*texel] = row as u32);
        let nearest = fill::nearest_known(&atlas.inside, size, size);
        let row: Vec<u32> = nearest.iter().map(|texel| number[*texel as usize]).collect();

        let (low, high) = mesh.bounds();
        let longest = (high - low).max_element();
        let near = 2.0 / (NEAR_RADIUS * longest);
        let rays = sky.rays(config.rays_per_cell_side, seed);
        let caster = Caster {
            occluder: Occluder::new(mesh),
            mesh,
            rays: &rays,
            centre: 0.5 * (low + high),
            nearness: sky.nearness,
            near: sky.nearness + near,
            row: &row,
            size,
        };
        let lift = RAY_OFFSET * longest;
        let cells = sky.len();
        let entries = texels.len() * cells;
        let mut direct = vec![0.0; entries];
        let mut open = vec![0.0; entries];
        let mut gain = vec![0.0; if has_nearness { entries } else { 0 }];
        let mut parts = [&mut direct, &mut open, &mut gain].map(|rows| rows.chunks_mut(cells));
        let seen: Vec<Seen> = (0..texels.len())
            .map(|_| parts.each_mut().map(|rows| rows.next().unwrap_or_default()))
            .map(|[direct, open, gain]| Seen { direct, open, gain })
            .collect();
        let cast = |(texel, seen): (&usize, Seen)| {
            cancel::check();
            let normal = atlas.normals[*texel];
            caster.texel(atlas.positions[*texel] + lift * normal, normal, seen)
        };
        let bounces: Vec<Bounces> = texels.par_iter().zip(seen).map(cast).collect();
        let matrix = Matrix::with_bounces(direct, &bounces, cells, config);
        let open = Matrix { rows: open, cells };
        let with_bounces = |rows| Matrix::with_bounces(rows, &bounces, cells, config);
        let gain = (!gain.is_empty()).then(|| with_bounces(gain));
        let places = texels.iter().map(|texel| atlas.positions[*texel] - caster.centre).collect();
        let normals = texels.iter().map(|texel| atlas.normals[*texel]).collect();
        let sky = sky.clone();
        Self { size, matrix, gain, open, near, places, normals, sky, row }
    }

    /// Side of the chart's texture.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Cells of the sky.
    pub fn cells(&self) -> usize {
        self.matrix.cells
    }

    /// What a light of 1 from every cell adds to the shading of a texel of the square.
    pub fn cells_of(&self, texel: usize) -> &[f32] {
        &self.matrix.rows[self.row[texel] as usize * self.cells()..][..self.cells()]
    }

    /// Whether the chart covers no texel.
    pub fn is_empty(&self) -> bool {
        self.matrix.rows.is_empty()
    }

    /// The nearness, per metre, of the unit of [`Self::shading`]'s `nearer`.
    pub fn near(&self) -> f32 {
        self.near
    }

    /// The most that a sky at infinity may come nearer, in the same unit.
    pub fn nearest(&self) -> f32 {
        NEAR_RADIUS / LEAST_RADIUS
    }

    /// The diffuse shading, R, G, B per texel of the square, in a light of R, G, B per cell;
    /// outside the chart that of the nearest texel inside.
    pub fn shading(&self, light: &[f32]) -> Vec<f32> {
        self.spread(&self.matrix.product(light))
    }

    /// The adjoint of [`Self::shading`]: the gradient by the light.
    pub fn adjoint(&self, by_shading: &[f32]) -> Vec<f32> {
        self.matrix.adjoint(&self.collected(by_shading))
    }

    /// The shading when the sky has come nearer, to first order: by `nearer` times [`Self::near`]; and
    /// how it changes with `nearer`, if the transport holds that.
    pub fn shading_nearer(&self, light: &[f32], nearer: f32) -> (Vec<f32>, Option<Vec<f32>>) {
        let (mut shading, gain) = (self.shading(light), self.gain(light));
        if let Some(gain) = &gain {
            shading.iter_mut().zip(gain).for_each(|(s, gain)| *s += nearer * gain);
        }
        (shading, gain)
    }

    /// The adjoint of [`Self::shading_nearer`]: the gradient by the light.
    pub fn adjoint_nearer(&self, by_shading: &[f32], nearer: f32) -> Vec<f32> {
        let mut by_light = self.adjoint(by_shading);
        if let Some(gain) = self.gain_adjoint(by_shading) {
            by_light.iter_mut().zip(gain).for_each(|(g, gain)| *g += nearer * gain);
        }
        by_light
    }

    /// The gain of the shading as the sky comes nearer by [`Self::near`]; to first order.
    pub fn gain(&self, light: &[f32]) -> Option<Vec<f32>> {
        self.gain.as_ref().map(|gain| self.spread(&gain.product(light)))
    }

    /// The adjoint of [`Self::gain`].
    pub fn gain_adjoint(&self, by_shading: &[f32]) -> Option<Vec<f32>> {
        self.gain.as_ref().map(|gain| gain.adjoint(&self.collected(by_shading)))
    }

    /// How S_d of every channel changes with the normal (x, y, z of R, then of G and B; 9 values per
    /// texel of the square): the visible light summed as a vector. Of bounces and of what rises over
    /// the texel's horizon nothing.
    pub fn shading_by_normal(&self, light: &[f32]) -> Vec<f32> {
        let centres = self.sky.centres();
        let (light, _) = light.as_chunks::<CHANNELS>();
        let row = |(row, place): (&[f32], &Vec3)| {
            let mut sum = [Vec3::ZERO; CHANNELS];
            for ((open, centre), light) in row.iter().zip(&centres).zip(light) {
                if *open > 0.0 {
                    let towards = (*centre - self.sky.nearness * *place).normalize();
                    (0..CHANNELS).for_each(|c| sum[c] += open * light[c] * towards);
                }
            }
            let mut flat = [0.0; 3 * CHANNELS];
            (0..CHANNELS).for_each(|c| flat[3 * c..3 * c + 3].copy_from_slice(&sum[c].to_array()));
            flat
        };
        let rows: Vec<_> =
            self.open.rows.par_chunks(self.cells()).zip(&self.places).map(row).collect();
        self.spread(&rows)
    }

    /// The largest S_d that a texel in front (normal towards +Z) would have if nothing stood in the
    /// light's way, as Rec.709 luminance: what pictures are exposed by. 0 without such texels.
    pub fn peak(&self, light: &[f32]) -> f32 {
        let rays = self.sky.rays(1, 0);
        let light = luminances(light);
        let unoccluded = |(place, normal): (&Vec3, &Vec3)| -> f32 {
            let rays = rays.iter().zip(&light);
            rays.map(|(ray, l)| l * received(ray, *place, *normal, self.sky.nearness)).sum()
        };
        let front = self.places.par_iter().zip(&self.normals).filter(|(_, normal)| normal.z > 0.0);
        front.map(unoccluded).reduce(|| 0.0, f32::max)
    }

    fn spread<const C: usize>(&self, rows: &[[f32; C]]) -> Vec<f32> {
        self.row.par_iter().flat_map_iter(|row| rows[*row as usize]).collect()
    }

    fn collected(&self, by_shading: &[f32]) -> Vec<[f32; CHANNELS]> {
        let mut by_row = vec![[0.0f32; CHANNELS]; self.matrix.rows.len() / self.cells().max(1)];
        for (row, gradient) in self.row.iter().zip(by_shading.as_chunks::<CHANNELS>().0) {
            let sum = &mut by_row[*row as usize];
            (0..CHANNELS).for_each(|c| sum[c] += gradient[c]);
        }
        by_row
    }
}

/// Rec.709 luminances of R, G, B per cell.
pub(crate) fn luminances(light: &[f32]) -> Vec<f32> {
    let luminance = |light: &[f32; CHANNELS]| light.iter().zip(LUMINANCE).map(|(l, w)| l * w).sum();
    light.as_chunks::<CHANNELS>().0.iter().map(luminance).collect()
}

/// The visibility of every cell from a texel.
struct Seen<'a> {
    /// Its row of T0.
    direct: &'a mut [f32],
    /// Its visibility, and its gain as the sky comes nearer; empty if not asked for.
    open: &'a mut [f32],
    gain: &'a mut [f32],
}

struct Caster<'a> {
    occluder: Occluder,
    mesh: &'a Mesh,
    rays: &'a [SkyRay],
    /// Centre of the sky's sphere.
    centre: Vec3,
    nearness: f32,
    /// The nearness to compare with.
    near: f32,
    row: &'a [u32],
    size: usize,
}

impl Caster<'_> {
    /// Adds up in `seen`, and returns the texel's row of B.
    fn texel(&self, origin: Vec3, normal: Vec3, seen: Seen) -> Bounces {
        let nearness = !seen.gain.is_empty();
        let mut bounces = Bounces::new();
        let place = origin - self.centre;
        for ray in self.rays {
            let weight = received(ray, place, normal, self.nearness);
            let nearer = if nearness { received(ray, place, normal, self.near) } else { 0.0 };
            if weight.max(nearer) <= 0.0 {
                continue;
            }
            let towards = ray.direction - self.nearness * place;
            let direction = towards.normalize();
            match self.occluder.first_hit(origin, direction) {
                None => {
                    let cell = ray.cell as usize;
                    seen.direct[cell] += weight;
                    if nearness {
                        seen.gain[cell] += nearer - weight;
                    }
                    seen.open[cell] += open(ray, place, self.nearness);
                }
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
        bounces
    }

    fn row_at(&self, hit: &Impact) -> u32 {
        let corners = self.mesh.triangles[hit.triangle as usize];
        let uv = corners.map(|corner| self.mesh.uvs[corner as usize]);
        let at = uv[0] * hit.barycentric.x + uv[1] * hit.barycentric.y + uv[2] * hit.barycentric.z;
        let texel = |x: f32| ((x * self.size as f32) as usize).min(self.size - 1);
        self.row[texel(1.0 - at.y) * self.size + texel(at.x)]
    }
}

/// Cosine-weighted solid angle over pi of a part of the sky, seen from `place` (from its centre); see
/// the module's formula.
fn received(ray: &SkyRay, place: Vec3, normal: Vec3, nearness: f32) -> f32 {
    let towards = ray.direction - nearness * place;
    let facing = 1.0 - nearness * ray.direction.dot(place);
    let cosine = normal.dot(towards).max(0.0);
    let squared = towards.length_squared();
    ray.solid_angle * facing * cosine / (squared * squared) * std::f32::consts::FRAC_1_PI
}

/// [`received`] by a normal that faces the part of the sky. Not found by dividing by the cosine: of a
/// direction made a unit vector, the cosine may round to zero where the other one did not.
fn open(ray: &SkyRay, place: Vec3, nearness: f32) -> f32 {
    received(ray, place, (ray.direction - nearness * place).normalize(), nearness)
}

#[cfg(test)]
mod tests;
