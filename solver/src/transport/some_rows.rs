//! The shading of the texels that samples read: under many illuminations, each has samples on a part of the face.

use super::Transport;
use super::matrix::Matrix;
use crate::model::planes::Planes;
use crate::model::samples::Samples;

impl Transport {
    /// [`Self::shading_nearer`] of the texels of some rows, see [`Self::rows_of`]; 0 elsewhere.
    pub(crate) fn shading_of_rows(
        &self,
        light: &[f32],
        relative_nearness: f32,
        is_used: &[bool],
    ) -> (Vec<f32>, Option<Vec<f32>>) {
        let shading = |matrix: &Matrix| self.spread(&matrix.product_of_rows(light, is_used));
        let (mut sum, by_nearness) =
            (shading(&self.matrix), self.by_nearness.as_ref().map(shading));
        if let Some(slopes) = &by_nearness {
            let texels = sum.iter_mut().zip(slopes);
            texels.for_each(|(shading, slope)| *shading += relative_nearness * slope);
        }
        (sum, by_nearness)
    }

    /// Whether the blends of texels of these samples, with taps of this chart's size, read each row.
    pub(crate) fn rows_of(&self, samples: &Samples) -> Vec<bool> {
        let ones = Planes::from_fn(samples.len(), |_| [1.0]);
        let weights = samples.taps.gather::<1>(&ones, 0);
        let mut is_used = vec![false; self.matrix.rows.len() / self.cells().max(1)];
        for (row, weight) in self.row.iter().zip(weights) {
            is_used[*row as usize] |= weight > 0.0;
        }
        is_used
    }
}
