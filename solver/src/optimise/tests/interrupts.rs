//! Interrupts: what is written then, and that a solve goes on to the same bytes.

use std::fs;
use std::path::Path;
use std::time::Duration;

use super::*;
use crate::optimise::checkpoint::Checkpoint;
use crate::optimise::progress::Options;
use crate::optimise::solve::{solve_into, solve_on};

/// Every stage of a solve, in seconds.
fn short() -> Config {
    let mut config = small();
    config.initialisation.starts = 2;
    config.initialisation.start_iterations = 8;
    config.warm_up.iterations = 20;
    config.fine_tuning.iterations = 6;
    config.transport.probe = 10;
    config.transport.iterations = 16;
    config.transport.albedo_frozen_steps = 6;
    config.transport.distance = 24;
    config.transport.highlights = 5;
    config.transport.refinement = 6;
    config.height.steps = 32;
    config
}

/// Name of the checkpoint's owner in these tests.
const PROGRAM: &str = "tests";

/// All files below a folder with their bytes, without wall times.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).unwrap() {
        let (path, name) = entry.map(|e| (e.path(), e.file_name())).unwrap();
        let name = name.to_string_lossy().into_owned();
        if path.is_dir() {
            let inner = files(&path).into_iter();
            found.extend(inner.map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if name != "timing.json" {
            found.push((name, fs::read(path).unwrap()));
        }
    }
    found.sort();
    found
}

fn stop_at(step: usize) -> impl FnMut(&crate::Progress) -> ControlFlow<()> {
    move |progress| match progress.iteration == step {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

/// The steps: two starts of 8, warm-up of 20 with the best one's, light of 10, its distance
/// of 24, transport of 16, highlights of 5, heights of 8, specular of 6, diffuse of 6, albedo of 6.
const CUTS: [(usize, &str); 14] = [
    (1, "start 1 at step 1 of 8"),
    (11, "start 2 at step 3 of 8"),
    (16, "start 2 at step 8 of 8"),
    (22, "warm-up at step 6 of 12"),
    (28, "warm-up at step 12 of 12"),
    (31, "light at step 3 of 10"),
    (61, "distance 2 at step 11 of 12"),
    (65, "transport at step 3 of 16"),
    (73, "transport at step 11 of 16"),
    (81, "highlights at step 3 of 5"),
    (86, "heights at step 3 of 8"),
    (94, "specular 1 at step 3 of 6"),
    (101, "diffuse 1 at step 4 of 6"),
    (108, "albedo at step 5 of 6"),
];

#[test]
fn an_interrupt_leaves_valid_maps_and_the_solve_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let (whole, maps) = (folder.path().join("whole"), folder.path().join("maps"));
    let checkpoint = folder.path().join("maps.checkpoint");
    let config = short();
    let mut heard = vec![];
    let solution = solve_into(&Cpu::new(), &whole, PROGRAM, &capture, &config, &mut |progress| {
        assert!(progress.step <= progress.steps);
        assert!(progress.seconds_left.is_finite() && progress.seconds_left >= 0.0);
        heard.push((progress.iteration, progress.total));
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_eq!(solution.record.interrupted, None);
    assert_eq!(heard, (1..=109).map(|step| (step, 109)).collect::<Vec<_>>());
    assert!(!folder.path().join("whole.checkpoint").exists());
    layers_show_the_pictures(&whole, &capture);

    for (step, place) in CUTS {
        let solution =
            solve_into(&Cpu::new(), &maps, PROGRAM, &capture, &config, &mut stop_at(step)).unwrap();
        assert_eq!(solution.record.interrupted.as_deref(), Some(place));
        assert!(checkpoint.is_dir(), "{place}");
        let written = Maps::read(&maps).unwrap();
        let albedo = written.diffuse_albedo.unwrap();
        assert!(albedo.data.iter().all(|value| (0.0..5.0).contains(value)), "{place}");
        assert!(albedo.data.iter().any(|value| *value > 0.05), "{place}");
        for normal in written.specular_normal.unwrap().data.chunks_exact(3) {
            assert!((Vec3::from_slice(normal).length() - 1.0).abs() < 1e-4, "{place}");
        }
        let record: serde_json::Value =
            serde_json::from_slice(&fs::read(maps.join("solve.json")).unwrap()).unwrap();
        assert_eq!(record["interrupted"], place);

        let mut first = None;
        solve_into(&Cpu::new(), &maps, PROGRAM, &capture, &config, &mut |progress| {
            first.get_or_insert(progress.iteration);
            ControlFlow::Continue(())
        })
        .unwrap();
        // The height solve begins anew, everything else at the next step.
        let expected = if place.starts_with("heights") { 84 } else { step + 1 };
        assert_eq!(first, Some(expected), "{place}");
        assert!(files(&maps) == files(&whole), "{place}: other bytes");
        assert!(!checkpoint.exists(), "{place}");
    }
}

/// The layers of the training views add up, and show what was photographed.
fn layers_show_the_pictures(maps: &Path, capture: &Capture) {
    for view in &capture.train {
        let file = maps.join("layers").join(format!("{}.exr", view.camera.name));
        let layers = picture::read_exr(&file, &crate::ViewLayers::CHANNELS).unwrap();
        let (mut error, mut energy) = (0.0, 0.0);
        for at in (0..view.mask.data.len()).filter(|at| view.mask.data[*at] == 255) {
            let pixel = &layers.data[9 * at..][..9];
            for channel in 0..3 {
                // Halves have 11 bits.
                let sum = pixel[3 + channel] + pixel[6 + channel];
                assert!((pixel[channel] - sum).abs() < 2e-3 * pixel[channel].max(0.1));
                let truth = view.image.data[3 * at + channel];
                error += (pixel[channel] - truth).powi(2);
                energy += truth.powi(2);
            }
        }
        // A solve this short is far off; pixels in wrong places would be further.
        assert!(error < 0.3 * energy, "{}: {error} of {energy}", view.camera.name);
    }
    assert_eq!(fs::read_dir(maps.join("layers")).unwrap().count(), capture.train.len());
}

/// A process that is killed leaves the last checkpoint of its stage, not one of its last step.
#[test]
fn a_killed_solve_goes_on_from_the_last_checkpoint_of_its_stage() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let config = short();
    let (maps, killed) = (folder.path().join("maps"), folder.path().join("killed"));
    let options = |maps: &Path| {
        let checkpoint = Checkpoint::beside(maps, PROGRAM).every(Duration::ZERO);
        Options { checkpoint: Some(checkpoint), ..Options::default() }
    };
    let backend = Cpu::new();
    // What lies there when step 66 has been reported is what a kill would have left.
    let from = Checkpoint::beside(&maps, PROGRAM);
    let to = Checkpoint::beside(&killed, PROGRAM);
    let whole = solve_on(&backend, &capture, &config, options(&maps), &mut |progress| {
        if progress.iteration == 66 {
            fs::create_dir(to.folder()).unwrap();
            for entry in fs::read_dir(from.folder()).unwrap() {
                let entry = entry.unwrap();
                fs::copy(entry.path(), to.folder().join(entry.file_name())).unwrap();
            }
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    let mut first = None;
    let resumed = solve_on(&backend, &capture, &config, options(&killed), &mut |progress| {
        first.get_or_insert((progress.stage.to_owned(), progress.iteration));
        ControlFlow::Continue(())
    })
    .unwrap();
    let (stage, step) = first.unwrap();
    // The checkpoint of step 66 is written after it was reported.
    assert_eq!((stage.as_str(), step), ("transport", 66));
    assert!(resumed.maps == whole.maps && resumed.views == whole.views);
    assert_eq!(resumed.record, whole.record);
}

#[test]
fn a_checkpoint_of_another_solve_is_not_used() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let maps = folder.path().join("maps");
    let checkpoint = folder.path().join("maps.checkpoint");
    let begun_at = |program: &str, config: &Config| {
        let mut first = 0;
        solve_into(&Cpu::new(), &maps, program, &capture, config, &mut |progress| {
            first = progress.iteration;
            ControlFlow::Break(())
        })
        .unwrap();
        first
    };
    let config = short();
    assert_eq!(begun_at(PROGRAM, &config), 1);
    assert_eq!(begun_at(PROGRAM, &config), 2, "the same solve goes on");
    let other = Config { seed: 7, ..config.clone() };
    assert_eq!(begun_at(PROGRAM, &other), 1, "another configuration");
    assert_eq!(begun_at("another", &other), 1, "another program");
    assert_eq!(begun_at("another", &other), 2);
    // Half a file, as after a full disk.
    let path = checkpoint.join("solve.postcard");
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert_eq!(begun_at("another", &other), 1, "a damaged checkpoint");
    let path = checkpoint.join("stage.postcard");
    fs::write(&path, b"not a checkpoint").unwrap();
    assert_eq!(begun_at("another", &other), 1, "a damaged stage");
}

/// Nothing is known of hair apart from skin: the networks keep the highlights.
#[test]
fn where_the_face_is_one_region_the_steps_with_highlights_are_spared() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = testing::dome(24);
    let grey = |position: Vec3| (Vec3::splat(0.2 + 0.1 * position.z), 0);
    let views: Vec<_> =
        testing::rig(6, 48).iter().map(|camera| testing::view(&mesh, camera, grey)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    let capture = Capture::open(folder.path()).unwrap();
    let mut heard = vec![];
    let mut config = short();
    config.colour_regions.count = 0;
    let solution = solve(&capture, &config, &mut |progress| {
        heard.push((progress.iteration, progress.total));
        ControlFlow::Continue(())
    });
    let total = |step| match step {
        ..=38 => 109,
        39..=54 => 85,
        _ => 80,
    };
    assert_eq!(heard, (1..=80).map(|step| (step, total(step))).collect::<Vec<_>>());
    let stages = solution.unwrap().record.stages;
    assert_eq!(stages.iter().filter(|stage| stage.name == "highlights").count(), 0);
}
