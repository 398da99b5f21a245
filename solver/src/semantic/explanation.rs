//! How well one reflectance for the skin, and another for a part of it, explain a chart under the light that
//! does it best.

use capture::Mesh;
use glam::Vec3;

use super::chart::{Chart, Lobes, means};
use super::lamps::Lamps;
use super::settings::ColourSettings;
use super::settings::Settings;

/// A light, and the skin that it tells something of.
pub(super) struct Explanation<'a> {
    chart: &'a Chart,
    regions: &'a ColourSettings,
    cells: Lobes,
    lamps: Option<Lamps>,
    /// Of the texels seen.
    pub labels: Vec<u8>,
    /// Whether they are skin that the light shines on.
    pub is_skin: Vec<bool>,
    /// The label of skin, and one that no texel has.
    pub skin_and_free: [u8; 2],
    /// With these labels.
    pub before: Explained,
}

/// What a light makes of a chart with some labels.
#[derive(Default)]
pub(super) struct Explained {
    /// Of the texels seen, linear R, G, B, up to one factor each.
    pub albedo: Vec<Vec3>,
    /// Of every label.
    pub means: Vec<Vec3>,
    /// Of the texels seen, see [`residuals`].
    pub residuals: Vec<f32>,
}

impl<'a> Explanation<'a> {
    /// By free cells, or by one lamp in an even surrounding if that leaves less. `None` without skin.
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
        // Where the lamp does not shine nothing is known; nor at the edges, which it blurs.
        let dark = it.labels.iter_mut().zip(&lit).filter(|(label, lit)| **label == first && !**lit);
        dark.for_each(|(label, _)| *label = unlit);
        it.is_skin = lit;
        it.before = it.with(&it.labels);
        Some(it)
    }

    /// The lamps, and the skin that they shine on, if they explain it best.
    pub fn lamps(&self) -> Option<(&Lamps, &[bool])> {
        self.lamps.as_ref().map(|lamps| (lamps, self.is_skin.as_slice()))
    }

    /// With some labels.
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

    /// With a part of the skin that has a reflectance of its own, and that over skin's.
    pub fn with_part(&self, inside: &[bool]) -> (Explained, Vec3) {
        let [first, free] = self.skin_and_free;
        let own = |(label, inside): (&u8, &bool)| if *inside { free } else { *label };
        let explained = self.with(&self.labels.iter().zip(inside).map(own).collect::<Vec<_>>());
        let ratio = explained.means[usize::from(free)] / explained.means[usize::from(first)];
        (explained, ratio)
    }

    /// As [`Self::with_part`], if that leaves at most so much of the residuals: of all skin's, and of the part's. A
    /// light of all unknowns explains what light makes as it is, of whatever colour.
    pub fn bears_out(&self, inside: &[bool], most_left: [f32; 2]) -> Option<(Explained, Vec3)> {
        let (after, ratio) = self.with_part(inside);
        let left = |of: &[bool]| sum(&after.residuals, of) / sum(&self.before.residuals, of);
        let borne_out = left(&self.is_skin) < most_left[0] && left(inside) < most_left[1];
        borne_out.then_some((after, ratio))
    }

    /// The albedo of one skin under a light of few unknowns: the lamp's, or lobes so wide, radians.
    pub fn smooth_albedo(&self, lobe_width: f32) -> Vec<Vec3> {
        match &self.lamps {
            Some(_) => self.before.albedo.clone(),
            None => {
                let lobes = Lobes::new(self.regions.rows, lobe_width);
                self.chart.albedo(self.regions, &lobes, &self.labels)
            }
        }
    }

    /// What is known of skin that the light shines on, on the whole chart: any other texel takes the nearest one's.
    pub fn filled(&self, inside: &[bool]) -> Vec<bool> {
        match &self.lamps {
            Some(_) => self.chart.filled(inside, &self.is_skin),
            None => self.chart.filled(inside, &vec![true; inside.len()]),
        }
    }
}

/// The sum of the residuals `of` some texels.
pub(super) fn sum(residuals: &[f32], of: &[bool]) -> f32 {
    residuals.iter().zip(of).filter(|(_, of)| **of).map(|(residual, _)| residual).sum()
}

/// How far every texel is from the mean of its region: the mean relative difference of its channels, at most 1.
pub(super) fn residuals(albedo: &[Vec3], means: &[Vec3], labels: &[u8]) -> Vec<f32> {
    let residual = |(albedo, label): (&Vec3, &u8)| {
        ((*albedo / means[usize::from(*label)] - 1.0).abs().element_sum() / 3.0).min(1.0)
    };
    albedo.iter().zip(labels).map(residual).collect()
}
