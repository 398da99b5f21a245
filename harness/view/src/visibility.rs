//! The visibility of directions from each vertex, which gives ambient light its shadows.

use std::f32::consts::PI;

use capture::Mesh;
use capture::rays::Occluder;
use glam::Vec3;
use rayon::prelude::*;

use crate::packed::{Array, Element};

/// Number of directions: about 18 degrees apart.
pub(crate) const DIRECTIONS: usize = 128;

/// Cosine to the vertex's normal below which a direction counts as hidden; relief tilts normals by less.
const HORIZON: f32 = -0.25;

/// Distance of a ray's origin from its vertex over the diagonal of the mesh.
const CLEARANCE: f32 = 4e-4;

/// The directions: a spiral of equal solid angles around +Y (Fibonacci lattice), unit vectors.
pub(crate) fn directions() -> Vec<Vec3> {
    let turn = PI * (3.0 - 5f32.sqrt());
    let direction = |i: usize| {
        let y = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
        let (sine, cosine) = (turn * i as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        Vec3::new(radius * cosine, y, radius * sine)
    };
    (0..DIRECTIONS).map(direction).collect()
}

/// For each vertex a bit for each of the [`directions`], the first in the lowest bit of the first byte: set where
/// the mesh does not block it.
pub(crate) fn bits(mesh: &Mesh) -> Array {
    let occluder = Occluder::new(mesh);
    let (low, high) = mesh.bounds();
    let clearance = CLEARANCE * (high - low).length();
    let directions = directions();
    let vertices = mesh.positions.par_iter().zip(&mesh.normals);
    let bytes = vertices.flat_map_iter(|(position, normal)| {
        let origin = *position + clearance * *normal;
        let open = |direction: &Vec3| {
            normal.dot(*direction) > HORIZON && occluder.first_hit(origin, *direction).is_none()
        };
        let byte = |eight: &[Vec3]| {
            eight.iter().enumerate().map(|(bit, at)| u32::from(open(at)) << bit).sum::<u32>()
        };
        directions.chunks(8).map(byte).collect::<Vec<_>>()
    });
    Array::list(Element::U8, DIRECTIONS / 8, bytes.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor of 2 m around the origin, its normal up, and a wall of 2 m at x = 0.2 that faces -x.
    fn corner() -> Mesh {
        let floor = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
        let wall = [[0.2, 0.0, -1.0], [0.2, 0.0, 1.0], [0.2, 2.0, 1.0], [0.2, 2.0, -1.0]];
        let centre = [[0.0, 0.0, 0.0]];
        let positions: Vec<Vec3> =
            floor.iter().chain(&wall).chain(&centre).map(|p| Vec3::from_array(*p)).collect();
        let normals = (0..9).map(|i| if (4..8).contains(&i) { -Vec3::X } else { Vec3::Y });
        Mesh {
            normals: normals.collect(),
            uvs: vec![glam::Vec2::ZERO; positions.len()],
            positions,
            triangles: vec![[0, 1, 8], [1, 2, 8], [2, 3, 8], [3, 0, 8], [4, 5, 6], [4, 6, 7]],
        }
    }

    #[test]
    fn a_wall_hides_its_side_and_the_ground_the_directions_below() {
        let found = bits(&corner());
        let of_centre = &found.codes[8 * DIRECTIONS / 8..];
        for (i, direction) in directions().iter().enumerate() {
            let open = (of_centre[i / 8] >> (i % 8)) & 1 == 1;
            // The ray leaves 1 mm above the floor; it meets the wall at a height of up to 2 m.
            let at_wall = *direction * (0.2 / direction.x);
            let hidden = direction.x > 0.0 && at_wall.y < 1.95 && at_wall.z.abs() < 0.95;
            let clear = direction.x <= 0.0 || at_wall.y > 2.05 || at_wall.z.abs() > 1.05;
            if direction.y > 0.01 && (hidden || clear) {
                assert_eq!(open, clear, "{direction}");
            }
            if direction.y < -0.01 {
                assert!(!open, "{direction}");
            }
        }
    }

    #[test]
    fn directions_cover_the_sphere_evenly() {
        let all = directions();
        assert!((all.iter().sum::<Vec3>() / DIRECTIONS as f32).length() < 0.01);
        for (i, first) in all.iter().enumerate() {
            assert!((first.length() - 1.0).abs() < 1e-6);
            let nearest = all.iter().enumerate().filter(|(j, _)| *j != i);
            let nearest = nearest.map(|(_, other)| first.dot(*other)).fold(-1.0, f32::max);
            assert!((10.0..22.0).contains(&nearest.acos().to_degrees()));
        }
    }
}
