//! The relief of pictures with a known relief.

use capture::gbuffer::Atlas;

use super::*;
use crate::config::ReliefConfig;
use crate::model::height::HeightField;
use crate::model::planes::Planes;
use crate::transport::{CHANNELS, LIGHT_EXPONENT};
use crate::unshade::height_solve::HeightProblem;
use crate::unshade::light::JointEstimate;
use crate::unshade::lighting::bent_shading;
use crate::unshade::relief::Relief;

const SIDE: usize = 64;
const TEXELS: usize = SIDE * SIDE;

/// Faults of the pictures.
#[derive(Clone, Copy)]
enum Fault {
    None,
    /// A stripe across all of them is brighter by this factor.
    Stripe(f32),
    /// Pixels at silhouettes mix the mesh with the background.
    Mixed,
}

/// Squared errors of the relief, and squares of the relief, over the seen texels: inside of the stripe, and outside.
struct Missed {
    missed: [f32; 2],
    energy: [f32; 2],
    residuals: Vec<f64>,
}

/// No penalties and no paint: the pictures alone determine the relief.
fn unpenalised() -> ReliefConfig {
    ReliefConfig {
        diffuse_share: 0.0,
        smoothness: 0.0,
        flatness: 0.0,
        albedo_damping: 1e6,
        steps: 600,
        ..UnshadeConfig::default().relief
    }
}

/// Solves pictures that the model rendered from known heights, under a lamp in front of a dome.
fn missed(relief: ReliefConfig, fault: Fault) -> Missed {
    let mut config = UnshadeConfig { relief, ..UnshadeConfig::default() };
    config.transport.texture_size = SIDE;
    config.transport.rows = 8;
    config.transport.bounces = 0;
    let mesh = testing::dome(24);
    let views = views(5, 64);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let mut samples = SampleSpace::default().training(&views, &gbuffers, None, SIDE);
    let transport = Transport::new(&mesh, &Sky::lat_long(8), &config.transport, 0);
    let towards = |centre: &Vec3| centre.dot(Vec3::new(0.3, 0.4, 0.87)).max(0.0).powi(8);
    let cells = Sky::lat_long(8).centres();
    let lamp = cells.iter().flat_map(|centre| [(0.1 + 4.0 * towards(centre)).ln(); CHANNELS]);
    let terms = RegionTerms::prior(0.05, &[1], &[1]);
    let joint = JointEstimate {
        log_light: lamp.collect(),
        albedo: vec![0.5; 3 * TEXELS],
        nearness_per_metre: 0.0,
        terms: terms.clone(),
    };
    let estimate = LightEstimate::uniform(transport.cells(), 0.4, terms.clone());
    let regions = vec![1; TEXELS];
    let one = Illuminations::one();
    let lighting = Lighting::new(&config, &transport, &one, &regions, &estimate, &joint);
    let backend = Cpu::new();

    let atlas = Atlas::new(&mesh, SIDE);
    let wave = |at: usize| {
        let (x, y) = ((at % SIDE) as f32, (at / SIDE) as f32);
        0.3 * (0.9 * x).sin() * (0.7 * y).cos()
    };
    let heights: Vec<f32> = (0..TEXELS).map(wave).collect();
    let truth = Relief::new(SIDE, HeightField::new(&atlas, 6.0).deviation(&heights));
    let sharp = samples.taps.sample::<3>(&truth.deviation);
    let soft = samples.taps.sample::<3>(&truth.blurred());
    let highlights = lighting.highlights(&backend, &terms, &samples, LIGHT_EXPONENT);
    let specular = highlights.at(&samples, &sharp);
    let derivative = lighting.shading_with_derivative(&samples);
    samples.target = Planes::from_fn(samples.len(), |i| {
        let normal = Vec3::from_array(samples.normal.sample(i, 0));
        let bent = (normal + Vec3::from_array(soft.sample(i, 0))).normalize();
        let shading = bent_shading(&derivative.sample(i, 0), normal, bent);
        let factor = match fault {
            Fault::Stripe(factor) if is_striped(samples.taps.nearest(i)) => factor,
            Fault::Mixed if beside_nothing(&gbuffers, &samples, i) => 0.5,
            _ => 1.0,
        };
        std::array::from_fn::<f32, CHANNELS, _>(|c| {
            factor * (0.5 * shading[c] + specular.get(c, i))
        })
    });
    let config: &ReliefConfig = &config.relief;
    let problem =
        HeightProblem::new(config, &backend, &samples, &gbuffers, &atlas, &lighting, &joint);
    let (mut unknowns, mut residuals) = (vec![0.0; problem.unknowns()], vec![]);
    for _ in 0..3 {
        let mut step = |residual| {
            residuals.push(residual);
            Ok(())
        };
        problem.minimise(&mut unknowns, &mut step).unwrap();
    }
    let found = problem.deviation(&unknowns);
    let ones = Planes::from_fn(samples.len(), |_| [1.0]);
    let seen = samples.taps.gather::<1>(&ones, 0);
    let (mut missed, mut energy) = ([0.0; 2], [0.0; 2]);
    for at in (0..TEXELS).filter(|at| seen[*at] > 0.5 && atlas.inside[*at]) {
        let [found, truth] = [&found, &truth.deviation]
            .map(|deviation| Vec3::from_slice(&deviation[3 * at..3 * at + 3]));
        let part = usize::from(!is_striped(at));
        missed[part] += found.distance_squared(truth);
        energy[part] += truth.length_squared();
    }
    Missed { missed, energy, residuals }
}

fn is_striped(texel: usize) -> bool {
    (28..32).contains(&(texel % SIDE))
}

/// Whether one of the four neighbours of a sample's pixel is not covered.
fn beside_nothing(gbuffers: &[GBuffer], samples: &Samples, i: usize) -> bool {
    let gbuffer = &gbuffers[samples.view_index[i] as usize];
    let (pixel, width) = (samples.pixel[i], gbuffer.width as u32);
    let beside = [pixel - 1, pixel + 1, pixel - width, pixel + width];
    beside.iter().any(|pixel| gbuffer.pixels.binary_search(pixel).is_err())
}

#[test]
fn a_known_relief_is_found() {
    let Missed { missed, energy, residuals } = missed(unpenalised(), Fault::None);
    let [missed, energy]: [f32; 2] = [missed, energy].map(|parts| parts.iter().sum());
    assert!(energy > 1.0, "{energy}");
    // Its coarse part and the rim are excluded by design, so a part of the relief and of the residual remains.
    assert!(missed < 0.5 * energy, "{} of the relief is missed", missed / energy);
    let (first, last) = (residuals[0], residuals[residuals.len() - 1]);
    assert!(last < 0.5 * first, "{first} {last}");
}

/// An edge that is too strong for relief and paint is an error of the model.
#[test]
fn a_model_error_does_not_become_relief_nor_change_relief_beside_it() {
    let solved = |fault| missed(UnshadeConfig::default().relief, fault);
    let [clean, striped] = [Fault::None, Fault::Stripe(3.0)].map(solved);
    let [within, beside] = striped.missed;
    assert!(within < 1.1 * clean.energy[0], "in the stripe: {within} of {:?}", clean.energy);
    assert!(beside < 1.25 * clean.missed[1], "beside it: {beside} instead of {:?}", clean.missed);
}

/// Pixels at silhouettes mix two surfaces.
#[test]
fn silhouettes_do_not_become_relief() {
    let missed = |fault| -> f32 { missed(unpenalised(), fault).missed.iter().sum() };
    let [clean, mixed] = [Fault::None, Fault::Mixed].map(missed);
    assert!(mixed < 1.1 * clean, "{mixed} {clean}");
}
