//! The error of shading where a cell of the light is partly hidden.
//!
//! A cell is one radiance, but the lamp in it may be smaller than the cell, and then a surface that sees a part v of the
//! cell sees the lamp or does not: its light has the variance v (1 - v) of a coin. Under a sky of many equal cells the
//! sum is small; under a lamp it is the width of a cell at the edge of every shadow.

use glam::Vec3;
use rayon::prelude::*;

use super::{Transport, luminances, received, solid_angle};

impl Transport {
    /// The standard deviation of S_d by lamps smaller than their cells, of the luminance, per texel of the square, in a
    /// light of R, G, B per cell: the root of the sum over cells of (l u cos)^2 v (1 - v), where u is the cell's solid
    /// angle over pi and v the visible part of it.
    pub fn shadow_edges(&self, light: &[f32]) -> Vec<f32> {
        let (rays, light) = (self.sky.rays(1, 0), luminances(light));
        let nearness = self.sky.nearness;
        let edge = |(visible, (place, normal)): (&[f32], (&Vec3, &Vec3))| {
            let cells = visible.iter().zip(&rays).zip(&light);
            let variance = cells.map(|((visible, ray), light)| {
                let part = (visible / solid_angle(ray, *place, nearness)).clamp(0.0, 1.0);
                let shading = light * received(ray, *place, *normal, nearness);
                shading * shading * part * (1.0 - part)
            });
            [variance.sum::<f32>().sqrt()]
        };
        let rows = self.visible_solid_angle.rows.par_chunks(self.cells());
        let places = self.places.par_iter().zip(&self.normals);
        self.spread(&rows.zip(places).map(edge).collect::<Vec<_>>())
    }
}
