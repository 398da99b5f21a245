//! Merging of regions whose boundaries are not edges.

use std::collections::BTreeMap;

use glam::Vec3;

use super::chart::{dark, log};
use super::parts::parts;
use super::settings::ColourSettings;

/// Merges connected parts of regions, of the texels `seen`, whose boundary is not an edge. Hair has an edge; the shadow
/// of a chin, in the same region so far, has none. The smaller of two parts takes the region of the larger one, and
/// parts that are too small that of a neighbour. After each merge, `relit` may return a better albedo for the remaining
/// parts.
pub(super) fn merged(
    config: &ColourSettings,
    seen: &[usize],
    albedo: &[Vec3],
    regions: &[u8],
    mut relit: impl FnMut(&[u8]) -> Option<Vec<Vec3>>,
) -> Vec<u8> {
    let side = config.texture_size;
    let mut region = vec![None; side * side];
    seen.iter().zip(regions).for_each(|(at, r)| region[*at] = Some(*r));
    let mut part = parts(&region, side);
    let mut albedo = albedo.to_vec();
    loop {
        let mut boundaries = Boundaries::new(config, seen, &albedo, &part);
        while let Some(pair) =
            boundaries.least(|sizes, _| sizes[0].min(sizes[1]) < config.edge_pairs)
        {
            boundaries.join(pair, &mut part);
        }
        let is_no_edge = |boundary: &Boundary| {
            boundary.pairs >= config.edge_pairs && boundary.height() < config.edge
        };
        let Some(pair) = boundaries.least(|_, boundary| is_no_edge(boundary)) else { break };
        boundaries.join(pair, &mut part);
        albedo = relit(&boundaries.named(seen, &part)).unwrap_or(albedo);
    }
    seen.iter().map(|at| region[part[*at]].unwrap_or(0)).collect()
}

/// The differences across a boundary.
#[derive(Clone, Copy, Default)]
struct Boundary {
    /// The sum of the differences in log colour, second part minus first part.
    jump: Vec3,
    /// Pairs of texels.
    pairs: usize,
}

impl Boundary {
    fn add(&mut self, jump: Vec3, pairs: usize) {
        self.jump += jump;
        self.pairs += pairs;
    }

    /// The mean difference.
    fn height(&self) -> f32 {
        self.jump.length() / self.pairs as f32
    }
}

/// The boundaries of connected parts; a part is named by one of its texels.
struct Boundaries {
    /// The boundaries by first and second part.
    between: BTreeMap<(usize, usize), Boundary>,
    /// The number of texels of every part.
    sizes: BTreeMap<usize, usize>,
}

impl Boundaries {
    fn new(config: &ColourSettings, seen: &[usize], albedo: &[Vec3], part: &[usize]) -> Self {
        let ColourSettings { texture_size: side, edge_distance: across, .. } = *config;
        let dark = dark(albedo, config.dark).unwrap_or(f32::MIN_POSITIVE);
        let mut logs = vec![None; side * side];
        seen.iter().zip(albedo).for_each(|(at, albedo)| logs[*at] = Some(log(*albedo, dark)));
        let mut it = Self { between: BTreeMap::new(), sizes: BTreeMap::new() };
        for at in seen {
            *it.sizes.entry(part[*at]).or_default() += 1;
            let right = (at % side + across < side).then(|| at + across);
            let below = (at / side + across < side).then(|| at + across * side);
            for other in right.into_iter().chain(below) {
                if let Some((here, there)) = logs[*at].zip(logs[other]) {
                    it.add((part[*at], part[other]), there - here, 1);
                }
            }
        }
        it
    }

    fn add(&mut self, (a, b): (usize, usize), jump: Vec3, pairs: usize) {
        if a != b {
            let (pair, jump) = if a < b { ((a, b), jump) } else { ((b, a), -jump) };
            self.between.entry(pair).or_default().add(jump, pairs);
        }
    }

    /// The weakest of the boundaries that `of` accepts, given the numbers of texels of both parts and the boundary.
    fn least(&self, of: impl Fn([usize; 2], &Boundary) -> bool) -> Option<(usize, usize)> {
        let some = self
            .between
            .iter()
            .filter(|((a, b), boundary)| of([self.sizes[a], self.sizes[b]], boundary));
        some.min_by(|a, b| a.1.height().total_cmp(&b.1.height())).map(|(pair, _)| *pair)
    }

    /// Merges the smaller part into the larger one.
    fn join(&mut self, (a, b): (usize, usize), part: &mut [usize]) {
        let (into, from) = if self.sizes[&a] < self.sizes[&b] { (b, a) } else { (a, b) };
        part.iter_mut().filter(|part| **part == from).for_each(|part| *part = into);
        let texels = self.sizes.remove(&from).unwrap_or_default();
        self.sizes.entry(into).and_modify(|size| *size += texels);
        let renamed = |part| if part == from { into } else { part };
        for ((a, b), Boundary { jump, pairs }) in std::mem::take(&mut self.between) {
            self.add((renamed(a), renamed(b)), jump, pairs);
        }
    }

    /// The rank of every visible texel's part by size, the largest first; the smallest parts share one rank.
    fn named(&self, seen: &[usize], part: &[usize]) -> Vec<u8> {
        let mut parts: Vec<(usize, usize)> =
            self.sizes.iter().map(|(part, size)| (*size, *part)).collect();
        parts.sort_by(|a, b| b.cmp(a));
        let names: BTreeMap<usize, u8> = parts
            .iter()
            .enumerate()
            .map(|(rank, (_, part))| (*part, rank.min(255) as u8))
            .collect();
        seen.iter().map(|at| names[&part[*at]]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::settings::Settings;
    use super::*;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);
    const HAIR: Vec3 = Vec3::new(0.08, 0.06, 0.05);

    /// Hair ends in an edge at the right, skin grows as dark as hair to the left, with a speck in the middle.
    #[test]
    fn a_shadow_without_an_edge_is_merged_with_skin() {
        let side = 32;
        let texture_size = side;
        let config = ColourSettings { texture_size, ..Settings::default().colour_regions };
        let seen: Vec<usize> = (0..side * side).collect();
        let column = |at: &usize| at % side;
        let shade = |x: usize| HAIR * (SKIN / HAIR).powf((x as f32 / 20.0).min(1.0));
        let albedo: Vec<Vec3> =
            seen.iter().map(column).map(|x| if x < 24 { shade(x) } else { HAIR }).collect();
        let speck = 16 * side + 18;
        let dark = |at: &usize| u8::from(!(5..24).contains(&column(at)) || *at == speck);
        let regions: Vec<u8> = seen.iter().map(dark).collect();
        let found = merged(&config, &seen, &albedo, &regions, |_| None);
        assert!(found.iter().zip(&seen).all(|(found, at)| *found == u8::from(column(at) >= 24)));
    }
}
