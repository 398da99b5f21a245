//! Rays against the mesh.

use std::time::Duration;

use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use crate::Mesh;

/// The mesh, ready to be hit.
pub struct Occluder {
    bvh: CwBvh,
    /// In the order of the hierarchy's leaves.
    triangles: Vec<Triangle>,
    /// The index of each of them in the mesh.
    index: Vec<u32>,
}

/// The end of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Index of the triangle.
    pub triangle: u32,
    /// Weights of the triangle's corners.
    pub barycentric: Vec3,
    /// True if the ray meets the triangle's counter-clockwise side.
    pub front: bool,
}

impl Occluder {
    /// Triangles without area are left out: nothing can hit them.
    pub fn new(mesh: &Mesh) -> Self {
        let corners = mesh.triangles.iter().map(|triangle| {
            let [v0, v1, v2] = triangle.map(|corner| Vec3A::from(mesh.positions[corner as usize]));
            Triangle { v0, v1, v2 }
        });
        let solid = |triangle: &Triangle| {
            (triangle.v1 - triangle.v0).cross(triangle.v2 - triangle.v0).length_squared() > 0.0
        };
        let (index, triangles): (Vec<u32>, Vec<Triangle>) =
            (0..).zip(corners).filter(|(_, triangle)| solid(triangle)).unzip();
        let mut time = Duration::ZERO;
        let bvh = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut time);
        let order = bvh.primitive_indices.iter().map(|leaf| *leaf as usize);
        let (index, triangles) = order.map(|leaf| (index[leaf], triangles[leaf])).unzip();
        Self { bvh, triangles, index }
    }

    /// The first triangle along a ray, seen from either side.
    pub fn first_hit(&self, origin: Vec3, direction: Vec3) -> Option<Impact> {
        let ray = Ray::new_inf(origin.into(), direction.into());
        let mut hit = RayHit::none();
        if self.triangles.is_empty()
            || !self
                .bvh
                .ray_traverse(ray, &mut hit, |ray, leaf| self.triangles[leaf].intersect(ray))
        {
            return None;
        }
        let leaf = hit.primitive_id as usize;
        let Triangle { v0, v1, v2 } = self.triangles[leaf];
        let facing = (v1 - v0).cross(v2 - v0);
        let at = ray.origin + ray.direction * hit.t;
        let area = facing.length_squared();
        let weight = |a: Vec3A, b: Vec3A| (a - at).cross(b - at).dot(facing) / area;
        let (first, second) = (weight(v1, v2), weight(v2, v0));
        Some(Impact {
            triangle: self.index[leaf],
            barycentric: Vec3::new(first, second, 1.0 - first - second),
            front: facing.dot(ray.direction) < 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    /// Every triangle tried in turn (Moeller and Trumbore 1997).
    fn tried_in_turn(mesh: &Mesh, origin: Vec3, direction: Vec3) -> Option<(u32, f32)> {
        let mut nearest: Option<(u32, f32)> = None;
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            let (e1, e2) = (b - a, c - a);
            let p = direction.cross(e2);
            let inverse = e1.dot(p).recip();
            let s = origin - a;
            let q = s.cross(e1);
            let (u, v, t) = (s.dot(p) * inverse, direction.dot(q) * inverse, e2.dot(q) * inverse);
            let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0;
            if inside && nearest.is_none_or(|(_, best)| t < best) {
                nearest = Some((index as u32, t));
            }
        }
        nearest
    }

    #[test]
    fn the_hierarchy_finds_what_trying_every_triangle_finds() {
        let mesh = testing::dome(12);
        let occluder = Occluder::new(&mesh);
        let wave = |i: usize, k: f32| (i as f32 * k).sin();
        let mut hits = 0;
        for i in 0..2000 {
            let origin = 2.0 * Vec3::new(wave(i, 1.1), wave(i, 2.3), wave(i, 3.7));
            let aim = 0.8 * Vec3::new(wave(i, 5.1), wave(i, 7.3), wave(i, 0.7));
            let direction = (aim - origin).normalize();
            let found = occluder.first_hit(origin, direction);
            let expected = tried_in_turn(&mesh, origin, direction);
            assert_eq!(found.map(|hit| hit.triangle), expected.map(|(index, _)| index), "ray {i}");
            if let (Some(hit), Some((_, t))) = (found, expected) {
                hits += 1;
                let corners = mesh.triangles[hit.triangle as usize];
                let corners = corners.map(|corner| mesh.positions[corner as usize]);
                let at: Vec3 =
                    corners.iter().zip(hit.barycentric.to_array()).map(|(p, w)| *p * w).sum();
                assert!(at.distance(origin + direction * t) < 1e-4);
                assert_eq!(hit.front, at.dot(direction) < 0.0, "the dome's outside is its front");
            }
        }
        assert!(hits > 300, "{hits} hits test too little");
    }

    #[test]
    fn triangles_without_area_are_never_hit() {
        let mut mesh = testing::square();
        mesh.triangles = vec![[0, 0, 1], [2, 2, 2]];
        assert_eq!(Occluder::new(&mesh).first_hit(Vec3::Z, -Vec3::Z), None);
    }
}
