use glam::Vec3;

use super::*;
use crate::capture::View;
use crate::testing;

fn capture(shade: impl Fn(Vec3) -> (Vec3, u8)) -> Capture {
    let folder = tempfile::tempdir().unwrap();
    let mesh = testing::dome(24);
    let views: Vec<View> =
        testing::rig(4, 64).iter().map(|camera| testing::view(&mesh, camera, &shade)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    Capture::open(folder.path()).unwrap()
}

#[test]
fn a_constant_colour_stays_constant() {
    let colour = Vec3::new(0.6, 0.3, 0.2);
    let capture = capture(|_| (colour, 1));
    for maps in [mean_texture(&capture, 48).unwrap(), semantic_initialisation(&capture, 48).unwrap()] {
        for texel in maps.diffuse_albedo.unwrap().data.chunks(3) {
            assert!((Vec3::from_slice(texel) - colour).length() < 1e-6);
        }
        assert!(maps.specular_albedo.is_none());
        assert_eq!(maps.diffuse_normal, maps.specular_normal);
        let covered = maps.coverage.unwrap().data.iter().filter(|value| **value == 255).count();
        let chart = std::f32::consts::PI * 0.16 * 48.0 * 48.0;
        assert!(covered as f32 > 0.9 * chart && covered as f32 <= 1.02 * chart, "{covered}");
    }
}

#[test]
fn a_smooth_texture_is_found_where_it_belongs() {
    let paint = |p: Vec3| (p / 2.0 + 0.5, 1);
    let capture = capture(paint);
    let maps = mean_texture(&capture, 48).unwrap();
    let atlas = Atlas::new(&capture.mesh, 48);
    let coverage = maps.coverage.unwrap();
    for (index, texel) in maps.diffuse_albedo.unwrap().data.chunks(3).enumerate() {
        // Beside the silhouette a bilinear look-up has to do with fewer than four pixels.
        if coverage.data[index] == 255 && atlas.positions[index].z > 0.5 {
            let error = Vec3::from_slice(texel) - paint(atlas.positions[index]).0;
            assert!(error.length() < 0.01, "texel {index}: {error}");
        }
    }
}

#[test]
fn a_capture_that_does_not_meet_its_mesh_is_refused() {
    let mut capture = capture(|_| (Vec3::ONE, 1));
    for view in &mut capture.train {
        view.camera.camera_to_world.w_axis.x += 100.0;
    }
    let message = mean_texture(&capture, 16).unwrap_err().to_string();
    assert!(message.contains("no texel of the mesh is seen"), "{message}");
    assert!(semantic_initialisation(&capture, 16).is_err());
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let capture = capture(|p| (p.abs(), if p.y > 0.0 { 1 } else { 2 }));
    let work = || (mean_texture(&capture, 40).unwrap(), semantic_initialisation(&capture, 40).unwrap());
    let once = testing::on_threads(1, work);
    assert_eq!(testing::on_threads(2, work), once);
    assert_eq!(testing::on_threads(3, work), once);
}
