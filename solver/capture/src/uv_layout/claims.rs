//! Texels that two triangles claim.
//!
//! A texel's centre on a common edge belongs to one of its two triangles: edges are evaluated from
//! the same end for both, and a centre on an edge counts as left of it.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::surface::{LINE, Layout, twice_area};

/// Side of the grid on which claims are counted, texels.
const SIDE: usize = 1024;
/// Distance, of the diagonal of the mesh's box, below which two points are one place: a triangle
/// that stands in the file twice, a fold of a decimated mesh.
const ONE_PLACE: f64 = 0.002;
const NONE: u32 = u32::MAX;

/// Texels that stand for several places.
pub(super) struct Shared {
    /// The number of texels that any triangle claims.
    pub share: f64,
    /// The two parts that share most of them.
    pub parts: [u32; 2],
    /// True if most of those are claimed by triangles that are mirror images in UV.
    pub mirrored: bool,
}

/// The texels that two triangles claim for two places; none if every texel has one place.
pub(super) fn shared(layout: &Layout) -> Option<Shared> {
    let Layout { positions, uvs, triangles, parts } = *layout;
    let (low, high) =
        positions.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), position| {
            (low.min(*position), high.max(*position))
        });
    let one_place = ONE_PLACE * (high - low).length();
    let mut first = vec![NONE; SIDE * SIDE];
    let mut twice = vec![false; SIDE * SIDE];
    let mut pairs: HashMap<[u32; 2], [usize; 2]> = HashMap::new();
    let place = |triangle: u32, centre: DVec2| {
        let corners = triangles[triangle as usize].map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| uvs[corner] * SIDE as f64);
        let weights = [
            (b - centre).perp_dot(c - centre),
            (c - centre).perp_dot(a - centre),
            (a - centre).perp_dot(b - centre),
        ];
        let sum: f64 = weights.iter().sum();
        corners.into_iter().zip(weights).map(|(c, w)| positions[c] * (w / sum)).sum::<DVec3>()
    };
    for (index, triangle) in triangles.iter().enumerate() {
        let index = index as u32;
        let area = twice_area(uvs, triangle);
        if area.abs() <= LINE {
            continue;
        }
        let corners = triangle.map(|corner| uvs[corner as usize] * SIDE as f64);
        each_centre(corners, area > 0.0, |texel, centre| {
            let other = first[texel];
            if other == NONE {
                first[texel] = index;
            } else if !twice[texel]
                && place(index, centre).distance(place(other, centre)) > one_place
            {
                twice[texel] = true;
                let mut pair = [index, other].map(|t| parts.of[t as usize]);
                pair.sort_unstable();
                let mirrored = (twice_area(uvs, &triangles[other as usize]) > 0.0) != (area > 0.0);
                pairs.entry(pair).or_default()[usize::from(mirrored)] += 1;
            }
        });
    }
    let claimed = first.iter().filter(|triangle| **triangle != NONE).count();
    let count: usize = pairs.values().flatten().sum();
    let most = pairs.iter().max_by_key(|(pair, counts)| (counts.iter().sum::<usize>(), **pair));
    most.map(|(pair, [alike, mirrored])| Shared {
        share: count as f64 / claimed as f64,
        parts: *pair,
        mirrored: mirrored > alike,
    })
}

/// Calls `claim` with every texel of the grid whose centre lies in a triangle.
fn each_centre(corners: [DVec2; 3], is_left: bool, mut claim: impl FnMut(usize, DVec2)) {
    let [a, b, c] = corners;
    let edges = [(a, b), (b, c), (c, a)];
    let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
    let high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
    for row in texels(low.y, high.y) {
        let y = row as f64 + 0.5;
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for (from, to) in edges {
            if (from.y - y) * (to.y - y) <= 0.0 {
                let along = if from.y == to.y { 0.0 } else { (y - from.y) / (to.y - from.y) };
                let x = from.x + along * (to.x - from.x);
                (left, right) = (left.min(x), right.max(x));
            }
        }
        // A texel more on both sides, since the crossings are rounded; the edges decide.
        for column in texels(left - 1.0, right + 1.0) {
            let centre = DVec2::new(column as f64 + 0.5, y);
            if edges.iter().all(|(from, to)| lies_left(*from, *to, centre) == is_left) {
                claim(row * SIDE + column, centre);
            }
        }
    }
}

/// The texels along one axis whose centres lie between two places.
fn texels(low: f64, high: f64) -> std::ops::Range<usize> {
    let first = (low - 0.5).ceil().clamp(0.0, SIDE as f64);
    let last = (high - 0.5).floor().clamp(-1.0, SIDE as f64 - 1.0);
    first as usize..(last + 1.0) as usize
}

/// Returns whether a point lies left of an edge; of the edge and its reverse exactly one says so.
fn lies_left(from: DVec2, to: DVec2, point: DVec2) -> bool {
    let forwards = (from.x, from.y) < (to.x, to.y);
    let (start, end) = if forwards { (from, to) } else { (to, from) };
    ((end - start).perp_dot(point - start) >= 0.0) == forwards
}
