//! The residual of a chart under the best light, with one reflectance for the skin and another for a part of it.

use capture::Mesh;
use glam::Vec3;

use super::chart::{Chart, Lobes, means};
use super::lamps::Lamps;
use super::settings::ColourSettings;
use super::settings::Settings;

/// A light, and the skin that it lights.
pub(super) struct Explanation<'a> {
    chart: &'a Chart,
    regions: &'a ColourSettings,
    cells: Lobes,
    lamps: Option<Lamps>,
    /// The label of every visible texel.
    pub labels: Vec<u8>,
    /// Whether a visible texel is lit skin.
    pub is_skin: Vec<bool>,
    /// The label of skin, and an unused one.
    pub skin_and_free: [u8; 2],
    /// The fit with these labels.
    pub before: Explained,
}

/// The fit of a light to a chart with some labels.
#[derive(Default)]
pub(super) struct Explained {
    /// The albedo of every visible texel, linear R, G, B, up to one factor per channel.
    pub albedo: Vec<Vec3>,
    /// The mean albedo of every label.
    pub means: Vec<Vec3>,
    /// The [`residuals`] of the visible texels.
    pub residuals: Vec<f32>,
}

impl<'a> Explanation<'a> {
    /// Fits free cells, or one lamp with uniform ambient light if that has a smaller residual. `None` without skin.
    pub fn new(
        mesh: &Mesh,
        chart: &'a Chart,
        config: &'a Settings,
        labels: &[u8],
        skin: &[u8],
    ) -> Option<Self> {
        let regions = &config.colour_regions;
        let first = *skin.first()?;
        let of = |at: &usize| if skin.contains(&labels[*at]) { first } else { labels[*at] };
        let labels: Vec<u8> = chart.seen.iter().map(of).collect();
        let mut unused = (1..=u8::MAX).filter(|label| !labels.contains(label));
        let (free, unlit) = (unused.next()?, unused.next()?);
        let is_skin: Vec<bool> = labels.iter().map(|label| *label == first).collect();
        let cells = Lobes::new(regions.rows, 0.0);
        let skin_and_free = [first, free];
        let lamps = Lamps::new(mesh, chart, &config.hair_in_skin, &is_skin);
        let mut it = Self {
            chart,
            regions,
            cells,
            lamps: None,
            labels,
            is_skin,
            skin_and_free,
            before: Explained::default(),
        };
        it.before = it.with(&it.labels);
        let Some(lamps) = lamps else { return Some(it) };
        let (left, lit) = (sum(&it.before.residuals, &it.is_skin), chart.eroded(&lamps.lit, 1));
        it.lamps = Some(lamps);
        if sum(&it.with(&it.labels).residuals, &it.is_skin) >= left {
            return Some(Self { lamps: None, ..it });
        }
        // Texels outside of the lamp's light carry no information, nor do its blurred edges.
        let dark = it.labels.iter_mut().zip(&lit).filter(|(label, lit)| **label == first && !**lit);
        dark.for_each(|(label, _)| *label = unlit);
        it.is_skin = lit;
        it.before = it.with(&it.labels);
        Some(it)
    }

    /// The lamps and the skin that they light, if their residual is the smallest.
    pub fn lamps(&self) -> Option<(&Lamps, &[bool])> {
        self.lamps.as_ref().map(|lamps| (lamps, self.is_skin.as_slice()))
    }

    /// Fits the light to some labels.
    pub fn with(&self, labels: &[u8]) -> Explained {
        let albedo = match &self.lamps {
            None => self.chart.albedo(self.regions, &self.cells, labels),
            Some(lamps) => {
                let second: Vec<bool> =
                    labels.iter().map(|label| *label == self.skin_and_free[1]).collect();
                lamps.albedo(self.chart, &self.is_skin, &second)
            }
        };
        let means = means(&albedo, labels, self.regions.dark);
        Explained { residuals: residuals(&albedo, &means, labels), means, albedo }
    }

    /// The fit with a separate reflectance for a part of the skin, and its ratio to that of skin.
    pub fn with_part(&self, inside: &[bool]) -> (Explained, Vec3) {
        let [first, free] = self.skin_and_free;
        let own = |(label, inside): (&u8, &bool)| if *inside { free } else { *label };
        let explained = self.with(&self.labels.iter().zip(inside).map(own).collect::<Vec<_>>());
        let ratio = explained.means[usize::from(free)] / explained.means[usize::from(first)];
        (explained, ratio)
    }

    /// [`Self::with_part`], if it reduces the residuals to at most these shares: of all skin, and of the part. Colours
    /// that are caused by the light have small residuals under free cells already.
    pub fn with_plausible_part(
        &self,
        inside: &[bool],
        most_left: [f32; 2],
    ) -> Option<(Explained, Vec3)> {
        let (after, ratio) = self.with_part(inside);
        let left = |of: &[bool]| sum(&after.residuals, of) / sum(&self.before.residuals, of);
        let is_plausible = left(&self.is_skin) < most_left[0] && left(inside) < most_left[1];
        is_plausible.then_some((after, ratio))
    }

    /// The albedo with one reflectance for the skin under a light of few unknowns: the lamp, or lobes of this width in
    /// radians.
    pub fn smooth_albedo(&self, lobe_width: f32) -> Vec<Vec3> {
        match &self.lamps {
            Some(_) => self.before.albedo.clone(),
            None => {
                let lobes = Lobes::new(self.regions.rows, lobe_width);
                self.chart.albedo(self.regions, &lobes, &self.labels)
            }
        }
    }

    /// Extends a set of visible texels to the whole chart: every other texel follows the nearest visible one, of lit
    /// skin under a lamp.
    pub fn filled(&self, inside: &[bool]) -> Vec<bool> {
        match &self.lamps {
            Some(_) => self.chart.filled(inside, &self.is_skin),
            None => self.chart.filled(inside, &vec![true; inside.len()]),
        }
    }
}

/// The sum of the residuals of the texels in `of`.
pub(super) fn sum(residuals: &[f32], of: &[bool]) -> f32 {
    residuals.iter().zip(of).filter(|(_, of)| **of).map(|(residual, _)| residual).sum()
}

/// The mean relative difference of every texel's channels from the mean of its region, at most 1.
pub(super) fn residuals(albedo: &[Vec3], means: &[Vec3], labels: &[u8]) -> Vec<f32> {
    let residual = |(albedo, label): (&Vec3, &u8)| {
        ((*albedo / means[usize::from(*label)] - 1.0).abs().element_sum() / 3.0).min(1.0)
    };
    albedo.iter().zip(labels).map(residual).collect()
}
