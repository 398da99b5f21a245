//! Stages that a device takes in whole, against the same stages on the processor.

use std::time::Duration;

use glam::Vec3;
use solver::Config;
use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::backend::gpu::{Adapter, Gpu};
use solver::model::deviation::Deviation;
use solver::model::planes::Planes;
use solver::optimise::diffuse::Diffuse;
use solver::optimise::highlights::{Found, Highlights};
use solver::optimise::normals::Normals;
use solver::optimise::specular::Specular;
use solver::optimise::stage::{Stage, State};
use solver::optimise::transported::Transported;
use solver::optimise::warm_up::WarmUp;
use solver::transport::{Beside, HIGHLIGHT_ROWS, Sky, SpecularTerm, Transport};

use super::scene::problem;
use super::testing;

/// Steps that are compared.
const STEPS: usize = 50;
/// Relative tolerance of every loss.
const TOLERANCE: f64 = 1e-4;
/// Tolerance of all values of a kind together: the norm of the difference over that of their way. Adam
/// makes a whole step of the faintest gradient, whose sign is rounding.
const WAY: f64 = 0.01;

/// The losses of [`STEPS`] steps, the last ones by a share of the rates, and where they lead: the state,
/// and what is the stage's own.
fn steps(backend: &dyn Backend, stage: &mut dyn Stage, mut state: State) -> (Vec<f64>, End) {
    let rate_factors: Vec<f32> = (0..STEPS).map(|step| if step < 40 { 1.0 } else { 0.5 }).collect();
    let Some(mut program) = backend.resident(&stage.job().unwrap()) else {
        let losses =
            rate_factors.iter().map(|factor| stage.step(&mut state, backend, *factor)).collect();
        return (losses, End::of(state, stage));
    };
    program.upload(&stage.variables(&mut state)).unwrap();
    let mut losses = vec![];
    // By way of the host in the middle, as a checkpoint would have it.
    for part in
        [&rate_factors[..1], &rate_factors[1..20], &rate_factors[20..27], &rate_factors[27..]]
    {
        losses.extend(program.steps(part).unwrap());
        program.download(&mut stage.variables(&mut state)).unwrap();
        program.upload(&stage.variables(&mut state)).unwrap();
    }
    (losses, End::of(state, stage))
}

struct End {
    state: State,
    own: Vec<Vec<f32>>,
}

impl End {
    fn of(state: State, stage: &mut dyn Stage) -> Self {
        let own = stage.memory().own.iter().map(|own| own.to_vec()).collect();
        Self { state, own }
    }
}

/// `new` makes the stage with the help of a backend.
fn compare<S: Stage>(backend: &dyn Backend, start: &State, new: impl Fn(&dyn Backend) -> S) {
    let cpu = Cpu::new();
    assert!(backend.resident(&new(backend).job().unwrap()).is_some(), "{}", backend.name());
    let first = End::of(start.clone(), &mut new(backend));
    let (losses, found) = steps(backend, &mut new(backend), start.clone());
    let (expected, reference) = steps(&cpu, &mut new(&cpu), start.clone());
    for (step, (loss, expected)) in losses.iter().zip(&expected).enumerate() {
        let off = loss / expected - 1.0;
        assert!(off.abs() < TOLERANCE, "step {step}: {loss} instead of {expected}");
    }
    assert!(expected[STEPS - 1] < 0.995 * expected[0], "nothing was learnt: {expected:?}");
    let mut moved = 0;
    for (what, field) in FIELDS {
        let [start, found, reference] = [&first, &found, &reference].map(field);
        let distance = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>().sqrt()
        };
        let way = distance(reference, start);
        let off = distance(found, reference);
        assert!(off <= WAY * way, "{what}: {off} of {way}");
        moved += usize::from(way > 0.0);
    }
    assert!(moved > 0);
}

type Field = fn(&End) -> &[f32];

const FIELDS: [(&str, Field); 6] = [
    ("networks", |end| &end.state.networks.parameters),
    ("diffuse", |end| &end.state.diffuse),
    ("specular", |end| &end.state.specular),
    ("deviation", |end| &end.state.deviation),
    ("light", |end| end.own.first().map_or(&[], |own| own)),
    ("nearness", |end| end.own.get(1).map_or(&[], |own| own)),
];

pub fn warm_up(backend: &dyn Backend) {
    let config = Config::default();
    let (samples, state) = problem(&config);
    compare(backend, &state, |_| WarmUp::new(&config, &samples, &state));
}

pub fn diffuse(backend: &dyn Backend) {
    let config = Config::default();
    let (samples, state) = problem(&config);
    let deviation = Deviation::new(&config, state.size);
    compare(backend, &state, |backend| {
        Diffuse::new(&config, &samples, &deviation, &state, backend, 1)
    });
}

pub fn normals(backend: &dyn Backend) {
    let mut config = Config::preset("paper").unwrap();
    // Convolved on the texture, on a coarser one, and on the next.
    for blur in [0.03, 0.14, 0.27] {
        config.fine_tuning.deviation_blur = blur;
        check_normals(backend, &config);
    }
    config.fine_tuning.deviation_smoothing = 0.03;
    config.fine_tuning.deviation_extent = 0.1;
    check_normals(backend, &config);
}

fn check_normals(backend: &dyn Backend, config: &Config) {
    let (samples, mut state) = problem(config);
    state.deviation.iter_mut().enumerate().for_each(|(i, t)| *t = 0.1 * (i as f32 * 0.37).sin());
    let deviation = Deviation::new(config, state.size);
    compare(backend, &state, |backend| {
        Normals::new(config, &samples, &deviation, &state, backend, 1)
    });
}

pub fn specular(backend: &dyn Backend) {
    let mut config = Config::default();
    config.fine_tuning.specular_rate = 1e-3;
    let (samples, state) = problem(&config);
    let deviation = Deviation::new(&config, state.size);
    compare(backend, &state, |backend| {
        Specular::new(&config, &samples, &deviation, &state, backend, 1)
    });
}

pub fn transported(backend: &dyn Backend) {
    let mut config = Config::default();
    config.transport.texture_size = 32;
    config.transport.rows = 6;
    config.transport.light_colour = 0.3;
    config.transport.albedo_frozen_steps = 22;
    config.transport.grey_texel = 0.1;
    let (samples, state) = problem(&config);
    let mesh = testing::dome(24);
    for beside in [Beside::Nearness, Beside::Nothing] {
        let transport = Transport::new(&mesh, &Sky::even(6), &config.transport, 0, beside);
        let light: Vec<f32> =
            (0..3 * transport.cells()).map(|i| 0.3 * (i as f32 * 0.37).sin()).collect();
        compare(backend, &state, |_| {
            Transported::new(&config, &transport, &samples, &state, light.clone())
        });
    }
}

pub fn highlights(backend: &dyn Backend) {
    let mut config = Config::default();
    config.transport.texture_size = 32;
    config.transport.rows = 6;
    config.transport.light_colour = 0.3;
    config.transport.albedo_frozen_steps = 22;
    let (samples, state) = problem(&config);
    let mesh = testing::dome(24);
    let skin_specular = SpecularTerm::usual(0.04).channels().repeat(state.specular.len());
    for beside in [Beside::Nearness, Beside::Open] {
        let transport = Transport::new(&mesh, &Sky::even(6), &config.transport, 0, beside);
        let light: Vec<f32> =
            (0..3 * transport.cells()).map(|i| 0.3 * (i as f32 * 0.37).sin()).collect();
        let nearness = 0.4 * transport.near();
        let found = Found { log_light: &light, nearness, skin_specular: &skin_specular };
        compare(backend, &state, |_| {
            Highlights::new(&config, &transport, &samples, &state, found).unwrap()
        });
    }
}

pub fn skin_highlights(backend: &dyn Backend) {
    let mut config = Config::default();
    config.transport.texture_size = 32;
    let (samples, _) = problem(&config);
    let mesh = testing::dome(24);
    let sky = Sky::even(6).at(0.3);
    let transport = Transport::new(&mesh, &sky, &config.transport, 0, Beside::Open);
    let light = (0..3 * transport.cells()).map(|i| (0.3 * (i as f32 * 0.37).sin()).exp());
    let light: Vec<f32> = light.collect();
    let skin_highlights = transport.skin_highlights(&config.skin, &light).unwrap();
    let tilted = |i: usize| {
        let tilt = [0.37, 0.51, 0.73].map(|k| 0.2 * (i as f32 * k).sin());
        (Vec3::from_array(samples.normal.sample(i, 0)) + Vec3::from_array(tilt)).normalize()
    };
    let normals = Planes::from_fn(samples.len(), |i| tilted(i).to_array());
    let term = |i: usize| {
        let [reflectance, roughness] = [0.9, 1.4].map(|k| 1.0 + 0.3 * (i as f32 * k).sin());
        SpecularTerm { reflectance, roughness }.channels()
    };
    let specular = Planes::from_fn(samples.len(), term);
    let [found, expected] = [backend, &Cpu::new()]
        .map(|backend| backend.highlights(&skin_highlights, &samples, &normals, &specular));
    for row in 0..HIGHLIGHT_ROWS {
        let values = || (0..samples.len()).map(|i| (found.get(row, i), expected.get(row, i)));
        let largest = values().map(|(_, expected)| expected.abs()).fold(0.0, f32::max);
        let off = values().map(|(found, expected)| (found - expected).abs()).fold(0.0, f32::max);
        assert!(largest > 0.1 && off < 1e-4 * largest, "row {row}: {off} of {largest}");
    }
}

/// Without a clock of the adapter's there is nothing to compare.
pub fn timed(adapter: &Adapter) {
    let config = Config::default();
    let (samples, state) = problem(&config);
    let gpu = Gpu::open(adapter).unwrap();
    let run = || {
        let (mut stage, mut state) = (WarmUp::new(&config, &samples, &state), state.clone());
        let mut program = gpu.resident(&stage.job().unwrap()).unwrap();
        program.upload(&stage.variables(&mut state)).unwrap();
        program.steps(&[1.0; 3]).unwrap()
    };
    let (losses, timings) = gpu.timed(run);
    assert_eq!(losses, run());
    assert_eq!(timings.is_some(), adapter.has_clock());
    let Some(timings) = timings else { return };
    for name in ["sampling", "networks", "weight gradients", "prior", "gather", "adam", "sum"] {
        let pass = timings[name];
        assert!(pass.dispatches >= 3 && pass.milliseconds > 0.0, "{name}: {pass:?}");
        assert!(pass.flops > 0.0 && pass.bytes > 0.0, "{name}: {pass:?}");
    }
    // The published networks' operations.
    let flops = timings["networks"].flops / (3 * samples.len()) as f64;
    assert!((flops - 7488.0).abs() < 1.0, "{flops}");
}

/// A kernel that did nothing would be faster than any device.
pub fn ceilings(adapter: &Adapter) {
    let gpu = Gpu::open(adapter).unwrap();
    let found = gpu.ceilings(1 << 20, Duration::from_millis(20)).unwrap();
    assert!(found.flops > 1e8 && found.flops < 1e15, "{found:?}");
    assert!(found.bytes > 1e7 && found.bytes < 1e14, "{found:?}");
}
