//! Interrupted solves write maps, and continue to the same bytes.

use std::fs;
use std::path::Path;
use std::time::Duration;

use super::*;
use crate::run::checkpoint::Checkpoint;

/// A solve with all stages in seconds.
pub fn short() -> UnshadeConfig {
    let mut config = small();
    config.light.steps = 24;
    config.joint.grey_steps = 16;
    config.joint.steps = 5;
    config.relief.steps = 4;
    config.albedo.steps = 6;
    config
}

/// The program of the checkpoints in these tests.
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

/// The steps: light of 12 and 12, joint of 16 and 5, relief of 8, albedo of 6.
const CUTS: [(usize, &str); 9] = [
    (1, "light 1 at step 1 of 12"),
    (12, "light 1 at step 12 of 12"),
    (23, "light 2 at step 11 of 12"),
    (27, "joint, grey light at step 3 of 16"),
    (40, "joint, grey light at step 16 of 16"),
    (43, "joint at step 3 of 5"),
    (48, "relief at step 3 of 8"),
    (58, "albedo at step 5 of 6"),
    (59, "albedo at step 6 of 6"),
];
/// Steps of the whole solve.
const STEPS: usize = 59;

#[test]
fn resume_after_an_interrupt_gives_identical_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let (whole, maps) = (folder.path().join("whole"), folder.path().join("maps"));
    let checkpoint = folder.path().join("maps.checkpoint");
    let config = Config::Unshade(short());
    let mut heard = vec![];
    let solution = solve_into(&Cpu::new(), &whole, PROGRAM, &capture, &config, &mut |progress| {
        assert!(progress.step <= progress.steps);
        assert!(progress.seconds_left.is_finite() && progress.seconds_left >= 0.0);
        heard.push((progress.iteration, progress.total));
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_eq!(solution.record.interrupted, None);
    assert_eq!(heard, (1..=STEPS).map(|step| (step, STEPS)).collect::<Vec<_>>());
    assert!(!folder.path().join("whole.checkpoint").exists());
    layers_show_the_pictures(&whole, &capture);

    // Every run continues the previous one and is interrupted as well.
    let mut first = 1;
    for (step, place) in CUTS {
        let mut begun = None;
        let solution =
            solve_into(&Cpu::new(), &maps, PROGRAM, &capture, &config, &mut |progress| {
                begun.get_or_insert(progress.iteration);
                stop_at(step)(progress)
            });
        assert_eq!(begun, Some(first), "{place}");
        assert_eq!(solution.unwrap().record.interrupted.as_deref(), Some(place));
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
        // The relief restarts; all other stages continue with the next step.
        first = if place.starts_with("relief") { 46 } else { step + 1 };
    }
    solve_into(&Cpu::new(), &maps, PROGRAM, &capture, &config, &mut |progress| {
        panic!("a step after the last: {progress:?}")
    })
    .unwrap();
    assert!(files(&maps) == files(&whole), "other bytes");
    assert!(!checkpoint.exists());
}

/// The layers of the training views sum to the pictures.
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
        // The error of such a short solve is large; that of misplaced pixels is larger.
        assert!(error < 0.3 * energy, "{}: {error} of {energy}", view.camera.name);
    }
    assert_eq!(fs::read_dir(maps.join("layers")).unwrap().count(), capture.train.len());
}

/// A killed process leaves the last periodic checkpoint, not one of its last step.
#[test]
fn resume_after_a_kill_continues_the_fit() {
    let folder = tempfile::tempdir().unwrap();
    let capture = capture(&folder.path().join("capture"));
    let config = Config::Unshade(short());
    let (maps, killed) = (folder.path().join("maps"), folder.path().join("killed"));
    let options = |maps: &Path| {
        let checkpoint = Checkpoint::beside(maps, PROGRAM).every(Duration::ZERO);
        Options { checkpoint: Some(checkpoint), ..Options::default() }
    };
    let backend = Cpu::new();
    // The files at the report of step 27 are those that a kill would have left.
    let from = Checkpoint::beside(&maps, PROGRAM);
    let to = Checkpoint::beside(&killed, PROGRAM);
    let whole = solve_on(&backend, &capture, &config, options(&maps), &mut |progress| {
        if progress.iteration == 27 {
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
    // The checkpoint of step 27 is written after it was reported.
    assert_eq!((stage.as_str(), step), ("joint, grey light", 27));
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
    let config = Config::Unshade(short());
    assert_eq!(begun_at(PROGRAM, &config), 1);
    assert_eq!(begun_at(PROGRAM, &config), 2, "the same solve goes on");
    let other = Config::Unshade(UnshadeConfig { seed: 7, ..short() });
    assert_eq!(begun_at(PROGRAM, &other), 1, "another configuration");
    assert_eq!(begun_at("another", &other), 1, "another program");
    assert_eq!(begun_at("another", &other), 2);
    // A truncated file, as after a full disk.
    let path = checkpoint.join("fit.postcard");
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert_eq!(begun_at("another", &other), 1, "a damaged checkpoint");
}

/// A face without colours or labels is one region, which is skin.
#[test]
fn a_face_of_one_region_is_solved() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = testing::dome(24);
    let grey = |position: Vec3| (Vec3::splat(0.2 + 0.1 * position.z), 0);
    let views: Vec<_> =
        testing::rig(6, 48).iter().map(|camera| testing::view(&mesh, camera, grey)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    let capture = Capture::open(folder.path()).unwrap();
    let solution = solve(&capture, &Config::Unshade(short()), &mut silent).unwrap();
    let albedo = solution.maps.diffuse_albedo.unwrap();
    assert!(albedo.data.iter().all(|value| (0.0..2.0).contains(value)));
}
