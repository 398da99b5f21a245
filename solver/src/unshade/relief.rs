//! Relief from heights, coarse to fine. Each linearisation is on a texture of twice the side of the previous one, since
//! a step of conjugate gradients propagates information by one texel.

use std::borrow::Cow;

use capture::gbuffer::{Atlas, GBuffer};
use serde::{Deserialize, Serialize};

use super::height_solve::{BLUR, HeightProblem};
use super::light::JointEstimate;
use super::lighting::Lighting;
use crate::backend::Backend;
use crate::config::ReliefConfig;
use crate::model::planes::Planes;
use crate::model::pyramid::Pyramid;
use crate::model::samples::Samples;
use crate::model::texture::{interleave, part, resample};
use crate::run::Run;
use crate::run::error::SolveError;
use crate::scene::{Pictures, Scene};

/// Least side of a texture of heights, texels.
const LEAST_SIDE: usize = 16;
/// Largest side of the coarsest texture of heights, texels: about 2 mm a texel.
const COARSEST_SIDE: usize = 128;

/// Least number of views on a side: with fewer, little is left after the mean over a texel's views is subtracted.
const LEAST_VIEWS: usize = 3;

/// The deviation of the specular normals from the mesh normals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Relief {
    /// Side of the texture, texels.
    pub size: usize,
    /// The difference to the unit mesh normal, x, y, z per texel.
    pub deviation: Vec<f32>,
    /// The same of the diffuse normals, if it is known; else they follow from `deviation`.
    pub diffuse: Option<Vec<f32>>,
}

impl Relief {
    /// A deviation of the specular normals, from which the diffuse normals follow.
    pub fn new(size: usize, deviation: Vec<f32>) -> Self {
        Self { size, deviation, diffuse: None }
    }

    /// No deviation.
    pub fn none(size: usize) -> Self {
        Self::new(size, vec![0.0; 3 * size * size])
    }

    /// The deviation of the diffuse normals, which are smoother. [`Pyramid`] approximates the Gaussian of the solve's
    /// [`Blur`](crate::model::blur::Blur) to about 2 %, and is faster on the larger textures of the maps.
    pub fn blurred(&self) -> Vec<f32> {
        if let Some(diffuse) = &self.diffuse {
            return diffuse.clone();
        }
        let texels = self.size * self.size;
        let packed = interleave::<4>(&[(&self.deviation, 3), (&vec![0.0; texels], 1)]);
        part::<4, 3>(&Pyramid::new(self.size, BLUR * self.size as f32).apply(&packed), 0)
    }

    /// Resamples the relief to a texture of another side.
    #[must_use]
    pub fn resized(self, size: usize) -> Self {
        let resized = |texture: &Vec<f32>| resample(texture, self.size, 3, size);
        Self {
            deviation: resized(&self.deviation),
            diffuse: self.diffuse.as_ref().map(resized),
            size,
        }
    }
}

/// Fits the relief to the pictures under a light. An interrupt ends it at the current texture size.
pub(super) fn fit_relief(
    run: &mut Run,
    name: &str,
    config: &ReliefConfig,
    scene: &Scene,
    lighting: &Lighting,
    joint: &JointEstimate,
) -> Result<Relief, SolveError> {
    let (backend, steps) = (run.backend, steps(config, scene.size, scene.capture.train.len()));
    run.foreign_steps(name, steps, |step| {
        let mut unknowns: Option<(usize, Vec<f32>)> = None;
        let levels = levels(config, scene.size);
        let mut relief = Relief::none(levels[0].size);
        let mut share = 1.0;
        for LevelSize { size, halvings } in levels {
            let level =
                Level::new(backend, config, scene.halved(halvings), scene, lighting, joint, size);
            let problem = level.height_problem(&level.samples);
            let coarsest = unknowns.is_none();
            let mut x = match unknowns.take() {
                None => vec![0.0; problem.unknowns()],
                Some((of, coarser)) => enlarged(&coarser, of, size),
            };
            let mut last_residual = 0.0;
            let outcome = problem.minimise(&mut x, &mut |residual| {
                last_residual = residual;
                step(residual)
            });
            relief = Relief::new(size, problem.deviation(&x));
            unknowns = Some((size, x));
            drop(problem);
            let outcome = outcome.and_then(|()| {
                if coarsest {
                    share = level.plausible_share(&mut |_| step(last_residual))?;
                }
                Ok(())
            });
            match outcome {
                Err(SolveError::Interrupted) => break,
                outcome => outcome?,
            }
        }
        let mut relief = relief.resized(scene.size);
        relief.deviation.iter_mut().for_each(|channel| *channel *= share);
        Ok(relief)
    })
}

/// The height problem on a texture of one size.
struct Level<'a> {
    backend: &'a dyn Backend,
    config: &'a ReliefConfig,
    scene: &'a Scene<'a>,
    gbuffers: Cow<'a, [GBuffer]>,
    lighting: &'a Lighting<'a>,
    joint: &'a JointEstimate,
    atlas: Atlas,
    samples: Samples,
}

impl<'a> Level<'a> {
    fn new(
        backend: &'a dyn Backend,
        config: &'a ReliefConfig,
        pictures: Pictures<'a>,
        scene: &'a Scene,
        lighting: &'a Lighting,
        joint: &'a JointEstimate,
        size: usize,
    ) -> Self {
        let Pictures { views, gbuffers } = pictures;
        let atlas = Atlas::new(&scene.capture.mesh, size);
        let samples = scene.space.training(&views, &gbuffers, None, size);
        Self { backend, config, scene, gbuffers, lighting, joint, atlas, samples }
    }

    fn height_problem<'b>(&'b self, samples: &'b Samples) -> HeightProblem<'b> {
        let Self { backend, config, ref gbuffers, lighting, joint, ref atlas, .. } = *self;
        HeightProblem::new(config, backend, samples, gbuffers, atlas, lighting, joint)
    }

    /// The plausible share of the relief. The views of each side yield a relief, which is compared with the pictures
    /// of the other side. The share is 1 if the slope of the pictures on that relief is 1 or more (the flatness penalty
    /// underestimates relief), and 0 if it is [`ReliefConfig::minimum_agreement`], as for model errors that repeat from
    /// view to view. It is 1 with fewer than three views on a side.
    fn plausible_share(
        &self,
        step: &mut dyn FnMut(f64) -> Result<(), SolveError>,
    ) -> Result<f32, SolveError> {
        let least = f64::from(self.config.minimum_agreement);
        let side_of_view = self.split_views();
        if least == 0.0 || side_of_view.len() < 2 * LEAST_VIEWS {
            return Ok(1.0);
        }
        let (mut product_sum, mut square_sum) = (0.0, 0.0);
        for side in [false, true] {
            // Both sides do not fit into memory.
            let samples = self.samples_of_side(&side_of_view, side);
            let problem = self.height_problem(&samples);
            let mut unknowns = vec![0.0; problem.unknowns()];
            problem.minimise(&mut unknowns, step)?;
            drop(problem);
            drop(samples);
            let other = self.samples_of_side(&side_of_view, !side);
            let [product, square] = self.height_problem(&other).agreement(&unknowns);
            product_sum += product;
            square_sum += square;
        }
        let slope = if square_sum > 0.0 { product_sum / square_sum } else { 1.0 };
        Ok(((slope - least) / (1.0 - least)).clamp(0.0, 1.0) as f32)
    }

    /// Splits the training views into two sides along the axis of the largest spread of cameras; `true` is the second.
    fn split_views(&self) -> Vec<bool> {
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
        let mut side_of_view = vec![false; places.len()];
        order[places.len() / 2..].iter().for_each(|view| side_of_view[*view] = true);
        side_of_view
    }

    /// The samples, with weight 0 in the views of the other side.
    fn samples_of_side(&self, side_of_view: &[bool], side: bool) -> Samples {
        let samples = &self.samples;
        let weight = Planes::from_fn(samples.len(), |i| {
            let counts = side_of_view[samples.view_index[i] as usize] == side;
            [if counts { samples.weight.get(0, i) } else { 0.0 }]
        });
        Samples { weight, ..samples.clone() }
    }
}

/// The largest number of conjugate-gradient steps for textures of side `size` and this number of training views.
pub(super) fn steps(config: &ReliefConfig, size: usize, views: usize) -> usize {
    let of_level = config.reweightings * config.steps;
    let has_test = config.minimum_agreement > 0.0 && views >= 2 * LEAST_VIEWS;
    of_level * (levels(config, size).len() + if has_test { 2 } else { 0 })
}

/// A level of the coarse-to-fine fit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LevelSize {
    /// Side of the texture of heights, texels.
    size: usize,
    /// How often the pictures are halved.
    halvings: usize,
}

/// The levels, one for every linearisation, from coarse to fine. The coarsest texture has at most [`COARSEST_SIDE`]
/// texels a side, so that larger pictures refine what smaller ones show. The pictures are halved with the textures,
/// but not on the coarsest of the [`ReliefConfig::linearisations`].
fn levels(config: &ReliefConfig, size: usize) -> Vec<LevelSize> {
    let finest = (size as f32 * config.texture_scale) as usize;
    let more = (0..).find(|more| finest >> (config.linearisations - 1 + more) <= COARSEST_SIDE);
    let more = more.unwrap_or(0);
    let level = |halved: usize| LevelSize {
        size: (finest >> halved).max(LEAST_SIDE),
        halvings: halved.min(more),
    };
    (0..config.linearisations + more).rev().map(level).collect()
}

/// Resamples the unknowns, heights in texels and changes of the albedo, from side `of` to a larger side.
fn enlarged(unknowns: &[f32], of: usize, size: usize) -> Vec<f32> {
    let (height, albedo) = unknowns.split_at(of * of);
    let mut enlarged = resample(height, of, 1, size);
    let ratio = size as f32 / of as f32;
    enlarged.iter_mut().for_each(|height| *height *= ratio);
    enlarged.append(&mut resample(albedo, of, 3, size));
    enlarged
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::model::height::HeightField;
    use crate::testing;

    #[test]
    fn larger_textures_add_finer_levels_with_finer_pictures() {
        let config = crate::config::UnshadeConfig::default().relief;
        let of = |size: usize| -> Vec<(usize, usize)> {
            levels(&config, size).iter().map(|level| (level.size, level.halvings)).collect()
        };
        assert_eq!(of(256), [(64, 0), (128, 0)]);
        assert_eq!(of(512), [(128, 0), (256, 0)]);
        assert_eq!(of(2048), [(128, 2), (256, 2), (512, 1), (1024, 0)]);
    }

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
