//! The columns of the tables.

use crate::metric;
use crate::score_key::{
    ALBEDO, ALBEDO_AS_IS, DIFFUSE_NORMAL, Lights, RELIT_OTHERS, RELIT_OWN, SPECULAR_ALBEDO,
    SPECULAR_NORMAL, ScoreKey, VIEW, map, mean,
};
use crate::table::Column;

/// A column of the tables.
#[derive(Debug)]
pub(super) struct Figure {
    /// Heading of the means.
    pub name: &'static str,
    /// Heading where there is little room.
    pub short: &'static str,
    pub decimals: usize,
    pub key: ScoreKey,
}

const fn figure(name: &'static str, short: &'static str, decimals: usize, key: ScoreKey) -> Figure {
    Figure { name, short, decimals, key }
}

/// Tables of a light, with their titles.
pub(super) const TABLES: [(&str, &[Figure]); 3] = [
    (
        "Diffuse albedo",
        &[
            figure("after one factor, dB", "albedo", 1, ALBEDO),
            figure("as is, dB", "as is", 1, ALBEDO_AS_IS),
            figure("factor", "factor", 3, albedo("scale_global")),
            figure("correlation within labels", "within labels", 2, albedo("wcorr")),
            figure("correlation of detail", "detail", 2, albedo("hc")),
            figure("residual shading", "shading", 3, albedo("lp")),
        ],
    ),
    (
        "Withheld views, PSNR in dB",
        &[
            figure("by the method itself", "view", 1, VIEW),
            figure("maps relit, own light", "relit, own", 1, RELIT_OWN),
            figure("maps relit, other lights", "relit, others", 1, RELIT_OTHERS),
        ],
    ),
    (
        "Normals and specular parts",
        &[
            figure("specular normal / mesh, °", "specular normal, °", 2, SPECULAR_NORMAL),
            figure("diffuse normal / mesh, °", "diffuse normal, °", 2, DIFFUSE_NORMAL),
            figure("specular layer, correlation", "layer, correlation", 2, layer("pearson")),
            figure("specular layer, energy", "layer, energy", 2, layer("energy_ratio")),
            figure("specular albedo, RMSE / best constant", "specular albedo", 4, SPECULAR_ALBEDO),
            figure("confidence, rank correlation", "confidence", 2, confidence("confidence_rank")),
            figure(
                "confidence, error of the trusted half",
                "trusted half",
                2,
                confidence("sparsification"),
            ),
        ],
    ),
];

const fn albedo(metric: &'static str) -> ScoreKey {
    map("diffuse_albedo", metric, "none")
}

const fn layer(metric: &'static str) -> ScoreKey {
    map("view_specular_layer", metric, "none")
}

const fn confidence(metric: &'static str) -> ScoreKey {
    map("confidence", metric, "global")
}

/// The value of a figure of one method in one case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    pub value: f64,
    /// The value of the trivial answer beside it.
    pub against: Option<f64>,
    /// The value that rendering noise alone would allow.
    pub floor: Option<f64>,
}

impl Figure {
    /// The subject of the trivial answer that stands beside it.
    pub fn against(&self) -> Option<&'static str> {
        metric::trivial(self.key.subject)
    }

    /// Looks the figure up; `None` if the method has no such score.
    pub fn find(&self, column: &Column, own: &str) -> Option<Found> {
        let rows = self.key.rows(column, own);
        let value = mean(rows.iter().filter_map(|row| row.value))?;
        let floor = mean(rows.iter().filter_map(|row| row.floor));
        let ScoreKey { metric, scale, lights, .. } = self.key;
        let against = self.against().filter(|_| lights == Lights::None);
        let against = against.and_then(|subject| column.find(subject, None, metric, scale)?.value);
        Some(Found { value, against, floor })
    }
}

#[cfg(test)]
mod tests {
    use scoring::metrics::Metric;

    use super::*;

    #[test]
    fn every_figure_is_a_metric_of_a_subject() {
        for figure in TABLES.iter().flat_map(|(_, figures)| *figures) {
            assert!(Metric::find(figure.key.metric).is_ok(), "{}", figure.name);
            let subject = figure.key.subject;
            assert_ne!(metric::subject(subject), subject, "{}", figure.name);
        }
    }
}
