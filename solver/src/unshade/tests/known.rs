//! Solves that hold parts at their truth.

use capture::TruthPart;
use capture::gbuffer::Atlas;

use super::*;
use crate::transport::CHANNELS;

/// Side of the true maps, texels.
const SIDE: usize = 64;

/// A true map by the position on the dome.
fn map(channels: usize, value: impl Fn(Vec3) -> Vec<f32>) -> Picture {
    let atlas = Atlas::new(&testing::dome(24), SIDE);
    let data = atlas.positions.iter().flat_map(|position| value(*position)).collect();
    Picture { width: SIDE, height: SIDE, channels, data }
}

/// Normals of a dome that is bent along x.
fn bent(position: Vec3) -> Vec3 {
    (position + 0.2 * (4.0 * position.x).sin() * Vec3::X).normalize()
}

/// The capture of the dome with a truth folder.
fn with_truth(folder: &std::path::Path) -> Capture {
    let capture = capture(folder);
    let truth = folder.join("truth");
    std::fs::create_dir(&truth).unwrap();
    // Brighter above than below.
    let mut light = Picture::new(32, 17, 3);
    for y in 0..17 {
        (0..32).for_each(|x| light.pixel_mut(x, y).fill(1.5 - y as f32 / 16.0));
    }
    picture::write_exr_rgb(&truth.join("light.exr"), &light).unwrap();
    std::fs::write(truth.join("scene.toml"), "[light]\nkind = \"dome\"\n").unwrap();
    let specular = map(1, |p| vec![0.03 + 0.01 * p.x]);
    picture::write_exr(&truth.join("specular_albedo.exr"), &specular, &["Y"]).unwrap();
    let normals = map(3, |p| bent(p).to_array().to_vec());
    for name in ["specular_normal.exr", "diffuse_normal.exr"] {
        picture::write_exr_rgb(&truth.join(name), &normals).unwrap();
    }
    capture
}

#[test]
fn known_parts_stand_in_the_maps_and_in_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let capture = with_truth(folder.path());
    let without = capture.hash().to_owned();
    let parts = [TruthPart::Normals, TruthPart::Light, TruthPart::Specular];
    let capture = capture.with_truth(&parts).unwrap();
    assert_ne!(capture.hash(), without);
    let config = interrupts::short();
    let rows = config.transport.rows;
    let solution = solve(&capture, &Config::Unshade(config), &mut silent).unwrap();
    assert_eq!(solution.record.given, ["light", "specular", "normals"]);

    let cells = &solution.lights[0].radiance;
    let ratios: Vec<f32> = (0..rows)
        .map(|row| {
            let polar = std::f32::consts::PI * (row as f32 + 0.5) / rows as f32;
            cells[CHANNELS * 2 * rows * row] / (1.5 - polar / std::f32::consts::PI)
        })
        .collect();
    let spread = |low: f32, ratio: &f32| (ratio / low - 1.0).abs() < 0.05;
    assert!(ratios.iter().all(|ratio| spread(ratios[rows / 2], ratio)), "{ratios:?}");

    let maps = solution.maps;
    let size = maps.specular_albedo.as_ref().unwrap().width;
    let atlas = Atlas::new(&capture.mesh, size);
    let specular = maps.specular_albedo.unwrap();
    let normals = maps.specular_normal.unwrap();
    let mut compared = 0;
    for at in (0..size * size).filter(|at| atlas.inside[*at] && atlas.positions[*at].z > 0.5) {
        let position = atlas.positions[at];
        let expected = 0.03 + 0.01 * position.x;
        assert!((specular.data[at] / expected - 1.0).abs() < 0.02, "{position}");
        let normal = Vec3::from_slice(&normals.data[3 * at..]);
        assert!(normal.distance(bent(position)) < 0.05, "{position}: {normal}");
        compared += 1;
    }
    assert!(compared > 100);
}

#[test]
fn a_missing_truth_and_the_published_method_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let bare = capture(folder.path()).with_truth(&[TruthPart::Light]);
    assert!(matches!(bare, Err(CaptureError::Truth { .. })));
    let other = tempfile::tempdir().unwrap();
    let capture = with_truth(other.path()).with_truth(&[TruthPart::Light]).unwrap();
    let refused = solve(&capture, &Config::preset("paper").unwrap(), &mut silent);
    assert!(matches!(refused, Err(SolveError::GivenToOther)));
    let wrong: Result<TruthPart, _> = "albedo=truth".parse();
    assert!(wrong.unwrap_err().contains("normals=truth"));
}
