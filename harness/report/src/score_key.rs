//! The numbers that tables and figures show: the rows of the scores that each is made of.

use scoring::metrics::{Direction, Metric};
use scoring::score::Row;

use super::table::Column;

/// The lights of the pictures that a number is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lights {
    /// No light: a map, or a view that the method synthesised.
    None,
    /// The light of the capture.
    Own,
    /// All other lights.
    Others,
}

/// The key of a number: the rows of the scores over the whole region of a subject.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScoreKey {
    pub subject: &'static str,
    pub metric: &'static str,
    pub scale: &'static str,
    pub lights: Lights,
}

pub(super) const ALBEDO: ScoreKey = map("diffuse_albedo", "psnr_srgb", "global");
pub(super) const ALBEDO_AS_IS: ScoreKey = map("diffuse_albedo", "psnr_srgb", "none");
pub(super) const SPECULAR_ALBEDO: ScoreKey = map("specular_albedo", "rmse", "none");
pub(super) const SPECULAR_NORMAL: ScoreKey = map("specular_normal", "normal_mean_deg", "none");
pub(super) const DIFFUSE_NORMAL: ScoreKey = map("diffuse_normal", "normal_mean_deg", "none");
pub(super) const VIEW: ScoreKey = map("view", "psnr_srgb", "none");
pub(super) const RELIT_OWN: ScoreKey = relit(Lights::Own);
pub(super) const RELIT_OTHERS: ScoreKey = relit(Lights::Others);

/// The key of a map or a synthesised view.
pub(super) const fn map(
    subject: &'static str,
    metric: &'static str,
    scale: &'static str,
) -> ScoreKey {
    ScoreKey { subject, metric, scale, lights: Lights::None }
}

const fn relit(lights: Lights) -> ScoreKey {
    ScoreKey { subject: "relit", metric: "psnr_srgb", scale: "global", lights }
}

impl ScoreKey {
    /// The rows of a method in a case that was captured in the light `own`; of other lights one each, in the order
    /// of their names.
    pub fn rows<'a>(&self, column: &Column<'a>, own: &str) -> Vec<&'a Row> {
        // Scores against photographs have no factor.
        let scale = match column.factor() {
            None if self.subject == "relit" => "none",
            _ => self.scale,
        };
        let find = |light| column.find(self.subject, light, self.metric, scale);
        match self.lights {
            Lights::None => find(None).into_iter().collect(),
            Lights::Own => find(Some(own)).into_iter().collect(),
            Lights::Others => {
                let lights = other_lights(column, own).into_iter();
                lights.filter_map(|light| find(Some(light))).collect()
            }
        }
    }

    /// The mean of the rows that have a value; `None` without any.
    pub fn value(&self, column: &Column, own: &str) -> Option<f64> {
        mean(self.rows(column, own).iter().filter_map(|row| row.value))
    }

    /// The direction in which the metric improves.
    pub fn direction(&self) -> Direction {
        Metric::find(self.metric).map_or(Direction::Lower, |metric| metric.direction)
    }

    /// The id of the rows, as `unshade compare` names them.
    pub fn row_id(&self) -> String {
        let light = match self.lights {
            Lights::None => "",
            Lights::Own => "/<own light>",
            Lights::Others => "/<other lights, mean>",
        };
        let is_picture = self.subject.starts_with("view") || self.subject == "relit";
        let region = if is_picture { "mask-e5" } else { "coverage-e5" };
        format!("{}{light}/{}@{region}:{}", self.subject, self.metric, self.scale)
    }
}

/// The lights other than the capture's that the method was relit in, sorted.
pub(super) fn other_lights<'a>(column: &Column<'a>, own: &str) -> Vec<&'a str> {
    let mut lights: Vec<&str> =
        column.rows().iter().filter_map(|row| row.light.as_deref()).collect();
    lights.sort_unstable();
    lights.dedup();
    lights.retain(|light| *light != own);
    lights
}

/// The mean of the values; `None` without any.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
