use glam::Vec3;

use super::*;
use crate::Camera;
use crate::testing;

/// A mesh with no symmetry, 1 m in size.
fn mesh() -> Mesh {
    let mut mesh = testing::dome(10);
    for position in &mut mesh.positions {
        *position *= Vec3::new(0.5, 0.8, 0.6);
        if position.x > 0.2 && position.y > 0.1 {
            *position *= 1.3;
        }
    }
    mesh
}

fn views(mesh: &Mesh) -> Vec<View> {
    let shade = |_: Vec3| (Vec3::ONE, 1);
    let cameras = [(-1.2, 0.4), (0.3, -0.5), (1.4, 0.2), (0.0, 0.9), (-0.7, 0.0)];
    let view = |(index, (x, y)): (usize, (f32, f32))| {
        let camera = testing::camera(&format!("{index:03}"), Vec3::new(x, y, 2.5), 90);
        testing::view(mesh, &camera, shade)
    };
    cameras.into_iter().enumerate().map(view).collect()
}

fn look(mesh: &Mesh, views: &[View], applied: Option<Mat4>) -> Result<(), String> {
    check(Path::new("cap"), mesh, views, applied).map_err(|error| error.to_string())
}

fn changed(change: impl Fn(&mut Camera)) -> Result<(), String> {
    let mesh = mesh();
    let mut views = views(&mesh);
    views.iter_mut().for_each(|view| change(&mut view.camera));
    look(&mesh, &views, None)
}

#[test]
fn sound_captures_pass_with_hair_and_bumps_and_noise() {
    let mut mesh = mesh();
    let mut views = views(&mesh);
    assert_eq!(look(&mesh, &views, None), Ok(()));
    for (index, view) in views.iter_mut().enumerate() {
        view.camera.centre[0] += 0.5 - (index % 3) as f32 * 0.5;
        // An occluder takes the upper third away.
        let third = view.mask.data.len() / 100 * 40;
        view.mask.data[..third].fill(0);
    }
    for (index, position) in mesh.positions.iter_mut().enumerate() {
        *position *= 1.0 + 0.01 * ((index * 7919 % 13) as f32 / 6.0 - 1.0);
    }
    assert_eq!(look(&mesh, &views, None), Ok(()));
    let overlap = |view: &View| compare(&mesh, &view.camera, &view.mask).unwrap().overlap();
    assert!(views.iter().all(|view| overlap(view) > DOUBTFUL));
    // A window in a mask: a warning, but no proof.
    let mut window = views.clone();
    for view in &mut window {
        for (pixel, value) in view.mask.data.iter_mut().enumerate() {
            let (row, column) = (pixel / 90, pixel % 90);
            *value *= u8::from((42..52).contains(&row) && (38..48).contains(&column));
        }
    }
    assert_eq!(look(&mesh, &window, None), Ok(()));
    // Masks that say nothing.
    views.iter_mut().for_each(|view| view.mask.data.fill(255));
    assert_eq!(look(&mesh, &views, None), Ok(()));
    views.iter_mut().for_each(|view| view.mask.data.fill(0));
    assert_eq!(look(&mesh, &views, None), Ok(()));
}

#[test]
fn common_mistakes_are_named() {
    let turn = Mat4::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let flip = Mat4::from_scale(Vec3::new(1.0, -1.0, -1.0));
    type Change = Box<dyn Fn(&mut Camera)>;
    let back = Mat4::from_scale(Vec3::new(-1.0, 1.0, -1.0));
    let cases: [(&str, Change); 10] = [
        ("PyTorch3D's camera axes", Box::new(move |c| c.camera_to_world *= back)),
        ("multiply fl_x and fl_y by 5.0", Box::new(|c| c.focal = c.focal.map(|f| f / 5.0))),
        ("in mm of a sensor 36 mm wide", Box::new(|c| c.focal = c.focal.map(|f| f * 36.0 / 90.0))),
        ("share of the width", Box::new(|c| c.focal = c.focal.map(|f| f / 90.0))),
        ("set cx and cy to the picture's middle", Box::new(|c| c.centre = [0.0; 2])),
        ("OpenCV's camera axes", Box::new(move |c| c.camera_to_world *= flip)),
        (
            "is world to camera: write",
            Box::new(|c| c.camera_to_world = c.camera_to_world.inverse()),
        ),
        (
            "as COLMAP has it",
            Box::new(move |c| c.camera_to_world = (c.camera_to_world * flip).inverse()),
        ),
        (
            "cameras are in mm",
            Box::new(|c| {
                let place = c.camera_to_world.w_axis.truncate() * 1000.0;
                c.camera_to_world.w_axis = place.extend(1.0);
            }),
        ),
        (
            "write its vertices (x, y, z) as (x, -z, y)",
            Box::new(move |c| c.camera_to_world = turn * c.camera_to_world),
        ),
    ];
    for (expected, change) in cases {
        let message = changed(change).unwrap_err();
        assert!(message.contains(expected), "{expected}: {message}");
        assert!(message.starts_with("cap/transforms.json: the mesh covers 0."), "{message}");
        assert!(!message.contains('\n'));
    }
}

#[test]
fn a_stated_transform_a_mesh_in_mm_and_inverted_masks_are_named() {
    let sound = mesh();
    let applied = Mat4::from_rotation_x(1.2) * Mat4::from_translation(Vec3::new(0.5, 0.6, 0.0));
    let mut flipped = views(&sound);
    for view in &mut flipped {
        view.camera.camera_to_world = applied * view.camera.camera_to_world;
    }
    let message = look(&sound, &flipped, Some(applied)).unwrap_err();
    assert!(message.contains("applied_transform turned the cameras but not"), "{message}");
    let message = look(&sound, &flipped, None).unwrap_err();
    assert!(message.contains("no single change fixes it"), "{message}");

    let views = views(&sound);
    let mut large = sound.clone();
    large.positions.iter_mut().for_each(|position| *position *= 1000.0);
    let message = look(&large, &views, None).unwrap_err();
    assert!(message.contains("the mesh is in mm"), "{message}");

    let mut inverted = views;
    for view in &mut inverted {
        view.mask.data.iter_mut().for_each(|value| *value = 255 - *value);
    }
    let message = look(&sound, &inverted, None).unwrap_err();
    assert!(message.contains("the masks are inverted"), "{message}");
}
