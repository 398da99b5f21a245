//! Conjugate gradients on the normal equations of the height problem, on the processor or on a device.

use rayon::prelude::*;

use super::{HeightProblem, TOLERANCE, UNSEEN_DAMPING};
use crate::backend::resident::NormalEquations;
use crate::model::planes::Planes;
use crate::run::error::SolveError;
use crate::unshade::deviation_penalty::deviation_penalty;
use crate::unshade::linear_colour::{
    SLOPES, UNKNOWNS, normal_block, transposed, without_diffuse_share,
};
use crate::unshade::vectors::{add_scaled, dot};

/// Steps of one submission to a device.
const SUBMITTED: usize = 5;

impl HeightProblem<'_> {
    pub(super) fn conjugate_gradients(
        &self,
        slopes: &Planes,
        weight: &Planes,
        target: &Planes,
        x: &mut [f32],
        mean_residual: f64,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<(), SolveError> {
        let taps = &self.samples.taps;
        let texels = self.size * self.size;
        let share = self.config.diffuse_share;
        // A, in one pass over the samples: 16 values and the place of each, 76 bytes.
        let a_times = |x: &[f32]| {
            let (height, albedo) = x.split_at(texels);
            let deviation = self.field.deviation(height);
            let (gathered, _) =
                taps.exchange(&self.texture(&deviation, albedo), |block, q, out, _| {
                    normal_block(slopes.rows_of(block), weight.rows_of(block), share, q, out);
                });
            let penalty = deviation_penalty(
                &deviation,
                self.size,
                self.config.flatness,
                self.config.smoothness,
            );
            let mut out = self.transpose_to_unknowns(&gathered, Some(&penalty));
            let (of_height, of_albedo) = out.split_at_mut(texels);
            add_scaled(of_height, height, UNSEEN_DAMPING);
            add_scaled(of_albedo, albedo, self.config.albedo_damping);
            out
        };
        let rows = Planes::from_fn(self.samples.len(), |i| {
            let (slopes, target): ([f32; SLOPES], [f32; 3]) =
                (slopes.sample(i, 0), target.sample(i, 0));
            transposed(
                &slopes,
                without_diffuse_share(target, &slopes, share).map(|z| weight.get(0, i) * z),
            )
        });
        let right_hand_side = self.transpose_to_unknowns(&taps.gather::<UNKNOWNS>(&rows, 0), None);
        drop(rows);
        // After a device failed, its steps are repeated, but not reported again.
        let steps_reported =
            match self.on_device(slopes, weight, &right_hand_side, x, mean_residual, step) {
                Ok(outcome) => return outcome,
                Err(steps_reported) => steps_reported,
            };
        let a_x = a_times(x);
        let mut residual: Vec<f32> =
            right_hand_side.iter().zip(&a_x).map(|(b, a_x)| b - a_x).collect();
        let mut direction = residual.clone();
        let tolerance = TOLERANCE * dot(&right_hand_side, &right_hand_side);
        let mut residual_norm2 = dot(&residual, &residual);
        for number in 0..self.steps {
            if number >= steps_reported {
                step(mean_residual)?;
            }
            if residual_norm2 <= tolerance {
                continue;
            }
            let a_direction = a_times(&direction);
            let alpha = (residual_norm2 / dot(&direction, &a_direction)) as f32;
            add_scaled(x, &direction, alpha);
            add_scaled(&mut residual, &a_direction, -alpha);
            let next = dot(&residual, &residual);
            let beta = (next / residual_norm2) as f32;
            direction.par_iter_mut().zip(&residual).for_each(|(d, r)| *d = r + beta * *d);
            residual_norm2 = next;
        }
        Ok(())
    }

    /// Takes these steps on a device. Without a device, or after its failure, the unknowns are unchanged, and the error
    /// is the number of steps already reported to `step`.
    fn on_device(
        &self,
        slopes: &Planes,
        weight: &Planes,
        right_hand_side: &[f32],
        x: &mut [f32],
        mean_residual: f64,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<Result<(), SolveError>, usize> {
        let problem = NormalEquations {
            taps: &self.samples.taps,
            slopes,
            weight,
            right_hand_side,
            x,
            basis: self.field.basis(),
            blur: &self.blur,
            flatness: self.config.flatness,
            smoothness: self.config.smoothness,
            height_damping: UNSEEN_DAMPING,
            albedo_damping: self.config.albedo_damping,
            diffuse_share: self.config.diffuse_share,
            tolerance: TOLERANCE,
        };
        let mut descent = self.backend.descent(&problem).ok_or(0usize)?;
        let (mut steps_reported, mut outcome) = (0, Ok(()));
        while steps_reported < self.steps && outcome.is_ok() {
            let batch = SUBMITTED.min(self.steps - steps_reported);
            outcome = (0..batch).try_for_each(|_| step(mean_residual));
            steps_reported += batch;
            descent.steps(batch).map_err(|_| steps_reported)?;
        }
        x.copy_from_slice(&descent.unknowns().map_err(|_| steps_reported)?);
        Ok(outcome)
    }
}
