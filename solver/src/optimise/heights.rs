//! Heights, coarse to fine: every linearisation on a texture of twice the side of the one before, which
//! conjugate gradients would not fill with what is coarse in as many steps.

use capture::gbuffer::Atlas;

use super::context::SolveContext;
use super::deviated_highlights::DeviatedHighlights;
use super::error::SolveError;
use super::height_solve::HeightSolve;
use super::lighting::Lighting;
use super::stage::State;
use crate::config::HeightConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::model::texture::resample;

/// Least side of a texture of heights.
const LEAST_SIDE: usize = 16;

/// Views on a side, below which their means over a texel leave too little.
const LEAST_VIEWS: usize = 3;

/// The deviation of the normals, 3 channels per texel of a texture of side `context.size`. `step` hears of
/// every conjugate-gradient step; if it stops the solve with [`SolveError::Interrupted`], the deviation is
/// as fine as it is then.
pub(super) fn heights(
    context: &SolveContext,
    state: &State,
    lighting: Option<&Lighting>,
    step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
) -> Result<Vec<f32>, SolveError> {
    let sides = sides(&context.config.height, context.size);
    let first = sides[0];
    let mut unknowns = vec![];
    let mut deviation = vec![0.0; 3 * first * first];
    let (mut of, mut believed) = (first, 1.0);
    for side in sides {
        let level = Level::new(context, state, lighting, side);
        let solve = level.solve(&level.samples);
        let coarsest = unknowns.is_empty();
        unknowns = match coarsest {
            true => vec![0.0; solve.unknowns()],
            false => enlarged(&unknowns, of, side),
        };
        of = side;
        let mut last = 0.0;
        let done = solve.solve(&mut unknowns, &mut |residual| {
            last = residual;
            step(residual)
        });
        deviation = solve.deviation(&unknowns);
        drop(solve);
        let done = done.and_then(|()| {
            if coarsest {
                believed = level.believed(&mut |_| step(last))?;
            }
            Ok(())
        });
        match done {
            Err(SolveError::Interrupted) => break,
            done => done?,
        }
    }
    let mut deviation = resample(&deviation, of, 3, context.size);
    deviation.iter_mut().for_each(|channel| *channel *= believed);
    Ok(deviation)
}

/// The problem on a texture of one side.
struct Level<'a> {
    context: &'a SolveContext<'a>,
    state: &'a State,
    lighting: Option<&'a Lighting>,
    atlas: Atlas,
    samples: Samples,
}

impl<'a> Level<'a> {
    fn new(
        context: &'a SolveContext,
        state: &'a State,
        lighting: Option<&'a Lighting>,
        side: usize,
    ) -> Self {
        let (atlas, samples) = (Atlas::new(&context.capture.mesh, side), context.samples(side));
        Self { context, state, lighting, atlas, samples }
    }

    fn solve(&'a self, samples: &'a Samples) -> HeightSolve<'a> {
        let Self { context, state, lighting, atlas, .. } = self;
        let (config, backend, views) = (context.config, context.backend, &context.gbuffers);
        let exponent = config.transport.light_exponent;
        let solve = HeightSolve::new(config, backend, samples, views, atlas, state, *lighting);
        match lighting
            .and_then(|lighting| DeviatedHighlights::new(context, lighting, samples, exponent))
        {
            Some(highlights) => solve.with(highlights),
            None => solve,
        }
    }

    /// The share of the relief to believe: 1 where the views of either side show all that those of the other
    /// find, or more, since flatness finds too little; 0 where they show [`HeightConfig::doubt`] of it, as they
    /// do of errors of the model that repeat from view to view. 1 without highlights by the light, or with
    /// fewer than three views on a side.
    fn believed(
        &self,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<f32, SolveError> {
        let doubt = f64::from(self.context.config.height.doubt);
        let sides = self.sides();
        if doubt == 0.0 || sides.len() < 2 * LEAST_VIEWS {
            return Ok(1.0);
        }
        let (mut common, mut relief) = (0.0, 0.0);
        for side in [false, true] {
            // One side at a time, for their memory.
            let samples = self.one_side(&sides, side);
            let solve = self.solve(&samples);
            if !solve.has_highlights() {
                return Ok(1.0);
            }
            let mut unknowns = vec![0.0; solve.unknowns()];
            solve.solve(&mut unknowns, step)?;
            drop(solve);
            drop(samples);
            let other = self.one_side(&sides, !side);
            if let Some([product, square]) = self.solve(&other).shown(&unknowns) {
                common += product;
                relief += square;
            }
        }
        let shown = if relief > 0.0 { common / relief } else { 1.0 };
        Ok(((shown - doubt) / (1.0 - doubt)).clamp(0.0, 1.0) as f32)
    }

    /// For every training view the side that it is on, along the axis over which they spread most.
    fn sides(&self) -> Vec<bool> {
        let places: Vec<[f32; 3]> =
            self.context.capture.train.iter().map(|v| v.camera.position().to_array()).collect();
        let spread = |axis: usize| {
            let along = places.iter().map(|place| place[axis]);
            along.clone().fold(f32::MIN, f32::max) - along.fold(f32::MAX, f32::min)
        };
        let widest = |axis: usize| (0..3).all(|other| spread(axis) >= spread(other));
        let axis = (0..3).find(|axis| widest(*axis)).unwrap_or(0);
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by(|a, b| places[*a][axis].total_cmp(&places[*b][axis]));
        let mut sides = vec![false; places.len()];
        order[places.len() / 2..].iter().for_each(|view| sides[*view] = true);
        sides
    }

    /// The samples, of which those of one side's views alone count.
    fn one_side(&self, sides: &[bool], side: bool) -> Samples {
        let samples = &self.samples;
        let weight = Planes::from_fn(samples.len(), |i| {
            let counts = sides[samples.view_index[i] as usize] == side;
            [if counts { samples.weight.get(0, i) } else { 0.0 }]
        });
        Samples { weight, ..samples.clone() }
    }
}

/// Conjugate-gradient steps for textures of side `size` and so many training views.
pub(super) fn steps(config: &HeightConfig, size: usize, views: usize) -> usize {
    let sides = sides(config, size);
    let of_side = |side: &usize| config.reweightings * config.steps_on(*side);
    let asked = config.doubt > 0.0 && config.highlights && views >= 2 * LEAST_VIEWS;
    sides.iter().map(of_side).sum::<usize>() + if asked { 2 * of_side(&sides[0]) } else { 0 }
}

/// The sides of the textures of heights, one for every linearisation.
fn sides(config: &HeightConfig, size: usize) -> Vec<usize> {
    let finest = (size as f32 * config.texture_scale) as usize;
    (0..config.linearisations).rev().map(|halved| (finest >> halved).max(LEAST_SIDE)).collect()
}

/// Heights, which count texels, and changes of the albedo on a texture of another side.
fn enlarged(unknowns: &[f32], of: usize, side: usize) -> Vec<f32> {
    let (height, albedo) = unknowns.split_at(of * of);
    let mut enlarged = resample(height, of, 1, side);
    let more = side as f32 / of as f32;
    enlarged.iter_mut().for_each(|height| *height *= more);
    enlarged.append(&mut resample(albedo, of, 3, side));
    enlarged
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::model::height::HeightField;
    use crate::testing;

    #[test]
    fn heights_deviate_normals_alike_on_a_texture_of_another_side() {
        let mesh = testing::dome(24);
        let deviation = |side: usize, unknowns: &[f32]| {
            HeightField::new(&Atlas::new(&mesh, side), 6.0).deviation(&unknowns[..side * side])
        };
        let wave = |at: usize| {
            let (x, y) = ((at % 32) as f32, (at / 32) as f32);
            (0.3 * x).sin() * (0.2 * y).cos()
        };
        let coarse: Vec<f32> = (0..4 * 32 * 32).map(wave).collect();
        let fine = enlarged(&coarse, 32, 64);
        assert_eq!(fine.len(), 4 * 64 * 64);
        let (coarse, fine) = (resample(&deviation(32, &coarse), 32, 3, 64), deviation(64, &fine));
        let inside = Atlas::new(&mesh, 64).inside;
        let (mut error, mut energy) = (0.0, 0.0);
        for at in (0..64 * 64).filter(|at| inside[*at]) {
            let [a, b] = [&coarse, &fine].map(|deviation| Vec3::from_slice(&deviation[3 * at..]));
            error += a.distance_squared(b);
            energy += a.length_squared();
        }
        assert!(energy > 1.0 && error < 0.05 * energy, "{error} of {energy}");
    }
}
