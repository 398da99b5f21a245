use glam::Mat4;

use super::*;
use crate::testing;

/// The unit direction from the camera through a pixel's centre, and its length at depth 1.
fn ray(camera: &Camera, pixel: u32) -> (Vec3, f32) {
    let (x, y) = (pixel as usize % camera.width, pixel as usize / camera.width);
    let local = Vec3::new(
        (x as f32 + 0.5 - camera.centre[0]) / camera.focal[0],
        (camera.centre[1] - y as f32 - 0.5) / camera.focal[1],
        -1.0,
    );
    (camera.camera_to_world.transform_vector3(local).normalize(), local.length())
}

#[test]
fn a_slanted_square_is_hit_where_the_rays_meet_its_plane() {
    let (mesh, camera) = (testing::square(), testing::camera("a", Vec3::new(1.5, 0.7, 1.2), 40));
    let gbuffer = GBuffer::new(&mesh, &camera, None);
    let eye = camera.position();
    let mut covered = vec![false; 40 * 40];
    for (index, pixel) in gbuffer.pixels.iter().enumerate() {
        let (direction, length) = ray(&camera, *pixel);
        let distance = -eye.z / direction.z;
        let point = eye + distance * direction;
        assert!((gbuffer.positions[index] - point).length() < 1e-5);
        assert!((gbuffer.uvs[index] - (point.truncate() / 2.0 + 0.5)).length() < 1e-5);
        assert!((gbuffer.view_dirs[index] + direction).length() < 1e-5);
        assert!((gbuffer.depths[index] - distance / length).abs() < 1e-5);
        let back = camera.project(gbuffer.positions[index]);
        let centre = Vec3::new((pixel % 40) as f32 + 0.5, (pixel / 40) as f32 + 0.5, back.z);
        assert!((back - centre).length() < 1e-3, "{back} {centre}");
        covered[*pixel as usize] = true;
    }
    for pixel in 0..40 * 40 {
        let (direction, _) = ray(&camera, pixel);
        let distance = -eye.z / direction.z;
        let point = eye + distance * direction;
        let margin = 1.0 - point.truncate().abs().max_element();
        let expected = distance > 0.0 && margin > 0.0;
        assert!(covered[pixel as usize] == expected || margin.abs() < 1e-4, "pixel {pixel}");
    }
}

#[test]
fn a_fine_dome_is_the_sphere() {
    let (mesh, camera) = (testing::dome(64), testing::camera("a", Vec3::new(0.5, 0.4, 3.0), 48));
    let gbuffer = GBuffer::new(&mesh, &camera, None);
    assert!(gbuffer.len() > 500);
    for (index, pixel) in gbuffer.pixels.iter().enumerate() {
        let (direction, _) = ray(&camera, *pixel);
        let eye = camera.position();
        let along = -eye.dot(direction);
        let root = along * along - eye.length_squared() + 1.0;
        // At the silhouette the polygon's sagitta moves the hit by more than elsewhere.
        if root > 0.05 {
            let point = eye + (along - root.sqrt()) * direction;
            assert!((gbuffer.positions[index] - point).length() < 2e-3);
            assert!((gbuffer.normals[index] - point).length() < 2e-3);
        }
        assert!((gbuffer.normals[index].length() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn every_pixel_inside_a_closed_fan_is_covered_and_the_back_occludes_without_a_sample() {
    let mut mesh = testing::dome(20);
    let camera = testing::camera("a", Vec3::new(0.0, 0.0, 3.0), 61);
    let full = GBuffer::new(&mesh, &camera, None);
    let holes = full
        .pixels
        .windows(2)
        .filter(|pair| pair[1] != pair[0] + 1 && pair[0] / 61 == pair[1] / 61);
    assert_eq!(holes.count(), 0, "a convex silhouette has no gap in a row");
    // A triangle in front of the left half that shows its back.
    let base = mesh.positions.len() as u32;
    mesh.positions.extend([
        Vec3::new(0.0, -5.0, 1.5),
        Vec3::new(0.0, 5.0, 1.5),
        Vec3::new(-9.0, 0.0, 1.5),
    ]);
    mesh.normals.extend([Vec3::Z; 3]);
    mesh.uvs.extend([Vec2::ZERO; 3]);
    let occluder = |triangle| {
        let mut mesh = mesh.clone();
        mesh.triangles.push(triangle);
        GBuffer::new(&mesh, &camera, None)
    };
    let behind = occluder([base, base + 2, base + 1]);
    let right: Vec<u32> = full.pixels.iter().copied().filter(|pixel| pixel % 61 > 30).collect();
    let seen: Vec<u32> = behind.pixels.iter().copied().filter(|pixel| pixel % 61 != 30).collect();
    assert_eq!(seen, right);
    assert!(occluder([base, base + 1, base + 2]).len() > full.len());
}

#[test]
fn a_triangle_that_passes_behind_the_camera_is_hit_in_front_of_it() {
    // A floor below the camera that reaches behind it.
    let mesh = Mesh {
        positions: vec![
            Vec3::new(-50.0, -1.0, 40.0),
            Vec3::new(50.0, -1.0, 40.0),
            Vec3::new(0.0, -1.0, -60.0),
        ],
        normals: vec![Vec3::Y; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
    };
    let mut camera = testing::camera("a", Vec3::Z, 20);
    camera.camera_to_world = Mat4::IDENTITY;
    camera.focal = [10.0; 2];
    let gbuffer = GBuffer::new(&mesh, &camera, None);
    assert!(gbuffer.pixels.iter().all(|pixel| pixel / 20 >= 10), "only below the horizon");
    assert!(gbuffer.pixels.contains(&(19 * 20 + 10)));
    for (pixel, position) in gbuffer.pixels.iter().zip(&gbuffer.positions) {
        let depth = 10.0 / ((pixel / 20) as f32 + 0.5 - 10.0);
        assert!((position.y + 1.0).abs() < 1e-4 && (position.z + depth).abs() < 1e-3, "{position}");
    }
}

#[test]
fn the_mask_and_the_number_of_threads() {
    let (mesh, camera) = (testing::dome(30), testing::camera("a", Vec3::new(0.4, 0.3, 3.0), 50));
    let all = GBuffer::new(&mesh, &camera, None);
    let mut mask = GrayImage::new(50, 50);
    mask.data[..1250].fill(255);
    let masked = GBuffer::new(&mesh, &camera, Some(&mask));
    let upper: Vec<u32> = all.pixels.iter().copied().filter(|pixel| *pixel < 1250).collect();
    assert_eq!(masked.pixels, upper);
    for threads in 1..=3 {
        let again = testing::on_threads(threads, || GBuffer::new(&mesh, &camera, None));
        assert_eq!(again, all);
    }
}

#[test]
fn the_atlas_is_the_surface_at_the_texels_centres() {
    let square = Atlas::new(&testing::square(), 8);
    assert!(square.inside.iter().all(|inside| *inside));
    // Texel (0, 0) is at u = 1/16, v = 15/16.
    assert!((square.positions[0] - Vec3::new(-0.875, 0.875, 0.0)).length() < 1e-6);
    let dome = Atlas::new(&testing::dome(40), 64);
    assert!(!dome.inside[0] && dome.inside[32 * 64 + 32]);
    let fraction = dome.inside.iter().filter(|inside| **inside).count() as f32 / 4096.0;
    assert!((fraction - std::f32::consts::PI * 0.16).abs() < 0.01, "{fraction}");
    for (normal, position) in dome.normals.iter().zip(&dome.positions) {
        assert!((normal.length() - 1.0).abs() < 1e-6);
        assert!((*normal - *position).length() < 2e-3, "a unit sphere's normal is its position");
    }
    let corner = dome.positions[0].normalize();
    assert!(corner.x < -0.6 && corner.y > 0.6, "the rim nearest to the upper left: {corner}");
    assert_eq!(dome.normal_map(), mesh_normal_map(&testing::dome(40), 64));
}

#[test]
fn the_texels_of_a_chart_have_the_area_of_the_surface() {
    for mesh in [testing::square(), testing::dome(40)] {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
        let doubled = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = corners(triangle);
            f64::from((b - a).cross(c - a).length())
        });
        let surface = 0.5e6 * doubled.sum::<f64>();
        let texels = texel_area_map(&mesh, 512).data;
        let sum: f64 = texels.iter().map(|area| f64::from(*area)).sum();
        assert!((sum / surface - 1.0).abs() < 5e-3, "{sum} instead of {surface}");
    }
}
