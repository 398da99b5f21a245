//! Shadowed diffuse light transport of a known mesh: the shading of a texel by each cell of the sky, with the mesh's
//! shadows and bounce light.
//!
//! S_d(t, c) = sum over cells j of T(t, j) l(j, c), with T = T0 + a B T0 + a^2 B B T0. T0 is the
//! cosine-weighted visible solid angle of a cell over pi, by ray casts; B is the same of the texels that the blocked
//! rays hit, and a is one albedo for all bounces (precomputed radiance transfer, Sloan et al. 2002). A white texel
//! under an unoccluded light of radiance 1 from every direction has S_d = 1.
//!
//! The cells lie on a sphere around the head's centre. Real lamps are a metre away, not infinitely
//! far: a cell of nearness k (inverse radius) in direction w from the centre lies along w - k x from a
//! point x, and brings it the cosine-weighted solid angle
//! dw (1 - k w.x) n.(w - k x) / |w - k x|^4.

mod channels;
mod highlights;
mod light_colour;
mod light_rotation;
mod matrix;
mod reflection;
mod shadow_edge;
pub mod skin;
mod sky;
mod some_rows;
mod specular_term;

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::rays::{Impact, Occluder};
use formats::{cancel, fill};
use glam::Vec3;
use rayon::prelude::*;

use crate::config::TransportConfig;
pub use channels::CHANNELS;
pub(crate) use channels::{GREEN, luminance};
pub use highlights::{HIGHLIGHT_ROWS, SkinHighlights};
pub(crate) use light_colour::light_colour;
pub use light_rotation::LightRotation;
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
/// Exponent of the cosine lobe that filters the light for highlights: 10 degrees, about the width of a cell, since
/// cells do not resolve more.
pub const LIGHT_EXPONENT: i32 = 64;

/// The transport of the texels of a chart.
#[derive(Clone, Debug)]
pub struct Transport {
    size: usize,
    /// One row per texel inside the chart, one column per cell.
    matrix: Matrix,
    /// Derivative of `matrix` with respect to relative nearness: its change between the sky's nearness and one
    /// [unit](Self::nearness_unit) more.
    by_nearness: Option<Matrix>,
    /// Visible solid angle over pi.
    visible_solid_angle: Matrix,
    /// The unit of relative nearness, per metre.
    nearness_unit: f32,
    /// The sky's centre: that of the mesh's bounding box.
    centre: Vec3,
    /// The position of every row from the sky's centre, metres.
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    sky: Sky,
    /// The row of every texel of the square, or that of the nearest texel inside.
    row: Vec<u32>,
}

impl Transport {
    /// Casts all rays for a sky of fixed nearness. Memory is texels inside the chart x cells x 8 bytes, three times
    /// that while bounces are added.
    pub fn new(mesh: &Mesh, sky: &Sky, config: &TransportConfig, seed: u64) -> Self {
        Self::cast(mesh, sky, config, seed, false)
    }

    /// Casts all rays, and computes the derivative of the shading with respect to nearness as well: half as much
    /// memory again.
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
        let nearness_unit = 2.0 / (NEAR_RADIUS * longest);
        let rays = sky.rays(config.rays_per_cell_side, seed);
        let caster = Caster {
            occluder: Occluder::new(mesh),
            mesh,
            rays: &rays,
            centre: 0.5 * (low + high),
            nearness: sky.nearness,
            nearer: sky.nearness + nearness_unit,
            row: &row,
            size,
        };
        let lift = RAY_OFFSET * longest;
        let cells = sky.len();
        let entries = texels.len() * cells;
        let mut direct = vec![0.0; entries];
        let mut visible = vec![0.0; entries];
        let mut by_nearness = vec![0.0; if has_nearness { entries } else { 0 }];
        let parts = [&mut direct, &mut visible, &mut by_nearness];
        let mut parts = parts.map(|rows| rows.chunks_mut(cells));
        let rows_of_texels: Vec<RowsOfTexel> = (0..texels.len())
            .map(|_| parts.each_mut().map(|rows| rows.next().unwrap_or_default()))
            .map(|[direct, visible, by_nearness]| RowsOfTexel { direct, visible, by_nearness })
            .collect();
        let cast = |(texel, rows): (&usize, RowsOfTexel)| {
            cancel::check();
            let normal = atlas.normals[*texel];
            caster.texel(atlas.positions[*texel] + lift * normal, normal, rows)
        };
        let bounces: Vec<Bounces> = texels.par_iter().zip(rows_of_texels).map(cast).collect();
        let matrix = Matrix::with_bounces(direct, &bounces, cells, config);
        let visible_solid_angle = Matrix { rows: visible, cells };
        let with_bounces = |rows| Matrix::with_bounces(rows, &bounces, cells, config);
        let by_nearness = has_nearness.then(|| with_bounces(by_nearness));
        let places = texels.iter().map(|texel| atlas.positions[*texel] - caster.centre).collect();
        let normals = texels.iter().map(|texel| atlas.normals[*texel]).collect();
        let sky = sky.clone();
        Self {
            size,
            matrix,
            by_nearness,
            visible_solid_angle,
            nearness_unit,
            centre: caster.centre,
            places,
            normals,
            sky,
            row,
        }
    }

    /// Side of the chart's texture.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Cells of the sky.
    pub fn cells(&self) -> usize {
        self.matrix.cells
    }

    /// The share of every cell of radiance 1 in the shading of a texel of the square.
    pub fn cells_of(&self, texel: usize) -> &[f32] {
        &self.matrix.rows[self.row[texel] as usize * self.cells()..][..self.cells()]
    }

    /// Whether the chart covers no texel.
    pub fn is_empty(&self) -> bool {
        self.matrix.rows.is_empty()
    }

    /// The inverse radius of the sky for which the rays were cast, per metre.
    pub fn nearness_per_metre(&self) -> f32 {
        self.sky.nearness
    }

    /// Whether it has the derivative of the shading with respect to nearness.
    pub fn has_nearness(&self) -> bool {
        self.by_nearness.is_some()
    }

    /// The sky's centre.
    pub fn centre(&self) -> Vec3 {
        self.centre
    }

    /// The unit of relative nearness, per metre: the nearness of a sphere around the head of about one metre.
    pub fn nearness_unit(&self) -> f32 {
        self.nearness_unit
    }

    /// The largest relative nearness of a sky at infinity.
    pub fn max_relative_nearness(&self) -> f32 {
        NEAR_RADIUS / LEAST_RADIUS
    }

    /// The diffuse shading, R, G, B per texel of the square, in a light of R, G, B per cell. A texel outside the chart
    /// has the shading of the nearest texel inside.
    pub fn shading(&self, light: &[f32]) -> Vec<f32> {
        self.spread(&self.matrix.product(light))
    }

    /// The adjoint of [`Self::shading`]: the gradient with respect to the light.
    pub fn adjoint(&self, by_shading: &[f32]) -> Vec<f32> {
        self.matrix.adjoint(&self.collected(by_shading))
    }

    /// The shading from a sky that is nearer by `relative_nearness` x [`Self::nearness_unit`], to first order; and its
    /// derivative with respect to the relative nearness. A transport without that derivative ignores the nearness.
    pub fn shading_nearer(
        &self,
        light: &[f32],
        relative_nearness: f32,
    ) -> (Vec<f32>, Option<Vec<f32>>) {
        let (mut shading, by_nearness) = (self.shading(light), self.shading_by_nearness(light));
        if let Some(slopes) = &by_nearness {
            let texels = shading.iter_mut().zip(slopes);
            texels.for_each(|(shading, slope)| *shading += relative_nearness * slope);
        }
        (shading, by_nearness)
    }

    /// The adjoint of [`Self::shading_nearer`]: the gradient with respect to the light.
    pub fn adjoint_nearer(&self, by_shading: &[f32], relative_nearness: f32) -> Vec<f32> {
        let mut by_light = self.adjoint(by_shading);
        if let Some(slopes) = self.adjoint_by_nearness(by_shading) {
            let cells = by_light.iter_mut().zip(slopes);
            cells.for_each(|(gradient, slope)| *gradient += relative_nearness * slope);
        }
        by_light
    }

    /// The derivative of the shading with respect to the relative nearness.
    fn shading_by_nearness(&self, light: &[f32]) -> Option<Vec<f32>> {
        self.by_nearness.as_ref().map(|matrix| self.spread(&matrix.product(light)))
    }

    /// The adjoint of [`Self::shading_by_nearness`].
    fn adjoint_by_nearness(&self, by_shading: &[f32]) -> Option<Vec<f32>> {
        self.by_nearness.as_ref().map(|matrix| matrix.adjoint(&self.collected(by_shading)))
    }

    /// The derivative of S_d with respect to the normal (x, y, z of R, then of G and B; 9 values per texel of the
    /// square): the vector sum of the visible light. Bounce light, and light that rises over the texel's horizon, are
    /// left out.
    pub fn shading_by_normal(&self, light: &[f32]) -> Vec<f32> {
        let centres = self.sky.centres();
        let (light, _) = light.as_chunks::<CHANNELS>();
        let row = |(row, place): (&[f32], &Vec3)| {
            let mut sum = [Vec3::ZERO; CHANNELS];
            for ((visible, centre), light) in row.iter().zip(&centres).zip(light) {
                if *visible > 0.0 {
                    let towards = (*centre - self.sky.nearness * *place).normalize();
                    (0..CHANNELS).for_each(|c| sum[c] += visible * light[c] * towards);
                }
            }
            let mut flat = [0.0; 3 * CHANNELS];
            (0..CHANNELS).for_each(|c| flat[3 * c..3 * c + 3].copy_from_slice(&sum[c].to_array()));
            flat
        };
        let rows = self.visible_solid_angle.rows.par_chunks(self.cells());
        let rows: Vec<_> = rows.zip(&self.places).map(row).collect();
        self.spread(&rows)
    }

    /// The largest unoccluded S_d of texels in front (normal towards +Z), as Rec.709 luminance. By convention it sets
    /// the exposure of pictures. 0 without such texels.
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
    light.as_chunks::<CHANNELS>().0.iter().map(|rgb| luminance(rgb)).collect()
}

/// The rows of a texel in the matrices of direct light, one value per cell.
struct RowsOfTexel<'a> {
    /// T0.
    direct: &'a mut [f32],
    /// Visible solid angle over pi.
    visible: &'a mut [f32],
    /// The change of T0 by a unit of nearness; empty if it is not needed.
    by_nearness: &'a mut [f32],
}

struct Caster<'a> {
    occluder: Occluder,
    mesh: &'a Mesh,
    rays: &'a [SkyRay],
    /// Centre of the sky's sphere.
    centre: Vec3,
    nearness: f32,
    /// The nearness at the other end of the finite difference.
    nearer: f32,
    row: &'a [u32],
    size: usize,
}

impl Caster<'_> {
    /// Adds all rays of a texel to its rows, and returns its row of B.
    fn texel(&self, origin: Vec3, normal: Vec3, rows: RowsOfTexel) -> Bounces {
        let has_nearness = !rows.by_nearness.is_empty();
        let mut bounces = Bounces::new();
        let place = origin - self.centre;
        for ray in self.rays {
            let weight = received(ray, place, normal, self.nearness);
            let nearer = if has_nearness { received(ray, place, normal, self.nearer) } else { 0.0 };
            if weight.max(nearer) <= 0.0 {
                continue;
            }
            let towards = ray.direction - self.nearness * place;
            let direction = towards.normalize();
            match self.occluder.first_hit(origin, direction) {
                None => {
                    let cell = ray.cell as usize;
                    rows.direct[cell] += weight;
                    if has_nearness {
                        rows.by_nearness[cell] += nearer - weight;
                    }
                    rows.visible[cell] += solid_angle(ray, place, self.nearness);
                }
                Some(hit) if hit.front => bounces.push((self.row_at(&hit), weight)),
                // The back of a surface is inside the head, and dark.
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

/// The cosine-weighted solid angle over pi of a part of the sky, from a `place` relative to its centre, by the
/// module's formula.
fn received(ray: &SkyRay, place: Vec3, normal: Vec3, nearness: f32) -> f32 {
    let towards = ray.direction - nearness * place;
    let facing = 1.0 - nearness * ray.direction.dot(place);
    let cosine = normal.dot(towards).max(0.0);
    let squared = towards.length_squared();
    ray.solid_angle * facing * cosine / (squared * squared) * std::f32::consts::FRAC_1_PI
}

/// The solid angle over pi of a part of the sky: [`received`] by a normal that faces it. A division by the cosine
/// would fail at grazing angles, where one of two equal cosines may round to zero.
fn solid_angle(ray: &SkyRay, place: Vec3, nearness: f32) -> f32 {
    received(ray, place, (ray.direction - nearness * place).normalize(), nearness)
}

#[cfg(test)]
mod tests;
