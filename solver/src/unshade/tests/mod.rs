//! Whole solves of a small scene with a known solution, and the parts of the default method.

mod confidence;
mod height_solve;
mod highlights;
mod interrupts;
mod known;
mod lights;
mod recolour;

use std::ops::ControlFlow;

use capture::gbuffer::GBuffer;
use capture::{Capture, CaptureError, View};
use formats::maps::Maps;
use formats::picture::{self, Picture};
use glam::{Vec2, Vec3};

use super::*;
use crate::backend::cpu::Cpu;
use crate::model::samples::Samples;
use crate::run::progress::Options;
use crate::solve::{solve_into, solve_on};
use crate::test_scene::{capture, region, silent, solve, views};
use crate::testing;
use crate::{Config, Solution};

fn small() -> UnshadeConfig {
    match Config::from_toml(include_str!("../../../tests/small.toml")).unwrap() {
        Config::Unshade(config) => config,
        Config::Paper(_) => unreachable!("the file configures the default method"),
    }
}

/// Samples of two small views.
fn samples(size: usize) -> Samples {
    let mesh = testing::dome(12);
    let views = views(2, 24);
    let gbuffers = GBuffer::of_views(&mesh, &views);
    SampleSpace::default().training(&views, &gbuffers, None, size)
}

/// Mean squared error to decibels.
fn decibels(errors: &[f32]) -> f32 {
    -10.0 * (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).log10()
}

#[test]
fn larger_pictures_are_halved_to_as_many_pixels() {
    let halvings =
        [1, 267_565, 4 * 267_565, 16 * 267_565].map(|pixels| light_halvings(pixels, 40_000));
    assert_eq!(halvings, [1, 1, 2, 3]);
}

#[test]
fn a_known_scene_is_recovered_and_its_withheld_view_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let solution = solve(&capture(folder.path()), &Config::Unshade(small()), &mut silent).unwrap();

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
        // Edges of regions are limited by the views' resolution, and left out.
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

/// The bytes are equal for any number of threads, without `truth`, and the folder has no other files.
#[test]
fn solutions_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    assert!(!folder.path().join("capture/truth").exists());
    let config = Config::Unshade(super::tests::interrupts::short());
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
        "diffuse_albedo_std.exr",
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
    assert_eq!(stages, ["01-joint", "02-relief", "03-albedo"]);
    // The last stage of a map has the final map, since nothing is resampled here.
    let last = Maps::read(&target.join("stages/03-albedo")).unwrap();
    assert_eq!(last.diffuse_albedo, first.maps.diffuse_albedo);
    assert!(last.specular_normal.is_none());
    let last = Maps::read(&target.join("stages/02-relief")).unwrap();
    assert_eq!(last.specular_normal, first.maps.specular_normal);
    let channels = picture::exr_channel_names(&target.join("views/005.exr")).unwrap();
    assert_eq!(channels.len(), 9);
    let record: serde_json::Value =
        serde_json::from_slice(&std::fs::read(target.join("solve.json")).unwrap()).unwrap();
    assert_eq!(record["stages"][0]["name"], "light 1");
    assert_eq!(record["config"]["seed"], 0);
}

/// Pictures and the reflectance of skin are the only absolute levels: a factor of four on both multiplies the albedos
/// by four, to the bit, and changes nothing else.
#[test]
fn albedo_is_proportional_to_exposure_and_reflectance_of_skin() {
    let maps = |factor: f32| -> Maps {
        let folder = tempfile::tempdir().unwrap();
        let mut views = views(6, 32);
        for view in &mut views {
            view.image.data.iter_mut().for_each(|value| *value *= factor);
        }
        testing::write_capture(folder.path(), &testing::dome(24), &views, 1);
        let capture = Capture::open(folder.path()).unwrap();
        let mut config = interrupts::short();
        // Its thresholds are on logarithms of the pictures, which round differently.
        config.regions.hair_in_skin = false;
        config.skin.reflectance *= factor;
        solve(&capture, &Config::Unshade(config), &mut silent).unwrap().maps
    };
    let [once, brighter] = [1.0, 4.0].map(maps);
    let fourfold = |picture: &Option<Picture>| -> Vec<f32> {
        picture.as_ref().unwrap().data.iter().map(|value| 4.0 * value).collect()
    };
    assert!(fourfold(&once.diffuse_albedo).iter().any(|value| *value > 0.5));
    assert_eq!(brighter.diffuse_albedo.unwrap().data, fourfold(&once.diffuse_albedo));
    assert_eq!(brighter.specular_albedo.unwrap().data, fourfold(&once.specular_albedo));
    assert_eq!(brighter.diffuse_normal, once.diffuse_normal);
    assert_eq!(brighter.specular_normal, once.specular_normal);
    assert_eq!(brighter.roughness, once.roughness);
    assert_eq!(brighter.confidence, once.confidence);
}

#[test]
fn a_solve_without_visible_mesh_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut capture = capture(folder.path());
    // Cameras that look away from the mesh.
    for view in &mut capture.train {
        view.mask.data.fill(0);
    }
    let error = solve(&capture, &Config::Unshade(small()), &mut silent).unwrap_err();
    assert!(matches!(error, SolveError::Capture(CaptureError::NothingVisible(_))), "{error}");
}
