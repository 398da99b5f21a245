//! Readers on changed files: no panic, no abort, no hang over 5 s, no more than 2 GB.
//!
//! `make fuzz` is the same for a night. Inputs are the same for the same `UNSHADE_FUZZ_SEED`; one
//! that fails is written to `target/tmp`. `UNSHADE_FUZZ_INPUTS` is their number per reader.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod guard;
mod mutate;
mod pictures;
mod texts;

use std::path::Path;

use capture::outward::outward;
use capture::{Capture, Mesh};
use formats::picture::{Content, ExrFile, Picture, Png, read_radiance_bytes};
use glam::Vec3;
use harness::suite::{Scene, Suite};
use mutate::{Mutator, repair_png};
use scoring::compare::{Baseline, Tolerances, compare};
use scoring::score::Scores;

use guard::{Counting, REFUSED, fuzz};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const BINARY: Mutator = Mutator { words: "", repair: None };

/// Name of the file in messages.
fn name() -> &'static Path {
    Path::new("file")
}

/// Outcome of a reader: its message, which is one line, or its result.
fn met<T, E: std::fmt::Display>(result: Result<T, E>, shown: impl Fn(T) -> String) -> String {
    match result {
        Ok(value) => shown(value),
        Err(error) => {
            let text = error.to_string();
            assert!(!text.is_empty() && !text.contains('\n'), "not one line: {text}");
            format!("{REFUSED}{text}")
        }
    }
}

fn shape(picture: &Picture) -> String {
    let Picture { width, height, channels, data } = picture;
    assert_eq!(data.len(), width * height * channels);
    let finite = picture.require_finite(name(), &[]).is_ok();
    format!("{channels} channels, finite: {finite}")
}

#[test]
fn exr() {
    fuzz("exr", pictures::exr(), BINARY, |bytes| {
        met(ExrFile::from_bytes(name(), bytes.to_vec()), |file| {
            let names = file.channel_names();
            let few: Vec<&str> = names.iter().take(5).map(String::as_str).collect();
            let data = met(file.read(&few, Content::Data), |picture| shape(&picture));
            let rgb = file.read(&["R", "G", "B"], Content::Colour);
            format!("{}{data}{}", file.is_cube_map(), met(rgb, |picture| shape(&picture)))
        })
    });
}

#[test]
fn radiance() {
    fuzz("radiance", pictures::radiance(), BINARY, |bytes| {
        met(read_radiance_bytes(name(), bytes), |picture| shape(&picture))
    });
}

#[test]
fn png() {
    let mutator = Mutator { repair: Some(repair_png), ..BINARY };
    fuzz("png", pictures::png(), mutator, |bytes| {
        met(Png::from_bytes(name(), bytes), |png| {
            assert_eq!(png.samples.len(), png.width * png.height * png.channels);
            let kind = format!("{:?} {}", png.colour, png.bits);
            let picture = met(png.picture(name()), |picture| shape(&picture));
            format!("{kind}{picture}{}", met(png.ids(name()), |ids| ids.bits.to_string()))
        })
    });
}

#[test]
fn obj() {
    let mutator = Mutator { words: texts::OBJ, repair: None };
    fuzz("obj", texts::obj(), mutator, |bytes| {
        met(Mesh::from_bytes(name(), bytes), |mesh| {
            let count = mesh.positions.len();
            assert_eq!((mesh.normals.len(), mesh.uvs.len()), (count, count));
            assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < count));
            let unit = |normal: &Vec3| (normal.length() - 1.0).abs() < 1e-3;
            assert!(mesh.normals.iter().all(unit), "a normal is not of length 1");
            let oriented = outward(&mesh.positions, Some(&mesh.normals), &mesh.triangles);
            format!("{} triangles {}", mesh.triangles.len(), oriented.triangles.len())
        })
    });
}

#[test]
fn transforms() {
    let mutator = Mutator { words: texts::JSON, repair: None };
    fuzz("transforms.json", texts::transforms(), mutator, |bytes| {
        met(Capture::cameras(Path::new("capture"), bytes), |cameras| {
            for camera in &cameras {
                let sides = [camera.width, camera.height];
                assert!(sides.iter().all(|side| (1..65536).contains(side)), "{sides:?}");
                assert!(camera.camera_to_world.is_finite());
            }
            format!("cameras{}", "*".repeat(cameras.len().min(9)))
        })
    });
}

#[test]
fn suite() {
    // Where there is memory for files, no disk has to keep up.
    let shared = Path::new("/dev/shm");
    let folder = if shared.is_dir() { tempfile::tempdir_in(shared) } else { tempfile::tempdir() };
    let folder = folder.unwrap();
    let mutator = Mutator { words: texts::TOML, repair: None };
    let path = folder.path().join("suite.toml");
    fuzz("suite.toml", texts::suites(folder.path()), mutator, |bytes| {
        std::fs::write(&path, bytes).unwrap();
        let scene = met(Scene::open(&path), |scene| {
            let text = scene.to_toml().unwrap();
            let again = Scene { table: text.parse().unwrap() };
            assert_eq!(again.to_toml().unwrap(), text);
            format!("scene {}", scene.files().len())
        });
        let suite = met(Suite::open(&path), |suite| {
            let kinds: Vec<_> = suite.methods.iter().map(|method| method.role().name()).collect();
            format!("suite {} {}", "*".repeat(suite.cases.len().min(9)), kinds.join(" "))
        });
        // Messages begin with the file's path.
        format!("{suite}{scene}").replace(&path.display().to_string(), "")
    });
}

#[test]
fn scores() {
    let mutator = Mutator { words: texts::JSON, repair: None };
    fuzz("scores.json", texts::scores(), mutator, |bytes| {
        met(Scores::from_bytes(name(), bytes), |scores| {
            let text = serde_json::to_vec(&scores).unwrap();
            let again = Scores::from_bytes(name(), &text).unwrap();
            assert_eq!(again, scores);
            let mut baseline = Baseline::new("tiny");
            baseline.add("a/b", &scores);
            let found = scores.rows.iter().all(|row| scores.row(&row.id()).is_some());
            assert!(found && baseline.rows.len() <= scores.rows.len());
            format!("{} rows", "*".repeat(baseline.rows.len().min(9)))
        })
    });
}

#[test]
fn baseline() {
    let mutator = Mutator { words: texts::JSON, repair: None };
    let seeds = texts::baselines();
    let sound = Baseline::from_bytes(name(), &seeds[0]).unwrap();
    let tolerances = Tolerances::built_in().unwrap();
    fuzz("baseline.json", seeds, mutator, |bytes| {
        met(Baseline::from_bytes(name(), bytes), |baseline| {
            let pairs = [(&baseline, &sound), (&sound, &baseline), (&baseline, &baseline)];
            let verdicts = pairs.map(|(current, old)| {
                met(compare(current, old, &tolerances), |comparison| format!("{comparison:?}"))
            });
            format!("compared {}", verdicts.concat())
        })
    });
}
