use std::fs;
use std::ops::ControlFlow;

use serde_json::{Value, json};

use super::*;
use crate::{Config, test_scene, testing};

/// Gains of five training views and a withheld one, with a mean logarithm of 0 over the five.
const STOPS: [[f32; 3]; 5] =
    [[0.5, 0.3, 0.1], [-0.4, 0.0, 0.3], [0.0, -0.6, -0.5], [-0.3, 0.1, 0.0], [0.2, 0.2, 0.1]];

fn edited(
    edit: impl FnOnce(&mut Value),
    withheld: usize,
) -> Result<Capture, capture::CaptureError> {
    let folder = tempfile::tempdir().unwrap();
    let mut views = test_scene::views(6, 48);
    for (view, stops) in views.iter_mut().zip(STOPS) {
        for pixel in view.image.data.chunks_exact_mut(3) {
            pixel.iter_mut().zip(stops).for_each(|(value, stops)| *value *= stops.exp2());
        }
    }
    testing::write_capture(folder.path(), &testing::dome(24), &views, withheld);
    let path = folder.path().join("transforms.json");
    let mut document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    edit(&mut document);
    fs::write(&path, document.to_string()).unwrap();
    Capture::open(folder.path())
}

fn unknown(document: &mut Value) {
    document["exposure"] = json!("unknown");
}

#[test]
fn gains_of_a_matte_surface_are_found_and_divided_out() {
    let capture = edited(unknown, 1).unwrap();
    let (even, gains) = evened(&capture).unwrap();
    for ((view, (name, gain)), stops) in capture.train.iter().zip(&gains).zip(STOPS) {
        assert_eq!(name, &view.camera.name);
        for (gain, stops) in gain.iter().zip(stops) {
            assert!((gain.log2() - stops).abs() < 0.01, "{name}: {gain} {stops}");
        }
    }
    let plain = test_scene::views(6, 48);
    for (view, plain) in even.train.iter().zip(&plain) {
        for (even, plain) in view.image.data.iter().zip(&plain.image.data) {
            assert!((even - plain).abs() <= 0.01 * plain, "{even} {plain}");
        }
    }
}

#[test]
fn known_exposures_change_nothing() {
    let capture = edited(|document| document["exposure"] = json!("known"), 1).unwrap();
    let (even, gains) = evened(&capture).unwrap();
    assert!(gains.is_empty() && matches!(even, Cow::Borrowed(_)));
}

#[test]
fn a_view_without_common_surface_is_named() {
    let mut capture = edited(unknown, 1).unwrap();
    capture.train[3].mask.data.fill(0);
    let error = evened(&capture).unwrap_err().to_string();
    assert!(error.contains("view 003") && error.contains("leave it out"), "{error}");
}

#[test]
fn a_moving_light_of_unknown_exposure_is_refused() {
    let moving = |document: &mut Value| {
        unknown(document);
        document["light_frame"] = json!("camera");
    };
    let error = edited(moving, 1).unwrap_err().to_string();
    assert!(error.contains("exposure is \"unknown\", but the light moves"), "{error}");
    let error = edited(|document| document["exposure"] = json!(2), 1).unwrap_err().to_string();
    assert!(error.contains("exposure is 2; write"), "{error}");
}

/// A resumed solve would continue a fit under other gains.
#[test]
fn an_interrupt_while_gains_are_estimated_leaves_no_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let maps = folder.path().join("maps");
    let (capture, known) =
        [unknown, |_: &mut Value| ()].map(|edit| edited(edit, 1).unwrap()).into();
    for (capture, has_checkpoint) in [(capture, false), (known, true)] {
        let backend = crate::Choice::Cpu.open().unwrap();
        let config = Config::preset("fast").unwrap();
        let stop = &mut |_: &crate::Progress| ControlFlow::Break(());
        let solution =
            crate::solve_into(&*backend, &maps, "tests", &capture, &config, stop).unwrap();
        assert!(solution.record.interrupted.is_some());
        assert_eq!(folder.path().join("maps.checkpoint").exists(), has_checkpoint);
    }
}
