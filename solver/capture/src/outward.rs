//! The orientation of a head's surfaces, without photographs.

use glam::Vec3;

use super::mesh::places;
use super::winding::Winding;

/// Share of an open surface that must face the head's middle, more than away from it, for it to
/// be inside out.
const INSIDE_OUT: f64 = 0.1;
/// Cosine below which a normal and its triangles are opposite.
const OPPOSITE: f32 = -0.5;

/// Triangles and normals to turn round so that all surfaces face outwards.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outward {
    /// One per triangle: whether its order of corners is to be reversed.
    pub triangles: Vec<bool>,
    /// One per vertex: whether its normal is to be negated; empty without normals.
    pub normals: Vec<bool>,
    /// Number of triangles on surfaces with one side only, whose outside nothing tells.
    pub one_sided: usize,
}

/// Winds the triangles of every connected surface alike and turns it outwards: a closed one away
/// from its own inside, an open one away from the origin of `positions`, the middle of the head.
/// Then normals follow their triangles.
pub fn outward(positions: &[Vec3], normals: Option<&[Vec3]>, triangles: &[[u32; 3]]) -> Outward {
    let place = places(positions);
    let mut winding = Winding::of(positions, &place, triangles);
    let mut facing = vec![(0.0, 0.0); triangles.len()];
    for (index, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
        let normal = (b - a).cross(c - a);
        let away = normal.dot(a + b + c) * if winding.flipped[index] { -1.0 } else { 1.0 };
        let (sum, either) = &mut facing[winding.surface[index]];
        *sum += away;
        *either += away.abs();
    }
    let inside_out = |surface: usize| {
        let (sum, either) = facing[surface];
        // Of a closed surface, the sum is six times its volume wherever the origin lies.
        sum < -either * if winding.open[surface] { INSIDE_OUT } else { 1e-9 }
    };
    let inward: Vec<bool> = winding.surface.iter().map(|surface| inside_out(*surface)).collect();
    for (flipped, inward) in winding.flipped.iter_mut().zip(inward) {
        *flipped ^= inward;
    }
    let sides = winding.sides(positions, &place, triangles);
    let against = |(normal, side): (&Vec3, &Vec3)| normal.normalize_or_zero().dot(*side) < OPPOSITE;
    let one_sided = |surface: &&usize| winding.one_sided.binary_search(surface).is_ok();
    Outward {
        normals: normals.into_iter().flatten().zip(&sides).map(against).collect(),
        one_sided: winding.surface.iter().filter(one_sided).count(),
        triangles: winding.flipped,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn open_surfaces_face_away_from_the_middle_and_closed_ones_from_their_inside() {
        let dome = testing::dome(6);
        let found = outward(&dome.positions, Some(&dome.normals), &dome.triangles);
        assert!(!found.triangles.contains(&true) && !found.normals.contains(&true));
        let reversed: Vec<[u32; 3]> = dome.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        let found = outward(&dome.positions, Some(&dome.normals), &reversed);
        assert!(!found.triangles.contains(&false) && !found.normals.contains(&true));
        let inward: Vec<Vec3> = dome.normals.iter().map(|normal| -normal).collect();
        let found = outward(&dome.positions, Some(&inward), &reversed);
        assert!(!found.triangles.contains(&false) && !found.normals.contains(&false));

        // A tetrahedron beside the middle, beside the dome.
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.2 + Vec3::splat(3.0));
        let sound = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        assert_eq!(outward(&corners, None, &sound).triangles, [false; 4]);
        let one_reversed = [[0, 1, 2], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let first = [true, false, false, false];
        assert_eq!(outward(&corners, None, &one_reversed).triangles, first);
        let inside_out = sound.map(|[a, b, c]: [u32; 3]| [a, c, b]);
        assert_eq!(outward(&corners, None, &inside_out).triangles, [true; 4]);
        assert!(outward(&corners, None, &sound).normals.is_empty());
    }
}
