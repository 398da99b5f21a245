//! Fits on a device, against the same fits on the processor.

use std::time::Duration;

use glam::Vec3;
use solver::backend::Backend;
use solver::backend::cpu::Cpu;
use solver::backend::gpu::{Adapter, Gpu};
use solver::config::{PaperConfig, UnshadeConfig};
use solver::fit::Fit;
use solver::model::deviation::Deviation;
use solver::model::planes::Planes;
use solver::paper::diffuse::diffuse as diffuse_fit;
use solver::paper::normals::Normals;
use solver::paper::warm_up::WarmUp;
use solver::transport::{HIGHLIGHT_ROWS, LIGHT_EXPONENT, Sky, SpecularTerm, Transport};

use super::scene::problem;
use super::testing;

/// The number of compared steps.
const STEPS: usize = 50;
/// Relative tolerance of every loss.
const TOLERANCE: f64 = 1e-4;
/// Tolerance of a variable: the norm of the difference over that of the total change. Single values may differ, since
/// Adam takes a whole step along any gradient, even one whose sign is rounding.
const WAY: f64 = 0.01;

/// The losses of the steps, and the variables after them.
fn steps(backend: &dyn Backend, fit: &mut dyn Fit) -> (Vec<f64>, Vec<Vec<f32>>) {
    let rate_factors: Vec<f32> = (0..STEPS).map(|step| if step < 40 { 1.0 } else { 0.5 }).collect();
    let Some(mut program) = backend.resident(&fit.job().unwrap()) else {
        let losses = rate_factors.iter().map(|factor| fit.step(backend, *factor)).collect();
        return (losses, values(fit));
    };
    program.upload(&fit.variables()).unwrap();
    let mut losses = vec![];
    for part in
        [&rate_factors[..1], &rate_factors[1..20], &rate_factors[20..27], &rate_factors[27..]]
    {
        losses.extend(program.steps(part).unwrap());
        program.download(&mut fit.variables()).unwrap();
        program.upload(&fit.variables()).unwrap();
    }
    (losses, values(fit))
}

fn values(fit: &mut dyn Fit) -> Vec<Vec<f32>> {
    fit.variables().iter().map(|variable| variable.values.clone()).collect()
}

/// Compares a fit on a device with the processor's, over all steps.
fn compare<F: Fit>(backend: &dyn Backend, new: impl Fn(&dyn Backend) -> F) {
    let cpu = Cpu::new();
    assert!(backend.resident(&new(backend).job().unwrap()).is_some(), "{}", backend.name());
    let start = values(&mut new(backend));
    let (losses, found) = steps(backend, &mut new(backend));
    let (expected, reference) = steps(&cpu, &mut new(&cpu));
    for (step, (loss, expected)) in losses.iter().zip(&expected).enumerate() {
        let off = loss / expected - 1.0;
        assert!(off.abs() < TOLERANCE, "step {step}: {loss} instead of {expected}");
    }
    assert!(expected[STEPS - 1] < 0.995 * expected[0], "nothing was learnt: {expected:?}");
    for (what, start) in start.iter().enumerate() {
        let distance = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>().sqrt()
        };
        let way = distance(&reference[what], start);
        let off = distance(&found[what], &reference[what]);
        assert!(way > 0.0 && off <= WAY * way, "variable {what}: {off} of {way}");
    }
}

pub fn warm_up(backend: &dyn Backend) {
    let config = PaperConfig::default();
    let (samples, state) = problem(&config);
    compare(backend, |_| WarmUp::new(&config, &samples, state.clone()));
}

pub fn diffuse(backend: &dyn Backend) {
    let config = PaperConfig::default();
    let (samples, state) = problem(&config);
    let deviation = Deviation::new(&config, state.size);
    compare(backend, |backend| diffuse_fit(&config, &samples, &deviation, &state, backend));
}

pub fn normals(backend: &dyn Backend) {
    let mut config = PaperConfig::default();
    // Convolved on the texture, on a coarser one, and on the next.
    for blur in [0.03, 0.14, 0.27] {
        config.fine_tuning.deviation_blur = blur;
        check_normals(backend, &config);
    }
    config.fine_tuning.deviation_smoothing = 0.03;
    config.fine_tuning.deviation_extent = 0.1;
    check_normals(backend, &config);
}

fn check_normals(backend: &dyn Backend, config: &PaperConfig) {
    let (samples, mut state) = problem(config);
    state.deviation.iter_mut().enumerate().for_each(|(i, t)| *t = 0.1 * (i as f32 * 0.37).sin());
    let deviation = Deviation::new(config, state.size);
    compare(backend, |backend| Normals::new(config, &samples, &deviation, &state, backend));
}

pub fn skin_highlights(backend: &dyn Backend) {
    let mut config = UnshadeConfig::default();
    config.transport.texture_size = 32;
    let (samples, _) = problem(&PaperConfig::default());
    let mesh = testing::dome(24);
    let sky = Sky::lat_long(6).at(0.3);
    let transport = Transport::new(&mesh, &sky, &config.transport, 0);
    let light = (0..3 * transport.cells()).map(|i| (0.3 * (i as f32 * 0.37).sin()).exp());
    let light: Vec<f32> = light.collect();
    let peak = transport.peak(&light);
    let skin_highlights = transport.skin_highlights(&config.skin, &light, peak, LIGHT_EXPONENT);
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

/// Skipped without a clock of the adapter.
pub fn timed(adapter: &Adapter) {
    let config = PaperConfig::default();
    let (samples, state) = problem(&config);
    let gpu = Gpu::open(adapter).unwrap();
    let run = || {
        let mut fit = WarmUp::new(&config, &samples, state.clone());
        let mut program = gpu.resident(&fit.job().unwrap()).unwrap();
        program.upload(&fit.variables()).unwrap();
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
