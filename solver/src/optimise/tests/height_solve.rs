//! The height solve on pictures whose relief is known.

use capture::gbuffer::Atlas;

use super::*;
use crate::config::HeightConfig;
use crate::model::height::HeightField;
use crate::model::planes::Planes;
use crate::optimise::height_solve::HeightSolve;
use crate::optimise::stage::layers;

const SIDE: usize = 64;
const TEXELS: usize = SIDE * SIDE;
const LINEARISATIONS: usize = 3;

/// Faults of the pictures.
#[derive(Clone, Copy)]
enum Fault {
    None,
    /// A stripe across all of them is brighter by this factor.
    Stripe(f32),
    /// Where the mesh ends, they see half of what is behind it.
    Mixed,
}

/// A solve of pictures that the model itself made from a known height.
struct Found {
    /// Squares of what is missed of the relief, and of the relief, over the seen texels: within the
    /// stripe, and apart from it.
    missed: [f32; 2],
    energy: [f32; 2],
    residuals: Vec<f64>,
}

fn solve(change: impl Fn(&mut HeightConfig), fault: Fault) -> Found {
    let mut config = Config::default();
    change(&mut config.height);
    let mesh = testing::dome(24);
    let views = views(5, 64);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = SampleSpace::new(&mesh, &config);
    let mut samples = space.training(&views, &gbuffers, &config.view_weights, SIDE);
    let state = State {
        networks: Networks::new(&config.networks, 5),
        size: SIDE,
        diffuse: vec![0.5; 3 * TEXELS],
        specular: vec![0.2; TEXELS],
        deviation: vec![0.0; 3 * TEXELS],
    };
    let atlas = Atlas::new(&mesh, SIDE);
    let field = HeightField::new(&atlas, 6.0);
    let wave = |at: usize| {
        let (x, y) = ((at % SIDE) as f32, (at / SIDE) as f32);
        0.3 * (0.9 * x).sin() * (0.7 * y).cos()
    };
    let truth = field.deviation(&(0..TEXELS).map(wave).collect::<Vec<f32>>());
    let bent = State { deviation: truth.clone(), ..state.clone() };
    let backend = Cpu::new();
    let deviation = Deviation::new(&config, SIDE);
    let shading = layers(&samples, &deviation, &bent, &backend);
    let striped = |at: usize| (28..32).contains(&(at % SIDE));
    samples.target = Planes::from_fn(samples.len(), |i| {
        let [diffuse, specular]: [f32; 2] = shading.sample(i, 0);
        let factor = match fault {
            Fault::Stripe(factor) if striped(samples.taps.nearest(i)) => factor,
            Fault::Mixed if beside_nothing(&gbuffers, &samples, i) => 0.5,
            _ => 1.0,
        };
        [factor * (0.5 * diffuse + specular); 3]
    });
    let solve = HeightSolve::new(&config, &backend, &samples, &gbuffers, &atlas, &state, None);
    let (mut unknowns, mut residuals) = (vec![0.0; solve.unknowns()], vec![]);
    for _ in 0..LINEARISATIONS {
        let mut step = |residual| {
            residuals.push(residual);
            Ok(())
        };
        solve.solve(&mut unknowns, &mut step).unwrap();
    }
    let found = solve.deviation(&unknowns);
    let ones = Planes::from_fn(samples.len(), |_| [1.0]);
    let seen = samples.taps.gather::<1>(&ones, 0);
    let (mut missed, mut energy) = ([0.0; 2], [0.0; 2]);
    for at in (0..TEXELS).filter(|at| seen[*at] > 0.5 && atlas.inside[*at]) {
        let [found, truth] = [&found, &truth]
            .map(|deviation| glam::Vec3::from_slice(&deviation[3 * at..3 * at + 3]));
        let part = usize::from(!striped(at));
        missed[part] += found.distance_squared(truth);
        energy[part] += truth.length_squared();
    }
    Found { missed, energy, residuals }
}

/// Whether one of the four pixels beside a sample's shows nothing.
fn beside_nothing(gbuffers: &[GBuffer], samples: &Samples, i: usize) -> bool {
    let gbuffer = &gbuffers[samples.view_index[i] as usize];
    let (pixel, width) = (samples.pixel[i], gbuffer.width as u32);
    let beside = [pixel - 1, pixel + 1, pixel - width, pixel + width];
    beside.iter().any(|pixel| gbuffer.pixels.binary_search(pixel).is_err())
}

fn exact(height: &mut HeightConfig) {
    height.coarsest = 0.0;
    height.rim = 0;
    height.diffuse_doubt = 0.0;
    height.smoothness = 0.0;
    height.flatness = 0.0;
    height.albedo_damping = 1e6;
    height.steps = 600;
}

#[test]
fn a_known_relief_is_found_again() {
    let Found { missed, energy, residuals } = solve(exact, Fault::None);
    let [missed, energy]: [f32; 2] = [missed, energy].map(|parts| parts.iter().sum());
    assert!(energy > 1.0, "{energy}");
    // Random networks hardly see some directions, which are therefore not found.
    assert!(missed < 0.4 * energy, "{} of the relief is missed", missed / energy);
    let (first, last) = (residuals[0], residuals[residuals.len() - 1]);
    assert!(last < 0.1 * first, "{first} {last}");
}

/// An edge that relief and paint of the usual strength cannot make is the model's error: it becomes no
/// relief, and spoils none beside it.
#[test]
fn what_the_model_cannot_explain_is_no_relief() {
    let Found { missed, energy, .. } = solve(exact, Fault::Stripe(3.0));
    assert!(missed[0] < 1.01 * energy[0], "in the stripe: {missed:?} of {energy:?}");
    assert!(missed[1] < 0.5 * energy[1], "beside it: {missed:?} of {energy:?}");
}

/// Pixels that see two surfaces become no relief. What is missed without them is seen on the rim alone.
#[test]
fn a_rim_that_sees_two_surfaces_is_left_out() {
    let missed = |fault: Fault, rim: usize| -> f32 {
        let change = |height: &mut HeightConfig| {
            exact(height);
            height.rim = rim;
        };
        solve(change, fault).missed.iter().sum()
    };
    let [none, kept, left_out] =
        [missed(Fault::None, 0), missed(Fault::Mixed, 0), missed(Fault::Mixed, 2)];
    assert!(left_out - none < 0.7 * (kept - none), "{none} {kept} {left_out}");
}
