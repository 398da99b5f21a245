//! The sampling density of pictures on the surface, in the chart's measure.

use glam::{Vec2, Vec3};

use crate::{Mesh, View};

/// Texels of the unit square for which the seen part of the mesh has as many as pixels of the view that sees each
/// triangle finest; 0 if no view sees any. Other views of the same place add none.
pub fn finest_sampling(mesh: &Mesh, views: &[View]) -> f64 {
    let mut finest = vec![0.0f64; mesh.triangles.len()];
    for view in views {
        let world_to_camera = view.camera.world_to_camera();
        let pixel =
            |point: &Vec3| view.camera.project_local(world_to_camera.transform_point3(*point));
        let pixels: Vec<Vec3> = mesh.positions.iter().map(pixel).collect();
        for (most, triangle) in finest.iter_mut().zip(&mesh.triangles) {
            let corners = triangle.map(|index| pixels[index as usize]);
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            // Rows run down, so that a triangle which faces the camera has a negative area.
            let area = -area(corners.map(|corner| corner.truncate()));
            if area > *most && corners.iter().all(|corner| corner.z > 0.0) && shows(view, middle) {
                *most = area;
            }
        }
    }
    let (mut pixels, mut chart) = (0.0, 0.0);
    for (most, triangle) in finest.iter().zip(&mesh.triangles).filter(|(most, _)| **most > 0.0) {
        pixels += most;
        chart += area(triangle.map(|index| mesh.uvs[index as usize])).abs();
    }
    if chart > 0.0 { pixels / chart } else { 0.0 }
}

/// Returns whether a view's mask has the mesh at a pixel (column, row).
fn shows(view: &View, pixel: Vec3) -> bool {
    let (column, row) = (pixel.x.floor(), pixel.y.floor());
    let inside = column >= 0.0
        && row >= 0.0
        && (column as usize) < view.camera.width
        && (row as usize) < view.camera.height;
    inside && view.mask.data[row as usize * view.camera.width + column as usize] == 255
}

/// Signed area of a triangle, counter-clockwise positive where y runs up.
fn area([a, b, c]: [Vec2; 3]) -> f64 {
    f64::from((b - a).perp_dot(c - a)) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{camera, square, view};

    #[test]
    fn the_finest_view_alone_counts() {
        let mut mesh = square();
        for uv in &mut mesh.uvs {
            uv.x *= 0.5;
        }
        // The square's side of 2 takes 2 / 2.5 of a picture, whatever the distance.
        let texels = |sizes: &[usize]| {
            let of = |size: &usize| {
                view(&mesh, &camera("000", 3.0 * Vec3::Z, *size), |_| (Vec3::ONE, 1))
            };
            finest_sampling(&mesh, &sizes.iter().map(of).collect::<Vec<_>>())
        };
        assert!((texels(&[50]) - 3200.0).abs() < 1.0, "{}", texels(&[50]));
        assert!((texels(&[50, 50, 40, 20]) - 3200.0).abs() < 1.0);
        assert!((texels(&[20, 100, 50]) - 12800.0).abs() < 1.0);
        let behind = view(&mesh, &camera("000", -3.0 * Vec3::Z, 50), |_| (Vec3::ONE, 1));
        assert!(finest_sampling(&mesh, &[behind]) == 0.0);
    }
}
