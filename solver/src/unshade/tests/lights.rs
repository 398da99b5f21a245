//! Captures whose light moves with respect to the head, and captures of several lights.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::*;
use crate::config::PaperConfig;

const VIEWS: usize = 10;
/// From the upper right, in the frame of the light.
const KEY: Vec3 = Vec3::new(0.57, 0.46, 0.68);
/// From the left.
const SIDE: Vec3 = Vec3::new(-0.77, 0.1, 0.63);

/// A lamp's place and power, in the camera's frame.
const LAMP: Vec3 = Vec3::new(2.5, 2.0, -0.5);
const LAMP_POWER: f32 = 15.0;

/// The albedo of the dome: its regions under a gradient that a shading can look like.
fn albedo(position: Vec3) -> Vec3 {
    region(position).1 * (1.0 + 0.35 * position.x - 0.25 * position.y)
}

/// Writes a capture of the dome whose frames have a lamp of this irradiance at a point (frame, camera, point) and a
/// little light from everywhere, and opens it after an edit of its `transforms.json`.
fn lit(
    folder: &Path,
    cameras: &[capture::Camera],
    irradiance: impl Fn(usize, &capture::Camera, Vec3) -> f32,
    edit: impl FnOnce(&mut Value),
) -> Capture {
    let mesh = testing::dome(24);
    let view = |(frame, camera): (usize, &capture::Camera)| {
        let shade = |p: Vec3| (albedo(p) * (0.2 + 0.8 * irradiance(frame, camera, p)), region(p).0);
        testing::view(&mesh, camera, shade)
    };
    let views: Vec<View> = cameras.iter().enumerate().map(view).collect();
    testing::write_capture(folder, &mesh, &views, 1);
    let path = folder.join("transforms.json");
    let mut transforms = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    edit(&mut transforms);
    fs::write(&path, transforms.to_string()).unwrap();
    Capture::open(folder).unwrap()
}

fn still(folder: &Path) -> Capture {
    lit(folder, &testing::rig(VIEWS, 48), |_, _, p| p.dot(KEY).max(0.0), |_| ())
}

/// A light in the camera's frame, as a head that turns before a still camera has it.
fn turning(folder: &Path, is_stated: bool) -> Capture {
    let turned = |_: usize, camera: &capture::Camera, p: Vec3| {
        p.dot(camera.camera_to_world.transform_vector3(KEY)).max(0.0)
    };
    lit(folder, &testing::rig(VIEWS, 48), turned, |transforms| {
        if is_stated {
            transforms["light_frame"] = json!("camera");
        }
    })
}

/// A head that turns before a still camera and a lamp, around an axis at 0.6 from its centre.
fn on_a_chair(folder: &Path) -> Capture {
    let camera = |frame: usize| {
        let (sine, cosine) = (0.18 * (frame as f32 - (VIEWS as f32 - 1.0) / 2.0)).sin_cos();
        testing::camera(&format!("{frame:03}"), 3.5 * Vec3::new(sine, 0.0, cosine), 48)
    };
    let cameras: Vec<_> = (0..VIEWS).map(camera).collect();
    let lamp = |_: usize, camera: &capture::Camera, p: Vec3| {
        let towards = camera.camera_to_world.transform_point3(LAMP) - p;
        LAMP_POWER * p.dot(towards).max(0.0) / towards.length().powi(3)
    };
    lit(folder, &cameras, lamp, |transforms| transforms["light_frame"] = json!("camera"))
}

/// Two lights by turns.
fn by_turns(folder: &Path, is_stated: bool) -> Capture {
    let lights =
        |frame: usize, _: &capture::Camera, p: Vec3| p.dot([KEY, SIDE][frame % 2]).max(0.0);
    lit(folder, &testing::rig(VIEWS, 48), lights, |transforms| {
        if is_stated {
            let frames = transforms["frames"].as_array_mut().unwrap();
            let name = |frame: usize| json!(["key", "side"][frame % 2]);
            frames.iter_mut().enumerate().for_each(|(i, frame)| frame["light"] = name(i));
        }
    })
}

fn solved(capture: &Capture) -> Solution {
    let mut config = small();
    config.transport.bounces = 0;
    solve(capture, &Config::Unshade(config), &mut silent).unwrap()
}

/// The error of the albedo after one factor, dB: the mean square is that of the relative differences.
fn albedo_decibels(solution: &Solution) -> f32 {
    let found = solution.maps.diffuse_albedo.as_ref().unwrap();
    let coverage = solution.maps.coverage.as_ref().unwrap();
    let size = found.width;
    let mut pairs = vec![];
    for at in (0..size * size).filter(|at| coverage.data[*at] == 255) {
        let uv = Vec2::new((at % size) as f32 + 0.5, (at / size) as f32 + 0.5) / size as f32;
        let chart = Vec2::new(uv.x - 0.5, 0.5 - uv.y) / 0.4;
        let polar = chart.length() * 0.2f32.acos();
        let position = (chart.normalize() * polar.sin()).extend(polar.cos());
        let near = |d: Vec2| region(position + d.extend(0.0)).0 == region(position).0;
        if [Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y].iter().all(|d| near(*d * 0.08)) {
            pairs.push((Vec3::from_slice(&found.data[3 * at..]), albedo(position)));
        }
    }
    let factor = pairs.iter().map(|(found, truth)| found.dot(*truth)).sum::<f32>()
        / pairs.iter().map(|(found, _)| found.length_squared()).sum::<f32>();
    let errors = pairs.iter().flat_map(|(found, truth)| (factor * *found - *truth).to_array());
    decibels(&errors.collect::<Vec<_>>())
}

/// The error of the withheld view, dB.
fn withheld_decibels(capture: &Capture, solution: &Solution) -> f32 {
    let name = &capture.withheld[0].name;
    let read = |path: String| capture.folder.join(path);
    let truth = picture::read_exr(&read(format!("images/{name}.exr")), &["R", "G", "B"]).unwrap();
    let mask = picture::read_png_gray(&read(format!("masks/{name}.png"))).unwrap();
    let found = &solution.views[0].picture;
    let inside = (0..mask.data.len()).filter(|at| mask.data[*at] == 255);
    let errors = inside.flat_map(|at| {
        std::array::from_fn::<f32, 3, _>(|c| found.data[9 * at + c] - truth.data[3 * at + c])
    });
    decibels(&errors.collect::<Vec<_>>())
}

#[test]
fn lights_that_move_or_change_separate_albedo_from_shading() {
    let folder = tempfile::tempdir().unwrap();
    let solve = |name: &str, capture: &dyn Fn(&Path) -> Capture| {
        let capture = capture(&folder.path().join(name));
        let solution = solved(&capture);
        let view = withheld_decibels(&capture, &solution);
        (albedo_decibels(&solution), view, solution)
    };
    let (static_albedo, _, _) = solve("still", &still);
    // The least gain over the still capture, and over a solve as a still capture. Two unknown lights leave a gradient of
    // the albedo nearly as ambiguous as one, a light that turns in a known way does not.
    type Kind<'a> = (&'a str, &'a dyn Fn(&Path, bool) -> Capture, [f32; 2]);
    let kinds: [Kind; 2] = [("turning", &turning, [2.0, 3.0]), ("two", &by_turns, [0.1, 0.5])];
    for (name, capture, [gain, gain_over_wrong]) in kinds {
        let (albedo, view, solution) = solve(name, &|folder| capture(folder, true));
        let (wrong, wrong_view, _) =
            solve(&format!("{name} as still"), &|folder| capture(folder, false));
        let shown = format!(
            "{name}: {albedo} dB, still {static_albedo} dB, solved as still {wrong} dB; views \
             {view}, {wrong_view} dB"
        );
        assert!(albedo > static_albedo + gain, "{shown}");
        assert!(albedo > wrong + gain_over_wrong, "{shown}");
        assert!(view > wrong_view + 6.0, "{shown}");
        assert_eq!(solution.lights.len(), if name == "two" { 2 } else { 1 });
    }
}

#[test]
fn the_distance_of_a_light_that_moves_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let capture = on_a_chair(&folder.path().join("chair"));
    let solution = solved(&capture);
    let distances = capture.train.iter().map(|view| {
        let lamp = view.camera.camera_to_world.transform_point3(LAMP);
        lamp.distance(Vec3::new(0.0, 0.0, 0.6))
    });
    let mean = distances.sum::<f32>() / capture.train.len() as f32;
    let found = solution.record.light_distance.unwrap_or(f32::INFINITY);
    assert!((found / mean).ln().abs() < 0.2, "{found} for {mean}");
}

#[test]
fn every_light_is_written_and_its_frame_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let config = Config::Unshade(super::interrupts::short());
    let written = |name: &str, capture: Capture| -> (Vec<String>, Value) {
        let maps = folder.path().join(name);
        solve(&capture, &config, &mut silent).unwrap().write(&maps).unwrap();
        let lights = ["light.exr", "light/key.exr", "light/side.exr"];
        let found = lights.iter().filter(|light| maps.join(light).is_file());
        let record = serde_json::from_slice(&fs::read(maps.join("solve.json")).unwrap()).unwrap();
        (found.map(|light| (*light).to_owned()).collect(), record)
    };
    let at = |name: &str| folder.path().join(format!("{name}-capture"));
    let (files, record) = written("still", still(&at("still")));
    assert_eq!(files, ["light.exr"]);
    assert!(record.get("light_frame").is_none() && record.get("lights").is_none());
    let (files, record) = written("turning", turning(&at("turning"), true));
    assert_eq!((files, &record["light_frame"]), (vec!["light.exr".to_owned()], &json!("camera")));
    let (files, record) = written("two", by_turns(&at("two"), true));
    assert_eq!(files, ["light/key.exr", "light/side.exr"]);
    assert_eq!(record["lights"], json!(["key", "side"]));
}

#[test]
fn the_published_method_refuses_lights_that_move_or_change() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |capture: &Capture| {
        let config = Config::Paper(PaperConfig::default());
        solve(capture, &config, &mut silent).unwrap_err().to_string()
    };
    let message = refused(&turning(&folder.path().join("turning"), true));
    assert!(message.contains("light_frame in transforms.json") && message.contains("unshade"));
    let message = refused(&by_turns(&folder.path().join("two"), true));
    assert!(message.contains("several lights") && message.contains("paper"), "{message}");
}

/// Central differences of the loss in a scene without residuals near the kink of |x|.
#[test]
fn gradients_reach_the_lights_of_all_groups() {
    const SIDE: usize = 16;
    let folder = tempfile::tempdir().unwrap();
    let frames = by_turns(folder.path(), true);
    let mut config = UnshadeConfig::default();
    config.transport.texture_size = SIDE;
    config.transport.rows = 4;
    let turned = turning(&folder.path().join("turning"), true);
    for lights in [&frames.lights, &turned.lights] {
        let gbuffers = GBuffer::of_views(&frames.mesh, &frames.train);
        let space = SampleSpace::default();
        let mut samples = space.training(&frames.train, &gbuffers, None, SIDE);
        samples.target = crate::model::planes::Planes::new(3, samples.len());
        let transport =
            Transport::with_nearness(&frames.mesh, &Sky::lat_long(4), &config.transport, 0);
        let illuminations =
            Illuminations::new(lights, VIEWS - 1, 4, transport.centre()).around(&transport);
        let cells = illuminations.groups() * 3 * transport.cells();
        let light: Vec<f32> = (0..cells).map(|i| (i as f32 * 0.37).sin()).collect();
        let albedo: Vec<f32> =
            (0..3 * SIDE * SIDE).map(|i| 0.1 + 0.8 * (i as f32 * 12.9898).sin().abs()).collect();
        let terms = crate::transport::SpecularTerm::usual(0.2).channels().repeat(SIDE * SIDE);
        let radiance = explicit::exp(&light);
        let model = explicit::ExplicitModel::new(
            &config,
            &transport,
            &illuminations,
            &samples,
            &terms,
            &radiance,
            0.1,
        );
        let model = model.with_grey_prior(true);
        let found = model.gradient(&light, 0.4, &albedo);
        let largest = found.by_log_light.iter().fold(0.0f32, |m, g| m.max(g.abs()));
        let strong = (0..cells).filter(|at| found.by_log_light[*at].abs() > 0.3 * largest);
        for at in strong.step_by(5) {
            let loss = |step: f32| {
                let mut moved = light.clone();
                moved[at] += step;
                model.gradient(&moved, 0.4, &albedo).loss
            };
            let expected = (loss(3e-3) - loss(-3e-3)) / 6e-3;
            let error = (f64::from(found.by_log_light[at]) - expected).abs();
            assert!(error < 0.015 * f64::from(largest), "{at}: {expected}");
        }
        let step = |step: f32| model.gradient(&light, 0.4 + step, &albedo).loss;
        let expected = (step(1e-2) - step(-1e-2)) / 2e-2;
        let error = (f64::from(found.by_relative_nearness) - expected).abs();
        assert!(error < 0.015 * expected.abs().max(1e-3), "{expected}");
    }
}
