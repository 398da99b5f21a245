//! Light, distance and albedo with the highlights that the light itself makes.

use std::f32::consts::{FRAC_1_PI, PI};

use super::*;
use crate::config::TransportConfig;
use crate::model::planes::Planes;
use crate::optimise::halves::{Halves, mean};
use crate::optimise::highlights::{Found, Highlights};
use crate::optimise::regression::Regression;
use crate::transport::skin::schlick;
use crate::transport::{Beside, CHANNELS, Sky, SpecularTerm, Transport, contrast};

/// Specular reflectance of skin at normal incidence.
const SPECULAR: f32 = 0.04;

#[test]
fn gradients_reach_light_distance_and_albedo() {
    let Problem { mut config, samples, state } = problem();
    config.transport.texture_size = SIDE;
    config.transport.rows = 4;
    config.transport.prior = 20.0;
    let mesh = testing::dome(12);
    let transport = Transport::new(&mesh, &Sky::even(4), &config.transport, 0, Beside::Nearness);
    let cells = CHANNELS * transport.cells();
    let light: Vec<f32> = (0..cells).map(|i| (i as f32 * 0.37).sin()).collect();
    let skin_specular = SpecularTerm::usual(0.2).channels().repeat(SIDE * SIDE);
    let known = Found {
        log_light: &light,
        nearness: 0.4 * transport.near(),
        skin_specular: &skin_specular,
    };
    let mut stage = Highlights::new(&config, &transport, &samples, &state, known).unwrap();
    let found = stage.gradient(&state);
    let loss = |state: &State| stage.gradient(state).loss;
    assert_gradient("diffuse", &state, &found.diffuse, |s| &mut s.diffuse, 2e-3, loss);
    let largest = found.light.iter().fold(0.0f32, |m, g| m.max(g.abs()));
    for at in (0..cells).filter(|at| found.light[*at].abs() > 0.3 * largest).step_by(3) {
        let mut moved = |step: f32| {
            stage.log_light[at] = light[at] + step;
            stage.gradient(&state).loss
        };
        let expected = (moved(3e-3) - moved(-3e-3)) / 6e-3;
        stage.log_light[at] = light[at];
        let error = (f64::from(found.light[at]) - expected).abs();
        assert!(error < 0.01 * f64::from(largest), "{at}: {} not {expected}", found.light[at]);
    }
    let mut moved = |step: f32| {
        stage.nearness[0] = 0.4 + step;
        stage.gradient(&state).loss
    };
    let expected = (moved(1e-2) - moved(-1e-2)) / 2e-2;
    let nearness = f64::from(found.nearness.unwrap());
    assert!((nearness - expected).abs() < 0.01 * expected.abs(), "{nearness} not {expected}");
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

/// A small white lamp close to a dome of dark skin, whose shading and whose highlights are computed apart
/// from the solver.
struct Lamp {
    config: Config,
    sky: Sky,
    transport: Transport,
    samples: Samples,
    state: State,
    /// From the middle of the dome.
    direction: Vec3,
}

/// Radii of the dome from its middle to the lamp.
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
    let samples = SampleSpace::new(&mesh, &config).training(
        &views,
        &gbuffers,
        &config.view_weights,
        config.transport.texture_size,
    );
    let sky = Sky::even(config.transport.rows);
    let transport = Transport::new(&mesh, &sky, &config.transport, 0, Beside::Nearness);
    let texels = transport.size() * transport.size();
    let state = State {
        networks: Networks::new(&config.networks, 0),
        size: transport.size(),
        diffuse: (0..texels).flat_map(|_| ALBEDO.to_array()).collect(),
        specular: vec![0.0; texels],
        deviation: vec![],
    };
    Lamp { config, sky, transport, samples, state, direction }
}

impl Lamp {
    /// The light that explains the pictures with the albedo that is given.
    fn found(&self, state: &State, skin_specular: f32, samples: &Samples) -> Highlights<'_> {
        let log_light = vec![0.0; CHANNELS * self.sky.len()];
        let texels = self.transport.size() * self.transport.size();
        let skin_specular = SpecularTerm::usual(skin_specular).channels().repeat(texels);
        let found = Found { log_light: &log_light, nearness: 0.1, skin_specular: &skin_specular };
        let new = Highlights::new(&self.config, &self.transport, samples, state, found);
        let mut stage = new.unwrap().of_light_alone(self.config.transport.light_rate);
        for _ in 0..400 {
            stage.step(&mut state.clone(), &Cpu::new(), 1.0);
        }
        stage
    }
}

#[test]
fn highlights_say_where_the_lamp_is() {
    let lamp = lamp(1.0);
    let found = |skin_specular: f32| {
        let stage = lamp.found(&lamp.state, skin_specular, &lamp.samples);
        let luminance = |cell: &usize| (1e6 * stage.log_light[CHANNELS * cell + 1]) as i64;
        let brightest = (0..lamp.sky.len()).max_by_key(luminance).unwrap();
        let angle = lamp.sky.centres()[brightest].angle_between(lamp.direction).to_degrees();
        (1.0 / (stage.nearness[0] * lamp.transport.near()), angle)
    };
    let (with, without) = (found(SPECULAR), found(0.0));
    // A cell is 11 degrees wide, and shading is taken as linear in the inverse distance.
    assert!(with.1 < 12.0 && (with.0 - RADIUS).abs() < 0.35 * RADIUS, "{with:?}");
    assert!(without.1 > 45.0 && without.0 < 0.5 * RADIUS, "shading alone would do: {without:?}");
}

/// A light of that many cells explains both.
#[test]
fn what_one_half_of_the_face_says_of_light_but_not_of_mottled_skin_holds_on_the_other() {
    let lamp = lamp(1.0);
    let even = vec![1.0; CHANNELS * lamp.sky.len()];
    let (shading, _) = lamp.transport.shading_nearer(&even, 0.0);
    let layer: Vec<f32> = shading.iter().zip(&lamp.state.diffuse).map(|(s, a)| s * a).collect();
    let layer = lamp.samples.taps.sample::<CHANNELS>(&layer);
    let mut mottled = lamp.samples.clone();
    mottled.target = Planes::from_fn::<CHANNELS>(mottled.len(), |i| {
        let [x, y, z]: [f32; 3] = mottled.position.sample(i, 0);
        let pigment = 1.0 + 0.3 * (7.0 * x + 3.0 * z).sin() * (8.0 * y - 2.0 * x).sin();
        layer.sample::<CHANNELS>(i, 0).map(|colour| pigment * colour)
    });
    let contrasts = |skin_specular: f32, samples: &Samples| {
        let (transport, state) = (&lamp.transport, &mut lamp.state.clone());
        let log_light = vec![0.0; even.len()];
        let texels = transport.size() * transport.size();
        let skin_specular = SpecularTerm::usual(skin_specular).channels().repeat(texels);
        let found = Found { log_light: &log_light, nearness: 0.1, skin_specular: &skin_specular };
        let (config, steps) = (&lamp.config, 200);
        let halves =
            Halves::new(config, transport, samples, state, [found; 2], String::new(), steps);
        let mut halves = halves.unwrap();
        let whole = Highlights::new(config, transport, samples, state, found).unwrap();
        let mut whole = whole.of_light_alone(config.transport.distance_rate);
        for _ in 0..steps {
            halves.step(state, &Cpu::new(), 1.0);
            whole.step(state, &Cpu::new(), 1.0);
        }
        [mean(&halves.best().0), whole.log_light].map(|log_light| {
            let light: Vec<f32> = log_light.iter().map(|log| log.exp()).collect();
            contrast(lamp.config.transport.rows, &light)
        })
    };
    let dark = mean(&[vec![3.0f32.ln(), -200.0], vec![0.0, -200.0]]);
    assert!((dark[0] - 2.0f32.ln()).abs() < 1e-6 && dark[1] == -200.0, "{dark:?}");
    let [halves, whole] = contrasts(0.0, &mottled);
    assert!(halves < 0.5 * whole, "an even sky: {halves}, by the whole face {whole}");
    let [halves, whole] = contrasts(SPECULAR, &lamp.samples);
    assert!(halves > 0.9 * whole, "a lamp: {halves}, by the whole face {whole}");
}

/// Skin is said to be less red and more blue than it is, and so the light comes out too red.
#[test]
fn highlights_say_what_colour_the_lamp_has() {
    let mut lamp = lamp(1.0);
    let wrong = [0.9f32, 1.0, 1.15];
    let texels = lamp.state.diffuse.iter_mut().zip(wrong.iter().cycle());
    texels.for_each(|(albedo, wrong)| *albedo *= wrong);
    let colour = |stage: &Highlights| -> [f32; CHANNELS] {
        let of = |c: usize| stage.log_light.iter().skip(c).step_by(CHANNELS).map(|log| log.exp());
        std::array::from_fn(|c| of(c).sum::<f32>() / of(1).sum::<f32>())
    };
    let mut stage = lamp.found(&lamp.state, SPECULAR, &lamp.samples);
    let before = colour(&stage);
    let tint = stage.take_tint(&lamp.state);
    let after = colour(&stage);
    for c in 0..CHANNELS {
        assert!((after[c] - before[c] * tint[c] / tint[1]).abs() < 1e-4, "{tint:?} {after:?}");
    }
    assert!(before[0] > 1.1 && before[2] < 0.9, "{before:?}");
    for c in [0, 2] {
        // Not all of it: what the highlights do not show has taken more of the tint than what they show.
        assert!((after[c] - 1.0).abs() < 0.6 * (before[c] - 1.0).abs(), "{before:?} {after:?}");
    }
}

/// The brightest show half of what is predicted there, the many others what is predicted.
#[test]
fn strong_highlights_count_for_no_more_than_weak_ones_in_what_a_region_mirrors() {
    let lamp = lamp(1.0);
    let stage = lamp.found(&lamp.state, SPECULAR, &lamp.samples);
    let nearness = stage.nearness[0] * lamp.transport.near();
    let texels = lamp.transport.size() * lamp.transport.size();
    let skin_specular = SpecularTerm::usual(SPECULAR).channels().repeat(texels);
    let weight = lamp.samples.thinned(lamp.config.transport.highlight_samples).weight;
    let slope = |samples: &Samples, errors| {
        let log_light = &stage.log_light;
        let found = Found { log_light, nearness, skin_specular: &skin_specular };
        let new = Highlights::new(&lamp.config, &lamp.transport, samples, &lamp.state, found);
        let regression = new.unwrap().regression(&lamp.state, &weight, errors);
        regression.fit(|_| true, 0..CHANNELS).slope().unwrap().0
    };
    let all = |i: usize| lamp.samples.target.sample::<CHANNELS>(i, 0);
    let brightest = (0..lamp.samples.len()).map(|i| all(i)[1]).fold(0.0, f32::max);
    let halved = |t: f32| if t > 0.3 * brightest { 0.5 * (t + 0.3 * brightest) } else { t };
    let mut wrong = lamp.samples.clone();
    wrong.target = Planes::from_fn(wrong.len(), |i| all(i).map(halved));
    let lost = |errors| slope(&wrong, errors) / slope(&lamp.samples, errors);
    let (alike, by_error) = (lost(None), lost(Some(&Config::default().model_error)));
    assert!(alike < 0.8 && 1.0 - by_error < 0.75 * (1.0 - alike), "{alike} {by_error}");
}

#[test]
fn highlights_say_how_rough_skin_is() {
    let found = |rougher: f32| {
        let lamp = lamp(rougher);
        let stage = lamp.found(&lamp.state, SPECULAR, &lamp.samples);
        let light: Vec<f32> = stage.log_light.iter().map(|log| log.exp()).collect();
        let exponent = lamp.config.reflectance.roughness_light_exponent;
        let t = TransportConfig { light_exponent: exponent, ..lamp.config.transport.clone() };
        let transport = Transport::new(&testing::dome(24), &lamp.sky, &t, 0, Beside::Nearness);
        let (peak, nearness) = (transport.peak(&light), stage.nearness[0] * transport.near());
        let mut roughness = 1.0f32;
        for _ in 0..3 {
            let predicted = |roughness: f32| {
                let term = SpecularTerm { reflectance: SPECULAR, roughness }.channels();
                let terms = Planes::from_fn(lamp.samples.len(), |_| term);
                let skin = &lamp.config.skin;
                let rows = transport.reflection(skin, &lamp.samples, &terms, peak, nearness);
                rows.unwrap().radiance(&light)
            };
            let (here, there) = (predicted(roughness), predicted(1.1 * roughness));
            let slope =
                |i: usize| std::array::from_fn(|c| (there[i][c] - here[i][c]) / 1.1f32.ln());
            let shown = |i: usize| lamp.samples.target.sample(i, 0);
            let rows = |i: usize| [here[i], slope(i)];
            let regression = Regression::new(&lamp.samples, &lamp.samples.weight, rows, shown);
            let (step, error) = regression.fit(|_| true, 0..CHANNELS).rougher().unwrap();
            assert!(error < 0.2, "{error}");
            roughness *= (step.clamp(-0.3, 0.3) as f32).exp();
        }
        roughness
    };
    for truth in [0.6f32, 1.6] {
        let found = found(truth);
        let misses = |roughness: f32| (roughness / truth).ln().abs();
        // The lamp is smaller than a cell of the light, so that skin seems the sharper.
        assert!(misses(found) < 0.7 * misses(1.0) && found < truth, "{found} not {truth}");
    }
}
