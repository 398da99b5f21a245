//! Relief from heights, coarse to fine: every linearisation on a texture of twice the side of the one before, whose
//! coarse part conjugate gradients would not fill in as many steps.

use capture::gbuffer::Atlas;
use serde::{Deserialize, Serialize};

use super::height_solve::{BLUR, HeightSolve};
use super::lighting::Lighting;
use super::region_terms::RegionTerms;
use crate::backend::Backend;
use crate::config::ReliefConfig;
use crate::model::planes::Planes;
use crate::model::pyramid::Pyramid;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, part, resample};
use crate::run::Run;
use crate::run::error::SolveError;
use crate::scene::Scene;
use crate::transport::LIGHT_EXPONENT;

/// Least side of a texture of heights, texels.
const LEAST_SIDE: usize = 16;

/// Least number of views on a side: the means of fewer over a texel leave too little.
const LEAST_VIEWS: usize = 3;

/// The deviation of the specular normals from the mesh normals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Relief {
    /// Side of the texture, texels.
    pub size: usize,
    /// x, y, z per texel, unit normals being 1 long.
    pub deviation: Vec<f32>,
}

impl Relief {
    /// The mesh as it is.
    pub fn none(size: usize) -> Self {
        Self { size, deviation: vec![0.0; 3 * size * size] }
    }

    /// The deviation of the diffuse normals, which are smoother.
    pub fn blurred(&self) -> Vec<f32> {
        let texels = self.size * self.size;
        let packed = interleave::<4>(&[(&self.deviation, 3), (&vec![0.0; texels], 1)]);
        part::<4, 3>(&Pyramid::new(self.size, BLUR * self.size as f32).apply(&packed), 0)
    }

    /// The same on a texture of another side.
    #[must_use]
    pub fn resized(self, size: usize) -> Self {
        Self { deviation: resample(&self.deviation, self.size, 3, size), size }
    }
}

/// Relief by the pictures under a light. After an interrupt it is as fine as it is then.
pub(super) fn fit_relief(
    run: &mut Run,
    config: &ReliefConfig,
    scene: &Scene,
    lighting: &Lighting,
    terms: &RegionTerms,
) -> Result<Relief, SolveError> {
    if run.is_interrupted() {
        return Ok(Relief::none(scene.size));
    }
    let (backend, steps) = (run.backend, steps(config, scene.size, scene.capture.train.len()));
    run.foreign_steps("relief", steps, |step| {
        let mut unknowns: Option<(usize, Vec<f32>)> = None;
        let mut relief = Relief::none(sides(config, scene.size)[0]);
        let mut share = 1.0;
        for side in sides(config, scene.size) {
            let level = Level::new(backend, config, scene, lighting, terms, side);
            let solve = level.solve(&level.samples);
            let coarsest = unknowns.is_none();
            let mut x = match unknowns.take() {
                None => vec![0.0; solve.unknowns()],
                Some((of, coarser)) => enlarged(&coarser, of, side),
            };
            let mut last = 0.0;
            let done = solve.solve(&mut x, &mut |residual| {
                last = residual;
                step(residual)
            });
            relief = Relief { size: side, deviation: solve.deviation(&x) };
            unknowns = Some((side, x));
            drop(solve);
            let done = done.and_then(|()| {
                if coarsest {
                    share = level.plausible_share(&mut |_| step(last))?;
                }
                Ok(())
            });
            match done {
                Err(SolveError::Interrupted) => break,
                done => done?,
            }
        }
        let mut relief = relief.resized(scene.size);
        relief.deviation.iter_mut().for_each(|channel| *channel *= share);
        Ok(relief)
    })
}

/// The problem on a texture of one side.
struct Level<'a> {
    backend: &'a dyn Backend,
    config: &'a ReliefConfig,
    scene: &'a Scene<'a>,
    lighting: &'a Lighting<'a>,
    terms: &'a RegionTerms,
    atlas: Atlas,
    samples: Samples,
}

impl<'a> Level<'a> {
    fn new(
        backend: &'a dyn Backend,
        config: &'a ReliefConfig,
        scene: &'a Scene,
        lighting: &'a Lighting,
        terms: &'a RegionTerms,
        side: usize,
    ) -> Self {
        let (atlas, samples) = (Atlas::new(&scene.capture.mesh, side), scene.samples(None, side));
        Self { backend, config, scene, lighting, terms, atlas, samples }
    }

    fn solve<'b>(&'b self, samples: &'b Samples) -> HeightSolve<'b> {
        let highlights =
            self.lighting.highlights(self.backend, self.terms, samples, LIGHT_EXPONENT);
        let views = &self.scene.gbuffers;
        let (config, backend) = (self.config, self.backend);
        HeightSolve::new(config, backend, samples, views, &self.atlas, self.lighting, highlights)
    }

    /// The share of the relief that is plausible: 1 where the views of either side show all of the relief that those
    /// of the other find, or more, since flatness finds too little; 0 where they show
    /// [`ReliefConfig::minimum_agreement`] of it, as they do of errors of the model that repeat from view to view. 1
    /// with fewer than three views on a side.
    fn plausible_share(
        &self,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<f32, SolveError> {
        let least = f64::from(self.config.minimum_agreement);
        let sides = self.sides();
        if least == 0.0 || sides.len() < 2 * LEAST_VIEWS {
            return Ok(1.0);
        }
        let (mut common, mut relief) = (0.0, 0.0);
        for side in [false, true] {
            // One side at a time, for their memory.
            let samples = self.one_side(&sides, side);
            let solve = self.solve(&samples);
            let mut unknowns = vec![0.0; solve.unknowns()];
            solve.solve(&mut unknowns, step)?;
            drop(solve);
            drop(samples);
            let other = self.one_side(&sides, !side);
            let [product, square] = self.solve(&other).agreement(&unknowns);
            common += product;
            relief += square;
        }
        let observed = if relief > 0.0 { common / relief } else { 1.0 };
        Ok(((observed - least) / (1.0 - least)).clamp(0.0, 1.0) as f32)
    }

    /// For every training view the side that it is on, along the axis over which they spread most.
    fn sides(&self) -> Vec<bool> {
        let places: Vec<[f32; 3]> =
            self.scene.capture.train.iter().map(|v| v.camera.position().to_array()).collect();
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

    /// The samples, with weight 0 for those of the other side's views.
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
pub(super) fn steps(config: &ReliefConfig, size: usize, views: usize) -> usize {
    let sides = sides(config, size);
    let of_side = |side: &usize| config.reweightings * config.steps_on(*side);
    let tested = config.minimum_agreement > 0.0 && views >= 2 * LEAST_VIEWS;
    sides.iter().map(of_side).sum::<usize>() + if tested { 2 * of_side(&sides[0]) } else { 0 }
}

/// The sides of the textures of heights, one for every linearisation.
fn sides(config: &ReliefConfig, size: usize) -> Vec<usize> {
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
