//! Conjugate gradients on the normal equations of the height solve, on the processor or on a device.

use rayon::prelude::*;

use super::{HeightSolve, TOLERANCE, UNSEEN_DAMPING};
use crate::backend::resident::NormalEquations;
use crate::model::planes::Planes;
use crate::run::error::SolveError;
use crate::unshade::deviation_penalty::deviation_penalty;
use crate::unshade::linear_colour::{
    SLOPES, UNKNOWNS, normal_block, transposed, without_diffuse_share,
};
use crate::unshade::vectors::{add_scaled, dot};

/// Steps that a device takes between two words with the caller.
const SUBMITTED: usize = 5;

impl HeightSolve<'_> {
    pub(super) fn conjugate_gradients(
        &self,
        slopes: &Planes,
        weight: &Planes,
        target: &Planes,
        x: &mut [f32],
        residual: f64,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<(), SolveError> {
        let taps = &self.samples.taps;
        let texels = self.size * self.size;
        let share = self.config.diffuse_share;
        // One pass over the samples: 16 values and the place of each, 76 bytes.
        let normal = |x: &[f32]| {
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
            let mut out = self.carried(&gathered, Some(&penalty));
            let (by_height, by_albedo) = out.split_at_mut(texels);
            add_scaled(by_height, height, UNSEEN_DAMPING);
            add_scaled(by_albedo, albedo, self.config.albedo_damping);
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
        let goal = self.carried(&taps.gather::<UNKNOWNS>(&rows, 0), None);
        drop(rows);
        // Steps that were lost with a device are reported once.
        let heard = match self.on_device(slopes, weight, &goal, x, residual, step) {
            Ok(done) => return done,
            Err(heard) => heard,
        };
        let start = normal(x);
        let mut rest: Vec<f32> = goal.iter().zip(&start).map(|(b, ax)| b - ax).collect();
        let mut direction = rest.clone();
        let enough = TOLERANCE * dot(&goal, &goal);
        let mut energy = dot(&rest, &rest);
        for number in 0..self.steps {
            if number >= heard {
                step(residual)?;
            }
            if energy <= enough {
                continue;
            }
            let image = normal(&direction);
            let length = (energy / dot(&direction, &image)) as f32;
            add_scaled(x, &direction, length);
            add_scaled(&mut rest, &image, -length);
            let next = dot(&rest, &rest);
            let turn = (next / energy) as f32;
            direction.par_iter_mut().zip(&rest).for_each(|(d, r)| *d = r + turn * *d);
            energy = next;
        }
        Ok(())
    }

    /// These steps on a device. If there is none or it fails, the unknowns are as they were, and the error
    /// is the number of steps that `step` has heard of.
    fn on_device(
        &self,
        slopes: &Planes,
        weight: &Planes,
        goal: &[f32],
        x: &mut [f32],
        residual: f64,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<Result<(), SolveError>, usize> {
        let problem = NormalEquations {
            taps: &self.samples.taps,
            slopes,
            weight,
            goal,
            x,
            basis: self.field.basis(),
            blur: &self.blur,
            flatness: self.config.flatness,
            smoothness: self.config.smoothness,
            rest: UNSEEN_DAMPING,
            damping: self.config.albedo_damping,
            diffuse_share: self.config.diffuse_share,
            enough: TOLERANCE,
        };
        let mut descent = self.backend.descent(&problem).ok_or(0usize)?;
        let (mut heard, mut told) = (0, Ok(()));
        while heard < self.steps && told.is_ok() {
            let batch = SUBMITTED.min(self.steps - heard);
            told = (0..batch).try_for_each(|_| step(residual));
            heard += batch;
            descent.steps(batch).map_err(|_| heard)?;
        }
        x.copy_from_slice(&descent.unknowns().map_err(|_| heard)?);
        Ok(told)
    }
}
