//! Gradients of the stages through textures, taps, blur and normals; and whole solves of a small
//! scene whose answer is known.

mod confidence;
mod exposure;
mod gradients;
mod height_solve;
mod highlights;
mod interrupts;
mod recorded;
mod transported;

use std::ops::ControlFlow;

use capture::gbuffer::GBuffer;
use capture::{Capture, CaptureError, View};
use formats::maps::Maps;
use formats::picture;
use glam::{Vec2, Vec3};

use super::diffuse::Diffuse;
use super::error::SolveError;
use super::normals::Normals;
use super::progress::Options;
use super::solve::solve_on;
use super::stage::{Stage, State};
use super::warm_up::WarmUp;
use crate::backend::cpu::{Cpu, Level};
use crate::config::{Config, TextureSize};
use crate::model::deviation::Deviation;
use crate::model::networks::Networks;
use crate::model::samples::{SampleSpace, Samples};
use crate::solution::Solution;
use crate::testing;

/// Side of the textures in the gradient tests.
const SIDE: usize = 16;

/// Labelled regions of the dome with their reflectance.
const REGIONS: [(u8, Vec3); 3] = [
    (1, Vec3::new(0.6, 0.4, 0.3)),
    (2, Vec3::new(0.45, 0.25, 0.22)),
    (3, Vec3::new(0.2, 0.15, 0.12)),
];

fn region(position: Vec3) -> (u8, Vec3) {
    REGIONS[match (position.truncate().length(), position.x) {
        (radius, _) if radius < 0.3 => 1,
        (_, x) if x < -0.45 => 2,
        _ => 0,
    }]
}

/// The unit dome under one soft light from the upper right; its largest irradiance is pi.
fn lit(position: Vec3) -> (Vec3, u8) {
    let (label, albedo) = region(position);
    let light = Vec3::new(0.4, 0.5, 0.77).normalize();
    (albedo * (0.25 + 0.75 * position.dot(light).max(0.0)), label)
}

fn views(count: usize, size: usize) -> Vec<View> {
    let mesh = testing::dome(24);
    testing::rig(count, size).iter().map(|camera| testing::view(&mesh, camera, lit)).collect()
}

/// A capture folder with five training views and one withheld.
fn capture(folder: &std::path::Path) -> Capture {
    testing::write_capture(folder, &testing::dome(24), &views(6, 48), 1);
    Capture::open(folder).unwrap()
}

fn small() -> Config {
    let mut config = Config::default();
    config.initialisation.starts = 1;
    config.warm_up.iterations = 500;
    config.warm_up.texture_size = 64;
    config.fine_tuning.iterations = 40;
    config.fine_tuning.rounds = 1;
    config.fine_tuning.texture_size = TextureSize::Side(64);
    config.transport.texture_size = 32;
    config.transport.rows = 8;
    config.transport.iterations = 150;
    config.transport.albedo_frozen_steps = 50;
    config.transport.refinement = 40;
    config.height.linearisations = 1;
    config.height.steps = 80;
    config
}

fn solve(
    capture: &Capture,
    config: &Config,
    progress: &mut super::progress::Callback,
) -> Result<Solution, SolveError> {
    solve_on(&Cpu::new(), capture, config, Options::default(), progress)
}

fn silent(_: &crate::Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

struct Problem {
    config: Config,
    samples: Samples,
    state: State,
}

/// Samples of two small views with black targets: no residual is near the kink of |x|.
fn problem() -> Problem {
    let mut config = Config::default();
    config.height.enabled = false;
    config.fine_tuning.deviation_blur = 0.08;
    config.fine_tuning.deviation_smoothing = 0.05;
    config.fine_tuning.deviation_extent = 0.1;
    config.warm_up.prior = 20.0;
    config.fine_tuning.prior = 20.0;
    let mesh = testing::dome(12);
    let mut views = views(2, 24);
    views.iter_mut().for_each(|view| view.image.data.fill(0.0));
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let space = SampleSpace::new(&mesh, &config);
    let samples = space.training(&views, &gbuffers, &config.view_weights, SIDE);
    let noise = |count: usize, low: f32, high: f32| -> Vec<f32> {
        (0..count).map(|i| low + (high - low) * (i as f32 * 12.9898).sin().abs()).collect()
    };
    let texels = SIDE * SIDE;
    let state = State {
        networks: Networks::new(&config.networks, 5),
        size: SIDE,
        diffuse: noise(3 * texels, 0.1, 0.9),
        specular: noise(texels, 0.2, 0.6),
        deviation: noise(3 * texels, -0.4, 0.4),
    };
    Problem { config, samples, state }
}

/// Central differences of an f32 computation: the step balances rounding and curvature.
fn assert_gradient(
    what: &str,
    state: &State,
    gradient: &[f32],
    field: fn(&mut State) -> &mut Vec<f32>,
    step: f32,
    loss: impl Fn(&State) -> f64,
) {
    let largest = gradient.iter().fold(0.0f32, |m, g| m.max(g.abs()));
    let strong = gradient.iter().enumerate().filter(|(_, g)| g.abs() > 0.3 * largest);
    let picked: Vec<usize> = strong.map(|(at, _)| at).step_by(7).take(12).collect();
    assert!(picked.len() >= 3, "{what}: only {} strong gradients", picked.len());
    for at in picked {
        let moved = |step: f32| {
            let mut moved = state.clone();
            field(&mut moved)[at] += step;
            loss(&moved)
        };
        let expected = (moved(step) - moved(-step)) / (2.0 * f64::from(step));
        let error = (f64::from(gradient[at]) - expected).abs();
        assert!(
            error < 0.01 * f64::from(largest),
            "{what} {at}: {} instead of {expected}",
            gradient[at]
        );
    }
}

/// Mean squared error to decibels.
fn decibels(errors: &[f32]) -> f32 {
    -10.0 * (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).log10()
}

#[test]
fn a_known_scene_is_recovered_and_its_withheld_view_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let solution = solve(&capture(folder.path()), &small(), &mut silent).unwrap();

    let albedo = solution.maps.diffuse_albedo.as_ref().unwrap();
    let coverage = solution.maps.coverage.as_ref().unwrap();
    let size = albedo.width;
    let mut errors = vec![];
    for at in (0..size * size).filter(|at| coverage.data[*at] == 255) {
        let uv = Vec2::new((at % size) as f32 + 0.5, (at / size) as f32 + 0.5) / size as f32;
        let chart = Vec2::new(uv.x - 0.5, 0.5 - uv.y) / 0.4;
        let polar = chart.length() * 0.2f32.acos();
        let position = (chart.normalize() * polar.sin()).extend(polar.cos());
        let truth = region(position).1;
        // Edges of regions are as sharp as the views' pixels; they are not what is tested here.
        let near = |d: Vec2| region(position + d.extend(0.0)).1 == truth;
        if [Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y].iter().all(|d| near(*d * 0.08)) {
            errors.extend((Vec3::from_slice(&albedo.data[3 * at..]) - truth).to_array());
        }
    }
    assert!(errors.len() > 3000, "{}", errors.len());
    assert!(decibels(&errors) > 27.0, "albedo: {} dB", decibels(&errors));

    let withheld = &views(6, 48)[5];
    let picture = &solution.views[0].picture;
    let mut errors = vec![];
    for at in (0..48 * 48).filter(|at| withheld.mask.data[*at] == 255) {
        let pixel = &picture.data[9 * at..][..9];
        for channel in 0..3 {
            assert!((pixel[channel] - pixel[3 + channel] - pixel[6 + channel]).abs() < 1e-5);
            errors.push(pixel[channel] - withheld.image.data[3 * at + channel]);
        }
    }
    assert!(decibels(&errors) > 32.0, "withheld view: {} dB", decibels(&errors));
    assert_eq!(solution.views[0].name, withheld.camera.name);
}

/// Bytes are equal for any number of threads, without `truth`, and nothing else is in the folder.
#[test]
fn solutions_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    assert!(!folder.path().join("capture/truth").exists());
    let mut config = small();
    config.warm_up.iterations = 20;
    config.fine_tuning.iterations = 5;
    let run = |threads: usize| -> Solution {
        testing::on_threads(threads, || solve(&capture, &config, &mut silent).unwrap())
    };
    let first = run(1);
    for threads in [2, 3] {
        let other = run(threads);
        assert_eq!(first.maps, other.maps, "{threads} threads");
        assert_eq!(first.views, other.views, "{threads} threads");
        assert_eq!(first.record, other.record, "{threads} threads");
    }
    let target = folder.path().join("maps");
    first.write(&target).unwrap();
    let mut names: Vec<String> = std::fs::read_dir(&target)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let expected = [
        ".unshade",
        "confidence.exr",
        "coverage.png",
        "diffuse_albedo.exr",
        "diffuse_normal.exr",
        "light.exr",
        "roughness.exr",
        "solve.json",
        "specular_albedo.exr",
        "specular_normal.exr",
        "stages",
        "timing.json",
        "views",
    ];
    assert_eq!(names, expected);
    let mut stages: Vec<String> = std::fs::read_dir(target.join("stages"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    stages.sort();
    let expected = [
        "01-warm-up",
        "02-transport",
        "03-highlights",
        "04-heights",
        "05-specular-1",
        "06-diffuse-1",
        "07-albedo",
    ];
    assert_eq!(stages, expected);
    // The last stage of a map leaves what the map is, up to what was resampled.
    let last = Maps::read(&target.join("stages/07-albedo")).unwrap();
    assert_eq!(last.diffuse_albedo, first.maps.diffuse_albedo);
    assert!(last.specular_normal.is_none());
    let last = Maps::read(&target.join("stages/04-heights")).unwrap();
    assert_eq!(last.specular_normal, first.maps.specular_normal);
    // Pooled at the end only.
    let last = Maps::read(&target.join("stages/05-specular-1")).unwrap();
    assert_ne!(last.specular_albedo.unwrap(), *first.maps.specular_albedo.as_ref().unwrap());
    let channels = picture::exr_channel_names(&target.join("views/005.exr")).unwrap();
    assert_eq!(channels.len(), 9);
    let record: serde_json::Value =
        serde_json::from_slice(&std::fs::read(target.join("solve.json")).unwrap()).unwrap();
    assert_eq!(record["stages"][0]["loss"].as_array().unwrap().len(), 20);
    assert_eq!(record["config"]["seed"], 0);
}

#[test]
fn a_solve_refuses_what_it_cannot_do() {
    let folder = tempfile::tempdir().unwrap();
    let mut capture = capture(folder.path());

    let mut wild = small();
    wild.warm_up.network_rate = 1e30;
    let error = solve(&capture, &wild, &mut silent).unwrap_err().to_string();
    assert!(error.contains("stage warm-up") && error.contains("rates"), "{error}");

    let mut wrong = small();
    wrong.networks.width = 3;
    let error = solve(&capture, &wrong, &mut silent).unwrap_err();
    assert!(matches!(error, SolveError::Config(_)), "{error}");

    // Cameras that look away from the mesh.
    for view in &mut capture.train {
        view.mask.data.fill(0);
    }
    let error = solve(&capture, &small(), &mut silent).unwrap_err();
    assert!(matches!(error, SolveError::Capture(CaptureError::NothingVisible(_))), "{error}");
}

#[test]
fn the_start_that_comes_furthest_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(folder.path());
    let mut config = small();
    config.warm_up.iterations = 30;
    config.fine_tuning.iterations = 1;
    let first_loss = |config: &Config| {
        let go_on = &mut |_: &crate::Progress| ControlFlow::Continue(());
        solve(&capture, config, go_on).unwrap().record.stages[0].loss.clone()
    };
    // Each seed alone, judged by the last tenth of its losses.
    let alone: Vec<Vec<f64>> = (0..3)
        .map(|seed| {
            config.seed = seed;
            first_loss(&config)
        })
        .collect();
    let tail = |losses: &[f64]| losses[27..].iter().sum::<f64>();
    let best = alone.iter().min_by(|a, b| tail(a).total_cmp(&tail(b))).unwrap();
    config.seed = 0;
    config.initialisation.starts = 3;
    config.initialisation.start_iterations = 30;
    assert_eq!(&first_loss(&config), best);
}

#[test]
fn a_rounding_seed_moves_the_last_digits_of_every_picture_and_no_more() {
    let mut config = Config::default();
    let mesh = testing::dome(12);
    let views = views(2, 24);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    let mut targets = |seed: u64| {
        config.rendering.rounding_seed = seed;
        let space = SampleSpace::new(&mesh, &config);
        let samples = space.training(&views, &gbuffers, &config.view_weights, SIDE);
        (0..samples.len()).map(|i| samples.target.get(1, i)).collect::<Vec<f32>>()
    };
    let (given, one, other) = (targets(0), targets(1), targets(2));
    let change = |a: &f32, b: &f32| (a / b - 1.0).abs();
    assert!(given.iter().zip(&one).all(|(a, b)| change(a, b) < 1.5e-6));
    let moved = |a: &[f32], b: &[f32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(moved(&given, &one) > given.len() / 2 && moved(&one, &other) > given.len() / 2);
}
