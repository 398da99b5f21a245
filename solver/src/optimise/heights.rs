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
use crate::model::texture::resample;

/// Least side of a texture of heights.
const LEAST_SIDE: usize = 16;

/// The deviation of the normals, 3 channels per texel of a texture of side `context.size`. `step` hears of
/// every conjugate-gradient step; if it stops the solve with [`SolveError::Interrupted`], the deviation is
/// as fine as it is then.
pub(super) fn heights(
    context: &SolveContext,
    state: &State,
    lighting: Option<&Lighting>,
    step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
) -> Result<Vec<f32>, SolveError> {
    let config = &context.config.height;
    let sides = sides(config, context.size);
    let (mut unknowns, mut of) = (vec![], sides[0]);
    let mut deviation = vec![0.0; 3 * of * of];
    for (round, side) in sides.into_iter().enumerate() {
        let atlas = Atlas::new(&context.capture.mesh, side);
        let samples = context.samples(side);
        let (config, backend, views) = (context.config, context.backend, &context.gbuffers);
        let exponent = config.transport.light_exponent;
        let solve = HeightSolve::new(config, backend, &samples, views, &atlas, state, lighting);
        let solve = match lighting
            .and_then(|lighting| DeviatedHighlights::new(context, lighting, &samples, exponent))
        {
            Some(highlights) => solve.with(highlights),
            None => solve,
        };
        unknowns = match round {
            0 => vec![0.0; solve.unknowns()],
            _ => enlarged(&unknowns, of, side),
        };
        of = side;
        let done = solve.solve(&mut unknowns, step);
        deviation = solve.deviation(&unknowns);
        match done {
            Err(SolveError::Interrupted) => break,
            done => done?,
        }
    }
    Ok(resample(&deviation, of, 3, context.size))
}

/// Conjugate-gradient steps for textures of side `size`.
pub(super) fn steps(config: &HeightConfig, size: usize) -> usize {
    let of_side = |side: &usize| config.reweightings * config.steps_on(*side);
    sides(config, size).iter().map(of_side).sum()
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
