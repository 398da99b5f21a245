//! Triangles of a mesh that are wound against their neighbours.

use std::collections::HashMap;

use glam::Vec3;

/// The triangles' windings, carried from neighbour to neighbour over common edges.
pub(super) struct Winding {
    /// Triangles to be turned so that those of one connected surface are wound alike, as most of
    /// its area is already.
    pub flipped: Vec<bool>,
    /// For each triangle, its surface, named by the index of that surface's first triangle.
    pub surface: Vec<usize>,
    /// Surfaces, by their numbers, that are wound alike in no way (a Möbius strip), so that
    /// nothing of them is turned.
    pub one_sided: Vec<usize>,
    /// Surfaces with an edge of only one triangle, by their numbers.
    pub open: Vec<bool>,
}

impl Winding {
    /// `place` gives one index to vertices at one place. Edges of more than two triangles connect
    /// nothing.
    pub fn of(positions: &[Vec3], place: &[usize], triangles: &[[u32; 3]]) -> Self {
        let mut forest = Forest::new(triangles.len());
        let mut one_sided = Vec::new();
        let mut borders = Vec::new();
        for sharing in edges(place, triangles) {
            match sharing[..] {
                [(triangle, _)] => borders.push(triangle),
                [(a, forwards), (b, other)] if !forest.join(a, b, forwards == other) => {
                    one_sided.push(a);
                }
                _ => {}
            }
        }
        let (surface, mut flipped): (Vec<usize>, Vec<bool>) =
            (0..triangles.len()).map(|triangle| forest.root(triangle)).unzip();
        let mut balance = vec![0.0; triangles.len()];
        for (index, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
            let area = (b - a).cross(c - a).length();
            balance[surface[index]] += if flipped[index] { area } else { -area };
        }
        let mut open = vec![false; triangles.len()];
        borders.into_iter().for_each(|triangle| open[surface[triangle]] = true);
        let mut one_sided: Vec<usize> = one_sided.iter().map(|index| surface[*index]).collect();
        one_sided.sort_unstable();
        one_sided.dedup();
        for (index, flipped) in flipped.iter_mut().enumerate() {
            *flipped ^= balance[surface[index]] > 0.0;
            *flipped &= one_sided.binary_search(&surface[index]).is_err();
        }
        Self { flipped, surface, one_sided, open }
    }

    /// Unit normals of vertices, from triangles wound alike; zero where there is no area.
    pub fn sides(&self, positions: &[Vec3], place: &[usize], triangles: &[[u32; 3]]) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; positions.len()];
        for (corners, flipped) in triangles.iter().zip(&self.flipped) {
            let [a, b, c] = corners.map(|corner| positions[corner as usize]);
            let normal = if *flipped { (c - a).cross(b - a) } else { (b - a).cross(c - a) };
            corners.iter().for_each(|corner| sums[place[*corner as usize]] += normal);
        }
        place.iter().map(|place| sums[*place].normalize_or_zero()).collect()
    }
}

/// The triangles at every edge and whether they run along it upwards; edges in the order of their
/// first triangles.
fn edges(place: &[usize], triangles: &[[u32; 3]]) -> Vec<Vec<(usize, bool)>> {
    let mut numbers = HashMap::with_capacity(triangles.len() * 2);
    let mut edges: Vec<Vec<(usize, bool)>> = Vec::with_capacity(triangles.len() * 2);
    for (index, corners) in triangles.iter().enumerate() {
        let corners = corners.map(|corner| place[corner as usize]);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
            if a == b {
                continue;
            }
            let number = *numbers.entry((a.min(b), a.max(b))).or_insert_with(|| {
                edges.push(Vec::with_capacity(2));
                edges.len() - 1
            });
            edges[number].push((index, a < b));
        }
    }
    edges
}

/// Sets of triangles, each with its sense against the first of its set.
struct Forest {
    parent: Vec<usize>,
    against: Vec<bool>,
}

impl Forest {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), against: vec![false; count] }
    }

    /// The least index of the set, and whether `index` is turned against it.
    fn root(&mut self, index: usize) -> (usize, bool) {
        let (mut root, mut against) = (index, false);
        while self.parent[root] != root {
            against ^= self.against[root];
            root = self.parent[root];
        }
        let (mut at, mut sense) = (index, against);
        while self.parent[at] != root {
            let (next, own) = (self.parent[at], self.against[at]);
            (self.parent[at], self.against[at]) = (root, sense);
            sense ^= own;
            at = next;
        }
        (root, against)
    }

    /// Makes one set of two; false if they are one already in which they lie the other way.
    fn join(&mut self, a: usize, b: usize, against: bool) -> bool {
        let ((a, of_a), (b, of_b)) = (self.root(a), self.root(b));
        let between = of_a ^ of_b ^ against;
        if a == b {
            return !between;
        }
        let (smaller, larger) = (a.min(b), a.max(b));
        (self.parent[larger], self.against[larger]) = (smaller, between);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::places;
    use crate::testing;

    fn winding(positions: &[Vec3], triangles: &[[u32; 3]]) -> Winding {
        Winding::of(positions, &places(positions), triangles)
    }

    #[test]
    fn what_is_turned_over_is_found_and_nothing_else() {
        let mut mesh = testing::dome(8);
        let sound = winding(&mesh.positions, &mesh.triangles);
        assert!(!sound.flipped.contains(&true) && sound.one_sided.is_empty());
        assert!(sound.surface.iter().all(|surface| *surface == 0) && sound.open[0]);
        let reversed: Vec<bool> = (0..mesh.triangles.len()).map(|i| i % 5 < 2 && i > 40).collect();
        for (corners, reversed) in mesh.triangles.iter_mut().zip(&reversed) {
            if *reversed {
                corners.swap(0, 1);
            }
        }
        assert_eq!(winding(&mesh.positions, &mesh.triangles).flipped, reversed);
    }

    #[test]
    fn a_strip_with_one_side_is_left_alone() {
        let count = 9;
        let mut positions = Vec::new();
        for step in 0..count {
            let turn = step as f32 / count as f32 * std::f32::consts::TAU;
            let (sin, cos) = (turn / 2.0).sin_cos();
            let along = Vec3::new(turn.cos(), turn.sin(), 0.0);
            let across = along * cos * 0.3 + Vec3::Z * sin * 0.3;
            positions.extend([along - across, along + across]);
        }
        let mut triangles = Vec::new();
        for step in 0..count as u32 {
            let next = if step + 1 == count as u32 { [1, 0] } else { [2 * step + 2, 2 * step + 3] };
            let here = [2 * step, 2 * step + 1];
            triangles.extend([[here[0], next[0], next[1]], [here[0], next[1], here[1]]]);
        }
        let winding = winding(&positions, &triangles);
        assert_eq!(winding.one_sided, [0]);
        assert!(!winding.flipped.contains(&true));
    }
}
