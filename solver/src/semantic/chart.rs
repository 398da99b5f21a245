//! The mean colours of a face on a chart, and a light fitted to them with one reflectance for each region.

use capture::Mesh;
use capture::gbuffer::Atlas;
use capture::projection::{Observation, Projection, per_texel};
use formats::fill;
use glam::{DVec3, Vec3};

use super::clusters::centres;
use super::settings::{ColourSettings, TransportConfig};
use crate::model::blur::Blur;
use crate::transport::{self, CHANNELS, Sky, Transport};

/// The visible texels of a chart with their colours.
pub(super) struct Chart {
    /// The visible texels.
    pub seen: Vec<usize>,
    /// The mean colours of the visible texels, linear RGB in the unit of the pictures.
    pub colours: Vec<Vec3>,
    /// Side of the chart, texels.
    pub side: usize,
    transport: Transport,
}

impl Chart {
    pub fn new(
        mesh: &Mesh,
        projections: &[Projection],
        transport: &TransportConfig,
        config: &ColourSettings,
    ) -> Self {
        let ColourSettings { texture_size: side, rows, blur, .. } = *config;
        let atlas = Atlas::new(mesh, side);
        let texel = |seen: &[(usize, Observation)]| {
            let colour = |(view, seen): &(usize, Observation)| {
                (seen.cosine * projections[*view].colour(seen)).extend(seen.cosine)
            };
            seen.iter().map(colour).sum::<glam::Vec4>().to_array()
        };
        let sums: Vec<[f32; 4]> = per_texel(&atlas, projections, texel);
        let smooth = Blur::new(side, 4, blur).apply(sums.as_flattened());
        let seen: Vec<usize> = (0..sums.len()).filter(|at| sums[*at][3] > 0.0).collect();
        let colour = |at: &usize| Vec3::from_slice(&smooth[4 * at..]) / smooth[4 * at + 3];
        let transport = TransportConfig { texture_size: side, rows, ..transport.clone() };
        Self {
            colours: seen.iter().map(colour).collect(),
            side,
            transport: Transport::new(mesh, &Sky::lat_long(rows), &transport, 0),
            seen,
        }
    }

    /// The colours divided by the shading of the light that is fitted with one reflectance for each of the `regions`.
    pub fn albedo(&self, config: &ColourSettings, lobes: &Lobes, regions: &[u8]) -> Vec<Vec3> {
        let mut albedo = self.colours.clone();
        for _ in 0..config.rounds {
            let means = means(&albedo, regions, config.dark);
            albedo = self.divided(&self.shading(config, lobes, &means, regions));
        }
        albedo
    }

    /// Erosion: the texels whose visible neighbours up to `reach` texels away in both directions are all in the set.
    pub fn eroded(&self, of: &[bool], reach: usize) -> Vec<bool> {
        let mut outside = vec![false; self.side * self.side];
        self.seen.iter().zip(of).for_each(|(at, of)| outside[*at] = !of);
        let span = |x: usize| x.saturating_sub(reach)..=(x + reach).min(self.side - 1);
        let near = |at: &usize| {
            let at = *at;
            span(at / self.side).flat_map(move |y| span(at % self.side).map(move |x| (x, y)))
        };
        self.seen.iter().map(|at| near(at).all(|(x, y)| !outside[y * self.side + x])).collect()
    }

    /// Extends the values of the `known` visible texels to the whole chart: every other texel has the value of the
    /// nearest known one.
    pub fn filled<T: Copy>(&self, values: &[T], known: &[bool]) -> Vec<T> {
        let mut map = vec![None; self.side * self.side];
        let some = self.seen.iter().zip(values).zip(known).filter(|(_, known)| **known);
        some.for_each(|((at, value), _)| map[*at] = Some(*value));
        let is_known: Vec<bool> = map.iter().map(Option::is_some).collect();
        let nearest = fill::nearest_known(&is_known, self.side, self.side);
        nearest.into_iter().filter_map(|at| map[at as usize]).collect()
    }

    /// The number of cells of the light.
    pub fn cells(&self) -> usize {
        self.transport.cells()
    }

    /// The share of every cell of radiance 1 in the shading of a texel, by its index among the visible texels.
    pub fn row(&self, at: usize) -> &[f32] {
        self.transport.cells_of(self.seen[at])
    }

    /// The shading of the visible texels under a uniform light of radiance 1.
    pub fn uniform_shading(&self) -> Vec<f32> {
        let all = self.transport.shading(&vec![1.0; CHANNELS * self.transport.cells()]);
        self.seen.iter().map(|at| all[CHANNELS * at]).collect()
    }

    /// The colours divided by a `shading`.
    pub fn divided(&self, shading: &[Vec3]) -> Vec<Vec3> {
        self.colours.iter().zip(shading).map(|(colour, shading)| *colour / *shading).collect()
    }

    /// The shading of the visible texels under the fitted light, of mean 1 in every channel, after a fixed number of
    /// updates. The thresholds of hair are for this shading, and regions by colour start from it; [`super::cell_light`]
    /// solves to convergence.
    ///
    /// Non-negative least squares reweighted towards L1, by multiplicative updates (Lee and Seung 2001).
    pub fn shading(
        &self,
        config: &ColourSettings,
        lobes: &Lobes,
        means: &[Vec3],
        regions: &[u8],
    ) -> Vec<Vec3> {
        let Self { seen, colours, transport, .. } = self;
        let wanted: Vec<Vec3> = colours
            .iter()
            .zip(regions)
            .map(|(c, region)| c.max(Vec3::ZERO) / means[*region as usize])
            .collect();
        let mut light = vec![1.0_f32; 3 * transport.cells()];
        let of = |light: &[f32]| -> Vec<Vec3> {
            let all = transport.shading(&lobes.light(light));
            seen.iter().map(|at| Vec3::from_slice(&all[3 * at..])).collect()
        };
        let back = |values: &dyn Fn(usize) -> Vec3| {
            let mut all = vec![0.0; CHANNELS * transport.size().pow(2)];
            for (i, at) in seen.iter().enumerate() {
                all[3 * at..][..3].copy_from_slice(&values(i).to_array());
            }
            lobes.adjoint(transport.adjoint(&all))
        };
        let most = means.iter().fold(0.0f32, |m, a| m.max(luminance(a)));
        let share = |i: usize| luminance(&means[regions[i] as usize]) / most;
        for _ in 0..config.light_steps {
            let found = of(&light);
            let weight = |i: usize| {
                share(i) * ((wanted[i] - found[i]).abs() + config.residual_floor).recip()
            };
            let up = back(&|i| weight(i) * wanted[i]);
            let down = back(&|i| weight(i) * found[i]);
            for (light, (up, down)) in light.iter_mut().zip(up.iter().zip(&down)) {
                *light *= up / down.max(f32::MIN_POSITIVE);
            }
        }
        let shading = of(&light);
        let mean = shading.iter().map(|s| s.as_dvec3()).sum::<DVec3>() / shading.len() as f64;
        let mean = mean.as_vec3().max(Vec3::splat(f32::MIN_POSITIVE));
        // Texels with little light carry no information on its colour.
        shading.into_iter().map(|s| (s / mean).max(Vec3::splat(config.shading_floor))).collect()
    }
}

/// The basis of the light of a [`Chart`]: its cells, or lobes around them.
pub(super) struct Lobes {
    /// The radiance of each lobe in each cell, lobe by lobe; empty if every lobe is a cell.
    radiance: Vec<f32>,
    cells: usize,
}

impl Lobes {
    /// Lobes of a `width` in radians on a sky of `rows` rows; 0 for the cells.
    pub fn new(rows: usize, width: f32) -> Self {
        let cells = Sky::lat_long(rows).centres();
        let radiance = |lobe: &Vec3| -> Vec<f32> {
            let of = |cell: &Vec3| ((lobe.dot(*cell) - 1.0) / width.powi(2)).exp();
            cells.iter().map(of).collect()
        };
        let radiance = if width > 0.0 { cells.iter().flat_map(radiance).collect() } else { vec![] };
        Self { radiance, cells: cells.len() }
    }

    /// The radiance of the cells, R, G, B each, from that of the lobes.
    fn light(&self, lobes: &[f32]) -> Vec<f32> {
        // The matrix of the lobes is symmetric.
        self.adjoint(lobes.to_vec())
    }

    /// The gradient with respect to the radiances of the lobes, from that with respect to the cells.
    fn adjoint(&self, by_cell: Vec<f32>) -> Vec<f32> {
        if self.radiance.is_empty() {
            return by_cell;
        }
        let mut by_lobe = vec![0.0; by_cell.len()];
        let (lobes, _) = by_lobe.as_chunks_mut::<CHANNELS>();
        for (lobe, radiance) in lobes.iter_mut().zip(self.radiance.chunks_exact(self.cells)) {
            for (cell, radiance) in by_cell.chunks_exact(CHANNELS).zip(radiance) {
                lobe.iter_mut().zip(cell).for_each(|(lobe, cell)| *lobe += radiance * cell);
            }
        }
        by_lobe
    }
}

pub(super) fn luminance(colour: &Vec3) -> f32 {
    transport::luminance::<f32>(&colour.to_array()).max(0.0)
}

/// Logarithms of a colour, brightened by `dark`.
pub(super) fn log(colour: Vec3, dark: f32) -> Vec3 {
    (colour.max(Vec3::ZERO) + dark).map(f32::ln)
}

/// A luminance `relative` to the median, in the unit of the colours; `None` if the median is black.
pub(super) fn dark(colours: &[Vec3], relative: f32) -> Option<f32> {
    let mut sorted: Vec<f32> = colours.iter().map(luminance).collect();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).filter(|median| **median > 0.0).map(|median| relative * median)
}

/// The region with most texels.
pub(super) fn largest(regions: &[u8]) -> u8 {
    let texels = |region: &u8| regions.iter().filter(|other| *other == region).count();
    (0..=u8::MAX).max_by_key(texels).unwrap_or(0)
}

/// The geometric mean colour of every region, on which highlights have little influence.
pub(super) fn means(colours: &[Vec3], regions: &[u8], relative: f32) -> Vec<Vec3> {
    let dark = dark(colours, relative).unwrap_or(f32::MIN_POSITIVE);
    let logs: Vec<Vec3> = colours.iter().map(|colour| log(*colour, dark)).collect();
    centres(&logs, regions, 256).into_iter().map(|log| log.map(f32::exp)).collect()
}
