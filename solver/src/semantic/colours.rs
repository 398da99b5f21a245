//! Regions of a face without labels: texels of like reflectance.
//!
//! Hair, brows and skin are told apart in the pictures' colours divided by the shading of a light that
//! explains them with one reflectance for each region; regions and light are found in turn. What parts
//! two regions must be an edge: where colours change slowly it is the light that changes, and the two
//! are one.

use std::collections::BTreeMap;

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::projection::{Observation, Projection, per_texel};
use formats::fill;
use formats::picture::Picture;
use glam::{DVec3, Vec3};

use super::clusters::{centres, clusters, lloyd};
use crate::config::{ColourRegionConfig, TransportConfig};
use crate::model::blur::Blur;
use crate::transport::{self, Beside, CHANNELS, Sky, Transport};

/// The regions of a chart and their colours.
#[derive(Clone, Debug)]
pub struct ColourRegions {
    /// Side of the chart, texels.
    side: usize,
    /// The region of every texel.
    regions: Vec<u8>,
    /// Linear RGB of every region, in the unit of the pictures.
    colours: Vec<Vec3>,
}

impl ColourRegions {
    /// `None` if the pictures are mostly black.
    pub fn new(
        mesh: &Mesh,
        projections: &[Projection],
        transport: &TransportConfig,
        config: &ColourRegionConfig,
    ) -> Option<Self> {
        let ColourRegionConfig { count, texture_size: side, rows, blur, luminance_weights, .. } =
            *config;
        let atlas = Atlas::new(mesh, side);
        let texel = |seen: &[(usize, Observation)]| {
            let colour = |(view, seen): &(usize, Observation)| {
                (seen.cosine * projections[*view].colour(seen)).extend(seen.cosine)
            };
            seen.iter().map(colour).sum::<glam::Vec4>().to_array()
        };
        let sums: Vec<[f32; 4]> = per_texel(&atlas, projections, texel);
        let smooth = Blur::new(side, 4, blur).apply(sums.as_flattened());
        let known: Vec<bool> = sums.iter().map(|sum| sum[3] > 0.0).collect();
        let seen: Vec<usize> = (0..known.len()).filter(|at| known[*at]).collect();
        let colour = |at: &usize| Vec3::from_slice(&smooth[4 * at..]) / smooth[4 * at + 3];
        let colours: Vec<Vec3> = seen.iter().map(colour).collect();
        let transport = TransportConfig { texture_size: side, rows, ..transport.clone() };
        let transport = Transport::new(mesh, &Sky::even(rows), &transport, 0, Beside::Nothing);

        let mut albedo = colours.clone();
        let mut regions = clusters(&features(&albedo, luminance_weights[0], config.dark)?, count);
        for _ in 0..config.rounds {
            let shading = shading(
                config,
                &transport,
                &seen,
                &colours,
                &means(&albedo, &regions, config),
                &regions,
            );
            albedo =
                colours.iter().zip(shading).map(|(colour, shading)| *colour / shading).collect();
            regions = lloyd(&features(&albedo, luminance_weights[1], config.dark)?, regions, count);
        }
        let regions = merged(config, &seen, &albedo, &regions);
        let mut map = vec![0; known.len()];
        seen.iter().zip(&regions).for_each(|(at, region)| map[*at] = *region);
        let nearest = fill::nearest_known(&known, side, side);
        Some(Self {
            side,
            regions: nearest.into_iter().map(|at| map[at as usize]).collect(),
            colours: means(&albedo, &regions, config),
        })
    }

    /// Every texel in the colour of its region, on a square map of `size` texels.
    pub fn albedo(&self, size: usize) -> Picture {
        let colour = |region: u8| self.colours[region as usize].to_array();
        let data = self.map(size).into_iter().flat_map(colour).collect();
        Picture { width: size, height: size, channels: 3, data }
    }

    /// The region of every texel of a chart of side `size`.
    pub fn map(&self, size: usize) -> Vec<u8> {
        let at = |i: usize| (2 * i + 1) * self.side / (2 * size);
        (0..size * size).map(|i| self.regions[at(i / size) * self.side + at(i % size)]).collect()
    }
}

fn luminance(colour: &Vec3) -> f32 {
    colour.dot(Vec3::from_array(transport::LUMINANCE)).max(0.0)
}

fn log(colour: Vec3, dark: f32) -> Vec3 {
    (colour.max(Vec3::ZERO) + dark).map(f32::ln)
}

/// [`ColourRegionConfig::dark`] in the unit of the colours; `None` of nothing but black.
fn dark(colours: &[Vec3], relative: f32) -> Option<f32> {
    let mut sorted: Vec<f32> = colours.iter().map(luminance).collect();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).filter(|median| **median > 0.0).map(|median| relative * median)
}

/// Points whose distances say how alike colours are.
fn features(colours: &[Vec3], weight: f32, relative: f32) -> Option<Vec<Vec3>> {
    let dark = dark(colours, relative)?;
    let feature = |colour: &Vec3| {
        let log = log(*colour, dark);
        Vec3::new(log.x - log.y, log.z - log.y, weight * (luminance(colour) + dark).ln())
    };
    Some(colours.iter().map(feature).collect())
}

/// The mean colour of every region; logarithmic, so that highlights have little say.
fn means(colours: &[Vec3], regions: &[u8], config: &ColourRegionConfig) -> Vec<Vec3> {
    let dark = dark(colours, config.dark).unwrap_or(f32::MIN_POSITIVE);
    let logs: Vec<Vec3> = colours.iter().map(|colour| log(*colour, dark)).collect();
    centres(&logs, regions, config.count).into_iter().map(|log| log.map(f32::exp)).collect()
}

/// The shading of the texels `seen` under the light that explains their colours best, of mean 1 in
/// every channel.
///
/// Least squares with weights towards L1, over light that is not negative, by multiplicative updates
/// (Lee and Seung 2001).
fn shading(
    config: &ColourRegionConfig,
    transport: &Transport,
    seen: &[usize],
    colours: &[Vec3],
    means: &[Vec3],
    regions: &[u8],
) -> Vec<Vec3> {
    let wanted: Vec<Vec3> = colours
        .iter()
        .zip(regions)
        .map(|(c, region)| c.max(Vec3::ZERO) / means[*region as usize])
        .collect();
    let mut light = vec![1.0_f32; 3 * transport.cells()];
    let of = |light: &[f32]| -> Vec<Vec3> {
        let all = transport.shading(light);
        seen.iter().map(|at| Vec3::from_slice(&all[3 * at..])).collect()
    };
    let back = |values: &dyn Fn(usize) -> Vec3| {
        let mut all = vec![0.0; CHANNELS * transport.size().pow(2)];
        for (i, at) in seen.iter().enumerate() {
            all[3 * at..][..3].copy_from_slice(&values(i).to_array());
        }
        transport.adjoint(&all)
    };
    let most = means.iter().fold(0.0f32, |m, a| m.max(luminance(a)));
    let share = |i: usize| luminance(&means[regions[i] as usize]) / most;
    for _ in 0..config.light_steps {
        let found = of(&light);
        let weight =
            |i: usize| share(i) * ((wanted[i] - found[i]).abs() + config.residual_floor).recip();
        let up = back(&|i| weight(i) * wanted[i]);
        let down = back(&|i| weight(i) * found[i]);
        for (light, (up, down)) in light.iter_mut().zip(up.iter().zip(&down)) {
            *light *= up / down.max(f32::MIN_POSITIVE);
        }
    }
    let shading = of(&light);
    let mean = shading.iter().map(|s| s.as_dvec3()).sum::<DVec3>() / shading.len() as f64;
    let mean = mean.as_vec3().max(Vec3::splat(f32::MIN_POSITIVE));
    // What the light hardly reaches says nothing of its colour.
    shading.into_iter().map(|s| (s / mean).max(Vec3::splat(config.shading_floor))).collect()
}

/// The regions without boundaries that are no edges. What is tested are the connected parts of regions: hair
/// ends in an edge where the shadow of a chin, of the same region so far, does not. The smaller of two parts
/// takes the region of the larger one, and specks that of a neighbour.
fn merged(config: &ColourRegionConfig, seen: &[usize], albedo: &[Vec3], regions: &[u8]) -> Vec<u8> {
    let ColourRegionConfig { texture_size: side, edge_distance: across, edge, .. } = *config;
    let dark = dark(albedo, config.dark).unwrap_or(f32::MIN_POSITIVE);
    let mut region = vec![None; side * side];
    seen.iter().zip(regions).for_each(|(at, r)| region[*at] = Some(*r));
    let part = parts(&region, side);
    let logs: BTreeMap<usize, Vec3> =
        seen.iter().zip(albedo).map(|(at, albedo)| (*at, log(*albedo, dark))).collect();
    // By first and second part: the sum of differences across their boundary, and their number.
    let mut jumps: BTreeMap<(usize, usize), (Vec3, f32)> = BTreeMap::new();
    for (at, here) in &logs {
        let right = (at % side + across < side).then(|| at + across);
        let below = (at / side + across < side).then(|| at + across * side);
        for other in right.into_iter().chain(below) {
            let (a, b) = (part[*at], part[other]);
            if let Some(there) = logs.get(&other).filter(|_| a != b) {
                let (pair, jump) =
                    if a < b { ((a, b), *there - *here) } else { ((b, a), *here - *there) };
                let sum = jumps.entry(pair).or_default();
                *sum = (sum.0 + jump, sum.1 + 1.0);
            }
        }
    }
    let mut sizes = vec![0; part.len()];
    seen.iter().for_each(|at| sizes[part[*at]] += 1);
    let mut joined: Vec<usize> = (0..part.len()).collect();
    loop {
        let height = |(jump, pairs): &(Vec3, f32)| jump.length() / pairs;
        let joins = |((a, b), jump): &(&(usize, usize), &(Vec3, f32))| {
            let small = sizes[*a].min(sizes[*b]) < config.edge_pairs;
            small || jump.1 >= config.edge_pairs as f32 && height(jump) < edge
        };
        let least = jumps.iter().filter(joins).min_by(|a, b| height(a.1).total_cmp(&height(b.1)));
        let Some((&(a, b), _)) = least else { break };
        let (into, from) = if sizes[a] < sizes[b] { (b, a) } else { (a, b) };
        sizes[into] += sizes[from];
        joined.iter_mut().filter(|part| **part == from).for_each(|part| *part = into);
        let renamed = std::mem::take(&mut jumps);
        for ((a, b), (jump, pairs)) in renamed {
            let [x, y] = [a, b].map(|part| if part == from { into } else { part });
            if x != y {
                let (pair, jump) = if x < y { ((x, y), jump) } else { ((y, x), -jump) };
                let sum = jumps.entry(pair).or_default();
                *sum = (sum.0 + jump, sum.1 + pairs);
            }
        }
    }
    seen.iter().map(|at| region[joined[part[*at]]].unwrap_or(0)).collect()
}

/// The connected part of its region that every texel belongs to, named by its first texel.
fn parts(region: &[Option<u8>], side: usize) -> Vec<usize> {
    let mut part: Vec<usize> = (0..region.len()).collect();
    for first in 0..region.len() {
        if region[first].is_none() || part[first] != first {
            continue;
        }
        let mut open = vec![first];
        while let Some(at) = open.pop() {
            let beside = [
                (at % side > 0).then(|| at - 1),
                (at % side + 1 < side).then_some(at + 1),
                at.checked_sub(side),
                (at + side < region.len()).then_some(at + side),
            ];
            for next in beside.into_iter().flatten() {
                if next > first && part[next] == next && region[next] == region[first] {
                    part[next] = first;
                    open.push(next);
                }
            }
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use capture::View;
    use capture::gbuffer::GBuffer;

    use super::*;
    use crate::Config;
    use crate::testing;

    const SKIN: Vec3 = Vec3::new(0.5, 0.3, 0.2);
    const HAIR: Vec3 = Vec3::new(0.08, 0.06, 0.05);

    /// A dome in light from one side, four times as bright there as on the other.
    fn found(albedo: impl Fn(Vec3) -> Vec3) -> Option<ColourRegions> {
        let mesh = testing::dome(24);
        let colour = |p: Vec3| (albedo(p) * (0.625 + 0.375 * p.y), 0);
        let views: Vec<View> =
            testing::rig(3, 96).iter().map(|c| testing::view(&mesh, c, colour)).collect();
        let gbuffers = GBuffer::of_views(&mesh, &views);
        let projections = Projection::of_views(&views, &gbuffers);
        let config = Config::default();
        ColourRegions::new(&mesh, &projections, &config.transport, &config.colour_regions)
    }

    /// The texels of the chart's disc, with where they lie from its centre.
    fn inside() -> impl Iterator<Item = (usize, f32, f32)> {
        let from_centre = |at: usize| (at as f32 + 0.5) / 64.0 - 0.5;
        (0..64 * 64)
            .map(move |at| (at, from_centre(at % 64), from_centre(at / 64)))
            .filter(|(_, x, y)| x.hypot(*y) < 0.3)
    }

    #[test]
    fn shading_makes_no_regions() {
        let regions = found(|_| SKIN).unwrap().map(64);
        let first = regions[64 * 32 + 32];
        assert!(inside().all(|(at, ..)| regions[at] == first));
    }

    #[test]
    fn hair_and_skin_are_two_regions_in_shade_and_in_light() {
        let found = found(|p| if p.x > 0.3 { HAIR } else { SKIN }).unwrap();
        let (regions, albedo) = (found.map(64), found.albedo(64));
        let edge = 0.4 * 0.3_f32.asin() / 0.2_f32.acos();
        let clear: Vec<_> = inside().filter(|(_, x, _)| (x - edge).abs() > 0.06).collect();
        let of = |hair: bool| clear.iter().filter(move |(_, x, _)| (*x > edge) == hair);
        let region = |hair: bool| regions[of(hair).next().unwrap().0];
        assert_ne!(region(true), region(false));
        for hair in [true, false] {
            let wrong = of(hair).filter(|(at, ..)| regions[*at] != region(hair)).count();
            assert!(50 * wrong < of(hair).count(), "{wrong} of {}", of(hair).count());
        }
        let colour = |hair: bool| Vec3::from_slice(&albedo.data[3 * of(hair).next().unwrap().0..]);
        let ratio = colour(true) / colour(false) / (HAIR / SKIN);
        assert!((ratio - 1.0).abs().max_element() < 0.3, "{ratio}");
    }

    /// Hair ends in an edge at the right, skin grows as dark as hair at the left, with a speck in the middle.
    #[test]
    fn a_shadow_is_no_hair_where_no_edge_parts_it_from_skin() {
        let side = 32;
        let texture_size = side;
        let config = ColourRegionConfig { texture_size, ..Config::default().colour_regions };
        let seen: Vec<usize> = (0..side * side).collect();
        let column = |at: &usize| at % side;
        let shade = |x: usize| HAIR.lerp(SKIN, (x as f32 / 14.0).min(1.0));
        let albedo: Vec<Vec3> =
            seen.iter().map(column).map(|x| if x < 24 { shade(x) } else { HAIR }).collect();
        let speck = 16 * side + 18;
        let dark = |at: &usize| u8::from(!(5..24).contains(&column(at)) || *at == speck);
        let regions: Vec<u8> = seen.iter().map(dark).collect();
        let found = merged(&config, &seen, &albedo, &regions);
        assert!(found.iter().zip(&seen).all(|(found, at)| *found == u8::from(column(at) >= 24)));
    }

    #[test]
    fn of_black_pictures_nothing_is_known() {
        assert!(found(|_| Vec3::ZERO).is_none());
    }
}
