//! The outside of a mesh. Exporters turn normals and triangles round, wholly or
//! here and there; the cameras know better, since a face is photographed from outside.

use glam::Vec3;

use super::mesh::{Mesh, places};
use super::winding::Winding;

/// Cosine below which two directions are opposite: neither creases nor the folds of a noisy scan
/// bring normals and triangles so far apart.
const OPPOSITE: f32 = -0.5;
/// Share of the solid angle, seen by the cameras through all other surfaces, that must turn away
/// from them for the whole to be inside out; a closed surface shows as much of either side.
const INSIDE_OUT: f64 = 0.1;

/// Parts of the mesh that were turned round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flipped {
    /// Normals, all or some.
    pub normals: usize,
    /// Triangles whose order of corners was reversed.
    pub triangles: usize,
}

/// Turns normals of one connected surface to the same side, the whole towards the cameras, single
/// ones to those around them, and triangles to their normals. `eyes` are the cameras' positions.
pub fn orient(mesh: &mut Mesh, eyes: &[Vec3]) -> Flipped {
    let mut flipped = Flipped::default();
    let given = mesh.normals.clone();
    let place = places(&mesh.positions);
    let winding = Winding::of(&mesh.positions, &place, &mesh.triangles);
    let minority = minority(mesh, &place, &winding);
    for (normal, wrong) in mesh.normals.iter_mut().zip(minority) {
        if wrong {
            *normal = -*normal;
        }
    }
    if inside_out(mesh, eyes) {
        mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
    }
    let around = around(mesh);
    let Mesh { positions, normals, triangles, .. } = mesh;
    for (normal, around) in normals.iter_mut().zip(around) {
        if opposite(*normal, around) {
            *normal = -*normal;
        }
    }
    flipped.normals = normals.iter().zip(&given).filter(|(now, given)| now != given).count();
    for corners in triangles.iter_mut() {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let normal: Vec3 = corners.iter().map(|corner| normals[*corner as usize]).sum();
        if opposite((b - a).cross(c - a), normal) {
            corners.swap(1, 2);
            flipped.triangles += 1;
        }
    }
    flipped
}

/// The normals that point to the other side of their surface than most of its normals do.
fn minority(mesh: &Mesh, place: &[usize], winding: &Winding) -> Vec<bool> {
    let sides = winding.sides(&mesh.positions, place, &mesh.triangles);
    let mut surface = vec![usize::MAX; place.len()];
    for (corners, number) in mesh.triangles.iter().zip(&winding.surface) {
        corners.iter().for_each(|corner| surface[*corner as usize] = *number);
    }
    let side = |vertex: usize| {
        let cosine = mesh.normals[vertex].normalize_or_zero().dot(sides[vertex]);
        if cosine.abs() < -OPPOSITE { 0 } else { cosine.signum() as isize }
    };
    let mut votes = vec![0_isize; mesh.triangles.len()];
    for (vertex, surface) in surface.iter().enumerate() {
        if let Some(votes) = votes.get_mut(*surface) {
            *votes += side(vertex);
        }
    }
    let against = |vertex: usize| {
        votes.get(surface[vertex]).is_some_and(|votes| votes.signum() * side(vertex) < 0)
    };
    (0..place.len()).map(against).collect()
}

/// For every vertex the sum of the normals of its neighbours, whichever way the triangles between
/// them are turned.
fn around(mesh: &Mesh) -> Vec<Vec3> {
    let place = places(&mesh.positions);
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for corners in &mesh.triangles {
        let all: Vec3 = corners.iter().map(|corner| mesh.normals[*corner as usize]).sum();
        for corner in corners.map(|corner| corner as usize) {
            sums[place[corner]] += all - mesh.normals[corner];
        }
    }
    place.into_iter().map(|place| sums[place]).collect()
}

/// Returns whether the surface faces away from the cameras.
fn inside_out(mesh: &Mesh, eyes: &[Vec3]) -> bool {
    let (mut towards, mut either) = (0.0, 0.0);
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        let normal: Vec3 = corners.iter().map(|corner| mesh.normals[*corner as usize]).sum();
        let plane = (b - a).cross(c - a);
        let outward = if plane.dot(normal) < 0.0 { -plane } else { plane };
        for eye in eyes {
            let ray = (eye - (a + b + c) / 3.0).as_dvec3();
            let angle = outward.as_dvec3().dot(ray) / ray.length().powi(3).max(f64::MIN_POSITIVE);
            towards += angle;
            either += angle.abs();
        }
    }
    towards < -INSIDE_OUT * either
}

fn opposite(a: Vec3, b: Vec3) -> bool {
    a.normalize_or_zero().dot(b.normalize_or_zero()) < OPPOSITE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    const EYES: [Vec3; 2] = [Vec3::new(0.5, 0.0, 3.0), Vec3::new(-1.5, 0.5, 2.5)];

    fn oriented(change: impl FnOnce(&mut Mesh)) -> (Mesh, Flipped) {
        let mut mesh = testing::dome(12);
        change(&mut mesh);
        let flipped = orient(&mut mesh, &EYES);
        (mesh, flipped)
    }

    fn reverse<'a>(triangles: impl IntoIterator<Item = &'a mut [u32; 3]>) {
        triangles.into_iter().for_each(|corners| corners.swap(1, 2));
    }

    fn negate<'a>(normals: impl IntoIterator<Item = &'a mut Vec3>) {
        normals.into_iter().for_each(|normal| *normal = -*normal);
    }

    #[test]
    fn a_sound_mesh_stays_and_every_inversion_is_undone() {
        let sound = testing::dome(12);
        let (vertices, triangles) = (sound.normals.len(), sound.triangles.len());
        assert_eq!(oriented(|_| ()), (sound.clone(), Flipped::default()));
        let (mesh, flipped) = oriented(|mesh| negate(&mut mesh.normals));
        assert_eq!((&mesh, flipped.normals, flipped.triangles), (&sound, vertices, 0));
        let (mesh, flipped) = oriented(|mesh| reverse(&mut mesh.triangles));
        assert_eq!((&mesh, flipped.normals, flipped.triangles), (&sound, 0, triangles));
        let (mesh, _) = oriented(|mesh| {
            negate(&mut mesh.normals);
            reverse(&mut mesh.triangles);
        });
        assert_eq!(mesh, sound);
        // Some of each, at some distance from each other.
        let (mesh, flipped) = oriented(|mesh| {
            reverse(mesh.triangles.iter_mut().step_by(3));
            negate(mesh.normals.iter_mut().step_by(11));
        });
        assert_eq!(
            (flipped.normals, flipped.triangles),
            (vertices.div_ceil(11), triangles.div_ceil(3))
        );
        assert_eq!(mesh, sound);
    }

    #[test]
    fn halves_that_are_turned_over_are_turned_back() {
        let sound = testing::dome(12);
        let left = |position: &Vec3| position.x < 0.1;
        let (mesh, flipped) = oriented(|mesh| {
            let normals = mesh.normals.iter_mut().zip(&mesh.positions);
            negate(normals.filter(|(_, p)| left(p)).map(|(normal, _)| normal));
        });
        assert_eq!(mesh, sound);
        assert_eq!(flipped.normals, sound.positions.iter().filter(|p| left(p)).count());
        let (mesh, flipped) = oriented(|mesh| {
            let positions = &mesh.positions;
            let of_left = |t: &&mut [u32; 3]| t.iter().all(|c| left(&positions[*c as usize]));
            reverse(mesh.triangles.iter_mut().filter(of_left));
            negate(&mut mesh.normals);
        });
        assert_eq!((mesh, flipped.normals), (sound.clone(), sound.normals.len()));
    }

    #[test]
    fn a_shell_that_shows_as_much_of_either_side_is_left_alone() {
        let (mesh, flipped) = oriented(|mesh| {
            let inner = testing::dome(12);
            let base = mesh.positions.len() as u32;
            mesh.positions.extend(inner.positions.iter().map(|position| position * 0.98));
            mesh.normals.extend(inner.normals.iter().map(|normal| -normal));
            mesh.uvs.extend(&inner.uvs);
            let reversed = inner.triangles.iter().map(|[a, b, c]| [*a, *c, *b]);
            mesh.triangles.extend(reversed.map(|corners| corners.map(|corner| base + corner)));
        });
        assert_eq!(flipped, Flipped::default());
        assert!(!inside_out(&mesh, &EYES));
    }
}
