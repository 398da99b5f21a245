use capture::View;
use capture::mean_texture::mean_texture;
use glam::Vec3;

use super::*;
use crate::testing;

fn capture(shade: impl Fn(Vec3) -> (Vec3, u8)) -> Capture {
    let folder = tempfile::tempdir().unwrap();
    let mesh = testing::dome(24);
    let views: Vec<View> =
        testing::rig(4, 64).iter().map(|camera| testing::view(&mesh, camera, &shade)).collect();
    testing::write_capture(folder.path(), &mesh, &views, 1);
    Capture::open(folder.path()).unwrap()
}

/// Between view and normal of the unit sphere, per training view.
fn cosines(capture: &Capture, point: Vec3) -> impl Iterator<Item = f32> {
    let eyes = capture.train.iter().map(|view| view.camera.position());
    eyes.map(move |eye| point.normalize().dot((eye - point).normalize()))
}

#[test]
fn a_constant_colour_stays_constant() {
    let colour = Vec3::new(0.6, 0.3, 0.2);
    let capture = capture(|_| (colour, 1));
    for maps in
        [mean_texture(&capture, 48).unwrap(), semantic_initialisation(&capture, 48).unwrap()]
    {
        let albedo = maps.diffuse_albedo.unwrap();
        for texel in albedo.data.chunks(3) {
            assert!((Vec3::from_slice(texel) - colour).length() < 1e-6);
        }
        let view = &capture.train[0];
        let picture = unlit_view(&capture, &albedo, &view.camera);
        for (pixel, mask) in picture.data.chunks(3).zip(&view.mask.data) {
            let expected = if *mask == 255 { colour } else { Vec3::ZERO };
            assert!((Vec3::from_slice(pixel) - expected).length() < 1e-6);
        }
        assert!(maps.specular_albedo.is_none());
        assert_eq!(maps.diffuse_normal, maps.specular_normal);
        // The dome hides nothing of itself, so the cosines alone say what is seen; at 0.35 a point
        // is more than a pixel from the silhouette, at 0.3 above the equator from the open rim.
        let atlas = Atlas::new(&capture.mesh, 48);
        for (index, value) in maps.coverage.unwrap().data.into_iter().enumerate() {
            let best = cosines(&capture, atlas.positions[index]).fold(-1.0, f32::max);
            let position = atlas.positions[index];
            if !atlas.inside[index] || best < 0.09 {
                assert_eq!(value, 0, "texel {index} at {position} with cosine {best}");
            } else if best > 0.35 && position.z > 0.3 {
                assert_eq!(value, 255, "texel {index} at {position} with cosine {best}");
            }
        }
    }
}

#[test]
fn a_smooth_texture_is_found_where_it_belongs() {
    let paint = |p: Vec3| (p / 2.0 + 0.5, 1);
    let capture = capture(paint);
    let maps = mean_texture(&capture, 48).unwrap();
    let atlas = Atlas::new(&capture.mesh, 48);
    let coverage = maps.coverage.unwrap();
    let mut compared = 0;
    for (index, texel) in maps.diffuse_albedo.unwrap().data.chunks(3).enumerate() {
        // Beside any view's silhouette a bilinear look-up has to do with fewer than four pixels.
        let least = cosines(&capture, atlas.positions[index]).fold(1.0, f32::min);
        if coverage.data[index] == 255 && least > 0.4 {
            compared += 1;
            let error = Vec3::from_slice(texel) - paint(atlas.positions[index]).0;
            assert!(error.length() < 0.01, "texel {index}: {error}");
        }
    }
    assert!(compared > 200, "{compared}");
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
    let work =
        || (mean_texture(&capture, 40).unwrap(), semantic_initialisation(&capture, 40).unwrap());
    let once = testing::on_threads(1, work);
    assert_eq!(testing::on_threads(2, work), once);
    assert_eq!(testing::on_threads(3, work), once);
}
