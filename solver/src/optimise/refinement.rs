//! The diffuse albedo on the final texture and the full pictures, under the light that explicit transport found.

use glam::Vec3;

use super::confidence::{confidence, decided};
use super::context::SolveContext;
use super::deviated_highlights::DeviatedHighlights;
use super::diffuse::Diffuse;
use super::error::SolveError;
use super::found::Solve;
use super::light_estimate::DiffuseReflectance;
use super::lighting::{Lighting, SHADING_ROWS, bent_shading};
use super::roughness::roughness;
use super::stage::{State, layers};
use super::stage_runner::StageRunner;
use super::surroundings::from_surroundings;
use crate::config::ModelErrorConfig;
use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::CHANNELS;

/// The channel of the shading that a pixel's weight goes by.
const GREEN: usize = 1;

/// The albedo under explicit transport on the final texture; after an interrupt as coarse as it is.
pub(super) fn refinement(
    context: &SolveContext,
    runner: &mut StageRunner,
    solve: &mut Solve,
) -> Result<(), SolveError> {
    if let (Some(lighting), None) = (&mut solve.lighting, &solve.diffuse_reflectance) {
        solve.state.resize(context.size);
        // By the lobes that the light was found with: it has taken up a part of what differs from them.
        let refined = refined(context, runner, &solve.state, lighting)?;
        roughness(context, &solve.state, lighting);
        runner.lap("roughness");
        solve.diffuse_reflectance = Some(refined);
    }
    Ok(())
}

/// `state` has the normals.
fn refined(
    context: &SolveContext,
    runner: &mut StageRunner,
    state: &State,
    lighting: &Lighting,
) -> Result<DiffuseReflectance, SolveError> {
    let (config, fine) = (context.config, context.fine());
    let (t, samples) = (&config.transport, &fine.samples);
    let mut own = lighting.state.clone();
    own.resize(state.size);
    own.deviation.clone_from(&state.deviation);
    let deviations = fine.deviation.textures(&state.deviation);
    let [sharp, blurred] =
        [&deviations.sharp, &deviations.blurred].map(|texture| samples.taps.sample::<3>(texture));
    // The light's own highlights where it was solved for with them, else the networks' and what all views share.
    let explicit = DeviatedHighlights::new(context, lighting, samples, t.light_exponent);
    let target = match explicit.map(|highlights| highlights.at(samples, &sharp)) {
        Some(highlights) => less(&samples.target, |i| highlights.sample(i, 0)),
        None => {
            let specular = layers(samples, &fine.deviation, &own, runner.backend);
            let networks = |i: usize| [specular.get(1, i); CHANNELS];
            less(&lighting.without_specular_floor(samples), networks)
        }
    };
    let sampled = lighting.sampled(samples);
    let shading = Planes::from_fn(samples.len(), |i| {
        let normal = Vec3::from_array(samples.normal.sample(i, 0));
        let bent = (normal + Vec3::from_array(blurred.sample(i, 0))).normalize();
        let [r, g, b] = bent_shading(&sampled.sample(i, 0), normal, bent);
        [r, g, b, 0.0]
    });
    let albedo = samples.taps.sample::<CHANNELS>(&own.diffuse);
    let model = Model { shading: &shading, changes: &sampled, albedo: &albedo, target: &target };
    let (regions, hair_in_skin) = (context.regions_on(state.size), context.hair_in_skin());
    let weight = model.weights(&config.model_error, lighting.doubt, samples);
    let weight = match &regions {
        Some(regions) => Planes::from_fn(samples.len(), |i| {
            let hair = hair_in_skin.contains(&regions[samples.taps.nearest(i)]);
            let prior = if hair { config.hair_in_skin.prior } else { 1.0 };
            [weight.get(0, i) / prior]
        }),
        None => weight,
    };
    // What the stage reads, and no more.
    let rest = Samples {
        weight,
        target,
        taps: samples.taps.clone(),
        pixel: samples.pixel.clone(),
        ..Samples::none(state.size)
    };
    if let Some(regions) = regions {
        let decided = decided(t, &rest, &shading);
        let skin = context.skin_regions();
        from_surroundings(&mut own.diffuse, &regions, &skin, &decided, t.refinement_reach);
    }
    let mut stage = Diffuse::refinement(config, &rest, &shading);
    runner.stage(&mut stage, &mut own)?;
    let albedo = samples.taps.sample::<CHANNELS>(&own.diffuse);
    Ok(DiffuseReflectance {
        confidence: confidence(t, &rest, &samples.target, &shading, &albedo),
        diffuse: own.diffuse,
        scale: lighting.peak / (context.gain * lighting.exposure),
    })
}

/// The pictures less what is specular in them.
fn less(target: &Planes, specular: impl Fn(usize) -> [f32; CHANNELS] + Sync) -> Planes {
    Planes::from_fn::<CHANNELS>(target.len(), |i| {
        let specular = specular(i);
        std::array::from_fn(|c| target.get(c, i) - specular[c])
    })
}

/// Error of the shading over its mean, whatever light reaches a texel. Halves that do not differ were not parted or
/// never moved: that says nothing.
fn shadow_error(errors: &ModelErrorConfig, doubt: Option<f32>) -> f32 {
    let apart = doubt.map(|doubt| errors.doubt * doubt).filter(|apart| *apart > 0.0);
    apart.map_or(errors.shadow, |apart| apart.max(errors.shading))
}

/// What is known of every sample before the refinement.
struct Model<'a> {
    shading: &'a Planes,
    /// See [`Lighting::sampled`].
    changes: &'a Planes,
    albedo: &'a Planes,
    /// The pictures without highlights.
    target: &'a Planes,
}

impl Model<'_> {
    /// The weights of the samples, over how far the layer that explains them is likely to be off: the albedo times
    /// the error of its shading. Shading errs by about as much in shadow as in light, and by the more the further
    /// the lights of both halves of the face are apart ([`super::halves`], `doubt`); where normals matter and
    /// highlights are strong, by more. So the prior is strong where a light explains little, and hair keeps its
    /// strands beside skin that is ten times as bright.
    fn weights(&self, errors: &ModelErrorConfig, doubt: Option<f32>, samples: &Samples) -> Planes {
        if errors.shadow == 0.0 {
            return samples.weight.clone();
        }
        let count = samples.len().max(1) as f32;
        let mean = (0..samples.len()).map(|i| self.shading.get(GREEN, i)).sum::<f32>() / count;
        let shadow = shadow_error(errors, doubt);
        let albedo = |i: usize| self.albedo.get(GREEN, i).max(errors.darkest_albedo);
        let usual = (0..samples.len()).map(albedo).sum::<f32>() / count;
        Planes::from_fn(samples.len(), |i| {
            let normal = Vec3::from_array(samples.normal.sample(i, 0));
            let changes: [f32; SHADING_ROWS] = self.changes.sample(i, 0);
            let change = Vec3::from_slice(&changes[CHANNELS + 3 * GREEN..]);
            let change = (change - normal * normal.dot(change)).length();
            let highlight = samples.target.get(GREEN, i) - self.target.get(GREEN, i);
            let squares = [
                errors.shading * self.shading.get(GREEN, i),
                errors.normal * change,
                errors.highlights * highlight / albedo(i),
                shadow * mean,
            ];
            let error = squares.map(|error| error * error).iter().sum::<f32>().sqrt();
            [samples.weight.get(0, i) * errors.shadow * mean / error * usual / albedo(i)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    /// Weights of two samples, of these shadings and albedos, without highlights.
    fn weights(shading: [f32; 2], albedo: [f32; 2], doubt: Option<f32>) -> [f32; 2] {
        let planes = |values: [f32; 2]| Planes::from_fn(2, |i| [values[i]; CHANNELS]);
        let black = planes([0.0; 2]);
        let samples = Samples {
            normal: Planes::from_fn(2, |_| [0.0, 0.0, 1.0]),
            weight: Planes::from_fn(2, |_| [1.0]),
            target: black.clone(),
            pixel: vec![0; 2],
            ..Samples::none(2)
        };
        let changes = Planes::from_fn(2, |_| [0.0; SHADING_ROWS]);
        let (shading, albedo) = (planes(shading), planes(albedo));
        let model = Model { shading: &shading, changes: &changes, albedo: &albedo, target: &black };
        let weights = model.weights(&Config::default().model_error, doubt, &samples);
        [0, 1].map(|i| weights.get(0, i))
    }

    #[test]
    fn halves_that_agree_to_the_bit_say_nothing_of_the_error() {
        for doubt in [None, Some(0.0)] {
            let [dark, lit] = weights([0.0, 2.0], [0.2; 2], doubt);
            assert!((dark - 1.0).abs() < 1e-6 && (0.9..1.0).contains(&lit), "{dark} {lit}");
        }
        // However little they differ, shading is never better known than where it is bright.
        let [dark, lit] = weights([0.0, 2.0], [0.2; 2], Some(1e-9));
        assert!((dark - 0.3 / 0.05).abs() < 1e-3 && lit < dark, "{dark} {lit}");
    }

    #[test]
    fn lights_that_differ_leave_more_to_the_prior() {
        let of = |doubt: f32| weights([1.0; 2], [0.2; 2], Some(doubt))[0];
        assert!(of(0.02) > 1.5 * of(0.06) && of(0.06) > 1.5 * of(0.2));
    }

    #[test]
    fn a_residual_counts_by_the_albedo_that_it_is_of() {
        let [hair, skin] = weights([1.0; 2], [0.04, 0.4], Some(0.03));
        assert!((hair / skin - 10.0).abs() < 1e-4, "{hair} {skin}");
        let [black, least] = weights([1.0; 2], [0.0, 0.02], Some(0.03));
        assert!((black / least - 1.0).abs() < 1e-6, "{black} {least}");
    }
}
