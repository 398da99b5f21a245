//! Maps averaged over cells of the surface of stated sides: maps of every size, chart and method compare there, and
//! scores tend to a limit as texels shrink.

use std::collections::HashMap;

use formats::picture::Picture;
use glam::Vec3;

use super::ScoreError;
use super::geometry::Geometry;
use crate::metrics::{MetricError, Region};

/// Sides of the cells, millimetres.
const SIDES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The surface in a region of a texture, cut into cells: the cubes of a grid of one side, in which texels whose normals
/// are nearest to different axes are apart, so that two sheets in one cube (the lips, lid and eye) do not mix.
pub(super) struct Cells {
    /// The same texels under a name that states the side.
    pub region: Region,
    /// The cell of every texel of the region, numbered in the order of the texels.
    of_texel: Vec<u32>,
    /// Surface of every texel of the region, square millimetres.
    area: Vec<f64>,
    count: usize,
}

impl Cells {
    /// Those of every side.
    pub fn of_all_sides(geometry: &Geometry, region: &Region) -> Result<Vec<Self>, ScoreError> {
        let of_side = |side: &f64| Self::new(*side, geometry, region);
        let cells: Result<_, MetricError> = SIDES.iter().map(of_side).collect();
        cells.map_err(ScoreError::of("maps averaged over the surface"))
    }

    fn new(side: f64, geometry: &Geometry, region: &Region) -> Result<Self, MetricError> {
        let mut ids = HashMap::new();
        let of_texel = region.pixels().iter().map(|at| {
            let next = ids.len() as u32;
            let place = (geometry.positions[*at].as_dvec3() * 1e3 / side).floor().as_ivec3();
            let normal = Vec3::from_slice(&geometry.mesh_normal.data[3 * at..][..3]);
            *ids.entry((place, facing(normal))).or_insert(next)
        });
        let of_texel: Vec<u32> = of_texel.collect();
        let area = |at: &usize| f64::from(geometry.texel_area.data[*at]);
        Ok(Self {
            region: region.part(&format!("{}-{side}mm", region.name()), |_| true)?,
            of_texel,
            area: region.pixels().iter().map(area).collect(),
            count: ids.len(),
        })
    }

    /// The map with the mean over its cell in every texel of the region, by area; elsewhere it stays.
    pub fn averaged(&self, map: &Picture) -> Picture {
        let channels = map.channels;
        let mut sums = vec![0.0; self.count * (channels + 1)];
        let texels = || self.region.pixels().iter().zip(&self.of_texel);
        let cell = |cell: u32| cell as usize * (channels + 1);
        for ((at, of), area) in texels().zip(&self.area) {
            let sums = &mut sums[cell(*of)..][..=channels];
            sums[channels] += area;
            for (sum, value) in sums.iter_mut().zip(&map.data[channels * at..][..channels]) {
                *sum += area * f64::from(*value);
            }
        }
        let mut averaged = map.clone();
        for (at, of) in texels() {
            let sums = &sums[cell(*of)..][..=channels];
            let values = &mut averaged.data[channels * at..][..channels];
            if sums[channels] > 0.0 {
                let mean = |sum: &f64| (sum / sums[channels]) as f32;
                values.iter_mut().zip(sums).for_each(|(value, sum)| *value = mean(sum));
            }
        }
        averaged
    }
}

/// The axis to which a direction is nearest, and its sign.
fn facing(direction: Vec3) -> (usize, bool) {
    let axis = direction.abs().max_position();
    (axis, direction[axis] > 0.0)
}
