//! Tests of light, distance, albedo and roughness on rendered highlights.

use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::LazyLock;

use super::*;
use crate::config::RoughnessConfig;
use crate::fit::Fit;
use crate::model::planes::Planes;
use crate::transport::skin::schlick;
use crate::transport::{CHANNELS, SpecularTerm, contrast};
use crate::unshade::explicit::{ExplicitModel, exp};
use crate::unshade::explicit_fits::LightFit;
use crate::unshade::light::JointEstimate;
use crate::unshade::relief::Relief;
use crate::unshade::two_fold::{TwoFoldLightFit, mean};

/// Specular reflectance of skin at normal incidence.
const SPECULAR: f32 = 0.04;

#[test]
fn gradients_reach_light_distance_and_albedo() {
    const SIDE: usize = 16;
    let mut config = UnshadeConfig::default();
    config.transport.texture_size = SIDE;
    config.transport.rows = 4;
    config.joint.prior = 20.0;
    let mut samples = samples(SIDE);
    // No residual is near the kink of |x|.
    samples.target = Planes::from_fn(samples.len(), |_| [0.0; 3]);
    let mesh = testing::dome(12);
    let transport = Transport::with_nearness(&mesh, &Sky::lat_long(4), &config.transport, 0);
    let cells = CHANNELS * transport.cells();
    let light: Vec<f32> = (0..cells).map(|i| (i as f32 * 0.37).sin()).collect();
    let albedo: Vec<f32> =
        (0..3 * SIDE * SIDE).map(|i| 0.1 + 0.8 * (i as f32 * 12.9898).sin().abs()).collect();
    let terms = SpecularTerm::usual(0.2).channels().repeat(SIDE * SIDE);
    let nearness = 0.4 * transport.nearness_unit();
    let (one, radiance) = (Illuminations::one(), exp(&light));
    let model =
        ExplicitModel::new(&config, &transport, &one, &samples, &terms, &radiance, nearness);
    let model = model.with_grey_prior(true);
    let found = model.gradient(&light, 0.4, &albedo);
    let check = |what: &str, found: &[f32], step: f32, loss: &dyn Fn(usize, f32) -> f64| {
        let largest = found.iter().fold(0.0f32, |m, g| m.max(g.abs()));
        for at in (0..found.len()).filter(|at| found[*at].abs() > 0.5 * largest).step_by(5) {
            let expected = (loss(at, step) - loss(at, -step)) / (2.0 * f64::from(step));
            let error = (f64::from(found[at]) - expected).abs();
            assert!(error < 0.015 * f64::from(largest), "{what} {at}: {} {expected}", found[at]);
        }
    };
    let moved = |values: &[f32], at: usize, step: f32| {
        let mut moved = values.to_vec();
        moved[at] += step;
        moved
    };
    check("light", &found.by_log_light, 3e-3, &|at, step| {
        model.gradient(&moved(&light, at, step), 0.4, &albedo).loss
    });
    check("albedo", &found.by_albedo, 2e-3, &|at, step| {
        model.gradient(&light, 0.4, &moved(&albedo, at, step)).loss
    });
    check("nearness", &[found.by_relative_nearness], 1e-2, &|_, step| {
        model.gradient(&light, 0.4 + step, &albedo).loss
    });
}

/// Two GGX lobes, rougher by a factor, with Schlick's term, times the cosine of the light, in their textbook form.
fn reflected(rougher: f32, normal: Vec3, view: Vec3, light: Vec3) -> f32 {
    let half = (view + light).normalize();
    let [n_h, n_v, n_l] = [half, view, light].map(|w| normal.dot(w).max(1e-4));
    let lobe = |alpha: f32| {
        let squared = alpha.powi(2);
        let d = squared * FRAC_1_PI / (n_h * n_h * (squared - 1.0) + 1.0).powi(2);
        let g = |c: f32| 2.0 / (1.0 + (1.0 + squared * (1.0 / (c * c) - 1.0)).sqrt());
        0.5 * d * g(n_v) * g(n_l) / (4.0 * n_v)
    };
    schlick(SPECULAR, view.dot(half)) * (lobe(0.15 * rougher) + lobe(0.35 * rougher))
}

/// A small white lamp close to a dome of dark skin, with shading and highlights computed independently of the solver.
struct Lamp {
    config: UnshadeConfig,
    sky: Sky,
    transport: Transport,
    illuminations: Illuminations,
    samples: Samples,
    /// R, G, B per texel.
    albedo: Vec<f32>,
    /// The direction from the centre of the dome.
    direction: Vec3,
}

/// Distance of the lamp from the dome's centre, in radii of the dome.
const RADIUS: f32 = 6.0;
const ALBEDO: Vec3 = Vec3::new(0.12, 0.07, 0.05);

fn lamp(rougher: f32) -> Lamp {
    let mut config = small();
    config.transport.bounces = 0;
    config.transport.rows = 16;
    config.transport.texture_size = 64;
    let mesh = testing::dome(24);
    let (low, high) = mesh.bounds();
    let centre = 0.5 * (low + high);
    let direction = Vec3::new(0.3, 0.4, 0.87).normalize();
    let lamp = centre + RADIUS * direction;
    let nearest = mesh.positions.iter().map(|p| p.distance(lamp)).fold(f32::MAX, f32::min);
    let shade = |from: Vec3, p: Vec3| {
        let (normal, to) = (p.normalize(), lamp - p);
        let irradiance = PI * (nearest / to.length()).powi(2);
        let towards = to.normalize();
        let highlight = match normal.dot(towards) > 0.0 {
            true => irradiance * reflected(rougher, normal, (from - p).normalize(), towards),
            false => 0.0,
        };
        (ALBEDO * FRAC_1_PI * irradiance * normal.dot(towards).max(0.0) + highlight, 1)
    };
    let view = |camera: &capture::Camera| {
        let from = camera.camera_to_world.w_axis.truncate();
        testing::view(&mesh, camera, |p| shade(from, p))
    };
    let views: Vec<View> = testing::rig(6, 96).iter().map(view).collect();
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let size = config.transport.texture_size;
    let samples = SampleSpace::default().training(&views, &gbuffers, None, size);
    let sky = Sky::lat_long(config.transport.rows);
    let transport = Transport::with_nearness(&mesh, &sky, &config.transport, 0);
    let albedo = ALBEDO.to_array().repeat(size * size);
    let illuminations = Illuminations::one();
    Lamp { config, sky, transport, illuminations, samples, albedo, direction }
}

impl Lamp {
    fn model(&self, reflectance: f32, samples: &Samples, light: &[f32]) -> ExplicitModel<'_> {
        let texels = self.transport.size() * self.transport.size();
        let terms = SpecularTerm::usual(reflectance).channels().repeat(texels);
        let Self { config, transport, illuminations, .. } = self;
        ExplicitModel::new(config, transport, illuminations, samples, &terms, light, 0.1)
    }

    /// Fits the light to the pictures with an albedo.
    fn found<'a>(&'a self, albedo: &'a [f32], reflectance: f32, rate: f32) -> LightFit<'a> {
        let log_light = vec![0.0; CHANNELS * self.sky.len()];
        let model = self.model(reflectance, &self.samples, &exp(&log_light));
        let nearness = 0.1 / self.transport.nearness_unit();
        let mut fit = LightFit::new(model, albedo, log_light, nearness);
        for _ in 0..400 {
            fit.step(rate);
        }
        fit
    }
}

/// Share of the configured learning rate.
const SLOW: f32 = 0.25;

/// The lamp in front of skin of the usual roughness.
static LAMP: LazyLock<Lamp> = LazyLock::new(|| lamp(1.0));
/// The log radiance and the relative nearness, fitted with the true albedo and reflectance.
static FOUND: LazyLock<(Vec<f32>, f32)> = LazyLock::new(|| {
    let fit = LAMP.found(&LAMP.albedo, SPECULAR, SLOW);
    (fit.log_light.clone(), fit.relative_nearness[0])
});

#[test]
fn highlights_locate_the_lamp() {
    let place = |log_light: &[f32], nearness: f32| {
        let luminance = |cell: &usize| (1e6 * log_light[CHANNELS * cell + 1]) as i64;
        let brightest = (0..LAMP.sky.len()).max_by_key(luminance).unwrap();
        let angle = LAMP.sky.centres()[brightest].angle_between(LAMP.direction).to_degrees();
        (1.0 / (nearness * LAMP.transport.nearness_unit()), angle)
    };
    let matt = LAMP.found(&LAMP.albedo, 0.0, SLOW);
    let (with, without) =
        (place(&FOUND.0, FOUND.1), place(&matt.log_light, matt.relative_nearness[0]));
    // A cell is 11 degrees wide, and the model of shading is linear in the inverse distance.
    assert!(with.1 < 12.0 && (with.0 - RADIUS).abs() < 0.35 * RADIUS, "{with:?}");
    assert!(without.1 > 45.0 && without.0 < 0.6 * RADIUS, "shading alone would do: {without:?}");
}

/// A light fitted to the whole face fits the mottled skin as well.
#[test]
fn cross_validation_keeps_mottled_skin_out_of_the_light() {
    let lamp = &*LAMP;
    let uniform = vec![1.0; CHANNELS * lamp.sky.len()];
    let (shading, _) = lamp.transport.shading_nearer(&uniform, 0.0);
    let layer: Vec<f32> = shading.iter().zip(&lamp.albedo).map(|(s, a)| s * a).collect();
    let layer = lamp.samples.taps.sample::<CHANNELS>(&layer);
    let mut mottled = lamp.samples.clone();
    mottled.target = Planes::from_fn::<CHANNELS>(mottled.len(), |i| {
        let [x, y, z]: [f32; 3] = mottled.normal.sample(i, 0);
        let pigment = 1.0 + 0.3 * (7.0 * x + 3.0 * z).sin() * (8.0 * y - 2.0 * x).sin();
        layer.sample::<CHANNELS>(i, 0).map(|colour| pigment * colour)
    });
    let contrasts = |reflectance: f32, samples: &Samples| {
        let log_light = vec![0.0; uniform.len()];
        let (nearness, steps) = (0.1 / lamp.transport.nearness_unit(), 200);
        let lights = [log_light.clone(), log_light.clone()];
        let model = |samples: &Samples, log: &[f32]| lamp.model(reflectance, samples, &exp(log));
        let mut folds = TwoFoldLightFit::new(
            &lamp.config,
            samples,
            &lamp.albedo,
            &lights,
            nearness,
            steps,
            model,
        );
        let whole = lamp.model(reflectance, samples, &uniform);
        let mut whole = LightFit::new(whole, &lamp.albedo, log_light, nearness);
        for _ in 0..steps {
            folds.step(&Cpu::new(), 1.0);
            whole.step(1.0);
        }
        [mean(&folds.into_best().0), whole.log_light]
            .map(|log_light| contrast(lamp.config.transport.rows, &exp(&log_light)))
    };
    let dark = mean(&[vec![3.0f32.ln(), -200.0], vec![0.0, -200.0]]);
    assert!((dark[0] - 2.0f32.ln()).abs() < 1e-6 && dark[1] == -200.0, "{dark:?}");
    let [folds, whole] = contrasts(0.0, &mottled);
    assert!(folds < 0.5 * whole, "a uniform sky: {folds}, by the whole face {whole}");
    let [folds, whole] = contrasts(SPECULAR, &lamp.samples);
    assert!(folds > 0.9 * whole, "a lamp: {folds}, by the whole face {whole}");
}

/// The albedo is less red and more blue than skin, so the fitted light is too red.
#[test]
fn highlights_correct_the_colour_of_the_light() {
    let lamp = &*LAMP;
    let wrong = [0.9f32, 1.0, 1.15];
    let albedo: Vec<f32> =
        lamp.albedo.iter().zip(wrong.iter().cycle()).map(|(a, wrong)| a * wrong).collect();
    let colour = |light: &[f32]| -> [f32; CHANNELS] {
        let of = |c: usize| light.iter().skip(c).step_by(CHANNELS).sum::<f32>();
        std::array::from_fn(|c| of(c) / of(1))
    };
    let fit = lamp.found(&albedo, SPECULAR, SLOW);
    let light = exp(&fit.log_light);
    let tint = fit.model.tint(&light, fit.relative_nearness[0], &albedo);
    let before = colour(&light);
    assert!(before[0] > 1.1 && before[2] < 0.9, "{before:?}");
    for c in [0, 2] {
        let after = before[c] * tint[c] / tint[1];
        // The correction is partial: the light outside of the highlights has more of the tint.
        assert!((after - 1.0).abs() < 0.6 * (before[c] - 1.0).abs(), "{before:?} {after}");
    }
}

/// The brightest highlights are half of the prediction, the many others match it.
#[test]
fn strong_highlights_count_no_more_than_weak_ones() {
    let (lamp, (log_light, nearness)) = (&*LAMP, &*FOUND);
    let (light, nearness) = (exp(log_light), *nearness);
    let weight = lamp.samples.thinned(lamp.config.light.samples).weight;
    let slope = |samples: &Samples, errors| {
        let model = lamp.model(SPECULAR, samples, &light);
        let regression = model.regression(&light, nearness, &lamp.albedo, &weight, errors);
        regression.sums(|_| true, 0..CHANNELS).slope().unwrap().0
    };
    let all = |i: usize| lamp.samples.target.sample::<CHANNELS>(i, 0);
    let brightest = (0..lamp.samples.len()).map(|i| all(i)[1]).fold(0.0, f32::max);
    let halved = |t: f32| if t > 0.3 * brightest { 0.5 * (t + 0.3 * brightest) } else { t };
    let mut wrong = lamp.samples.clone();
    wrong.target = Planes::from_fn(wrong.len(), |i| all(i).map(halved));
    let lost = |errors| slope(&wrong, errors) / slope(&lamp.samples, errors);
    let (alike, by_error) = (lost(None), lost(Some(&lamp.config.model_error)));
    assert!(alike < 0.8 && 1.0 - by_error < 0.75 * (1.0 - alike), "{alike} {by_error}");
}

/// A cell is larger than the lamp, so the roughness is underestimated.
#[test]
fn highlights_show_the_roughness_of_skin() {
    for truth in [0.6f32, 1.6] {
        let lamp = lamp(truth);
        let fit = lamp.found(&lamp.albedo, SPECULAR, SLOW);
        let nearness = fit.relative_nearness[0] * lamp.transport.nearness_unit();
        let side = lamp.transport.size();
        let regions = vec![1; side * side];
        let terms = RegionTerms::prior(SPECULAR, &[1], &regions);
        let sky = Sky::lat_long(lamp.config.transport.rows).at(nearness);
        let transport = Transport::new(&testing::dome(24), &sky, &lamp.config.transport, 0);
        let estimate = LightEstimate::uniform(transport.cells(), 0.4, terms.clone());
        let estimate = LightEstimate { nearness_per_metre: nearness, ..estimate };
        let joint = JointEstimate {
            log_light: fit.log_light.clone(),
            albedo: lamp.albedo.clone(),
            nearness_per_metre: transport.nearness_per_metre(),
            terms: terms.clone(),
        };
        let one = Illuminations::one();
        let lighting = Lighting::new(&lamp.config, &transport, &one, &regions, &estimate, &joint);
        let config = RoughnessConfig { rounds: 3, error: 0.0, ..lamp.config.roughness.clone() };
        let (flat, backend) = (Relief::none(side), Cpu::new());
        let face = FaceRegions::default();
        let nothing = capture::Truth::default();
        let known = Known::new(&nothing, 1.0);
        let pictures =
            FullPictures { known, samples: &lamp.samples, face: &face, regions: &regions };
        let measured = measure_roughness(&backend, &config, &lighting, &pictures, &flat, &terms);
        let found = measured.of(1).roughness;
        let error = |roughness: f32| (roughness / truth).ln().abs();
        assert!(error(found) < 0.7 * error(1.0) && found < truth, "{found} instead of {truth}");
    }
}
