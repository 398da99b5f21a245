//! Connected pieces of a UV layout.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::surface::twice_area;

/// Share of the layout's area that counts: specks besides the islands of a face cost nothing.
const MOST: f64 = 0.95;

/// The least number of islands that hold most of the layout's area.
pub(super) fn most(positions: &[DVec3], uvs: &[DVec2], triangles: &[[u32; 3]]) -> usize {
    // Vertices that are split for their normals alone are one in the layout.
    let mut first = HashMap::with_capacity(positions.len());
    let key = |vertex: usize| {
        let (position, uv) = (positions[vertex] + DVec3::ZERO, uvs[vertex] + DVec2::ZERO);
        (position.to_array().map(f64::to_bits), uv.to_array().map(f64::to_bits))
    };
    let mut above: Vec<usize> =
        (0..positions.len()).map(|vertex| *first.entry(key(vertex)).or_insert(vertex)).collect();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| root(&mut above, corner as usize));
        let least = a.min(b).min(c);
        for end in [a, b, c] {
            above[end] = least;
        }
    }
    let mut areas: HashMap<usize, f64> = HashMap::new();
    for triangle in triangles {
        let island = root(&mut above, triangle[0] as usize);
        *areas.entry(island).or_default() += twice_area(uvs, triangle).abs();
    }
    let mut areas: Vec<f64> = areas.into_values().collect();
    areas.sort_by(|a, b| b.total_cmp(a));
    let enough = MOST * areas.iter().sum::<f64>();
    let mut sum = 0.0;
    let reached = areas.iter().position(|area| {
        sum += area;
        sum >= enough
    });
    reached.map_or(areas.len(), |last| last + 1)
}

/// The vertex that stands for the island of another.
fn root(above: &mut [usize], mut vertex: usize) -> usize {
    while above[vertex] != vertex {
        above[vertex] = above[above[vertex]];
        vertex = above[vertex];
    }
    vertex
}
