//! The figures of the tables, each with the rows of the scores it is made of.

use scoring::metrics::Direction;

use crate::table::Column;

/// Which light a figure is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RelitIn {
    /// None: of a map, or of a view that the method made itself.
    No,
    /// The light of the capture.
    Own,
    /// The mean over all the others.
    Others,
}

/// A column of the tables.
#[derive(Debug)]
pub(super) struct Figure {
    /// Heading of the means.
    pub name: &'static str,
    /// Heading where there is little room.
    pub short: &'static str,
    pub subject: &'static str,
    pub metric: &'static str,
    pub scale: &'static str,
    pub region: &'static str,
    pub relit_in: RelitIn,
    /// The subject of the trivial answer that stands beside it.
    pub against: Option<&'static str>,
    pub better: Direction,
    pub decimals: usize,
}

/// Tables of a light, with their titles.
pub(super) const TABLES: [(&str, &[Figure]); 3] = [
    ("Diffuse albedo", &ALBEDO),
    ("Withheld views, PSNR in dB", &PICTURES),
    ("Normals and specular parts", &SHAPE),
];

const PLAIN: Figure = Figure {
    name: "",
    short: "",
    subject: "diffuse_albedo",
    metric: "psnr_srgb",
    scale: "none",
    region: "coverage-e5",
    relit_in: RelitIn::No,
    against: None,
    better: Direction::Higher,
    decimals: 1,
};

const ALBEDO: [Figure; 6] = [
    Figure { name: "after one factor, dB", short: "albedo", scale: "global", ..PLAIN },
    Figure { name: "as is, dB", short: "as is", ..PLAIN },
    Figure {
        name: "factor",
        short: "factor",
        metric: "scale_global",
        better: Direction::One,
        decimals: 3,
        ..PLAIN
    },
    Figure {
        name: "correlation within labels",
        short: "within labels",
        metric: "wcorr",
        decimals: 2,
        ..PLAIN
    },
    Figure { name: "correlation of detail", short: "detail", metric: "hc", decimals: 2, ..PLAIN },
    Figure {
        name: "residual shading",
        short: "shading",
        metric: "lp",
        better: Direction::Lower,
        decimals: 3,
        ..PLAIN
    },
];

const PICTURES: [Figure; 3] = [
    Figure {
        name: "by the method itself",
        short: "view",
        subject: "view",
        region: "mask-e5",
        ..PLAIN
    },
    Figure {
        name: "maps relit, own light",
        short: "relit, own",
        subject: "relit",
        scale: "global",
        region: "mask-e5",
        relit_in: RelitIn::Own,
        ..PLAIN
    },
    Figure {
        name: "maps relit, other lights",
        short: "relit, others",
        subject: "relit",
        scale: "global",
        region: "mask-e5",
        relit_in: RelitIn::Others,
        ..PLAIN
    },
];

const SHAPE: [Figure; 7] = [
    Figure {
        name: "specular normal / mesh, °",
        short: "specular normal, °",
        subject: "specular_normal",
        metric: "normal_mean_deg",
        against: Some("mesh_specular_normal"),
        better: Direction::Lower,
        decimals: 2,
        ..PLAIN
    },
    Figure {
        name: "diffuse normal / mesh, °",
        short: "diffuse normal, °",
        subject: "diffuse_normal",
        metric: "normal_mean_deg",
        against: Some("mesh_diffuse_normal"),
        better: Direction::Lower,
        decimals: 2,
        ..PLAIN
    },
    Figure {
        name: "specular layer, correlation",
        short: "layer, correlation",
        subject: "view_specular_layer",
        metric: "pearson",
        region: "mask-e5",
        decimals: 2,
        ..PLAIN
    },
    Figure {
        name: "specular layer, energy",
        short: "layer, energy",
        subject: "view_specular_layer",
        metric: "energy_ratio",
        region: "mask-e5",
        better: Direction::One,
        decimals: 2,
        ..PLAIN
    },
    Figure {
        name: "specular albedo, RMSE / best constant",
        short: "specular albedo",
        subject: "specular_albedo",
        metric: "rmse",
        against: Some("constant_specular_albedo"),
        better: Direction::Lower,
        decimals: 4,
        ..PLAIN
    },
    Figure {
        name: "confidence, rank correlation",
        short: "confidence",
        subject: "confidence",
        metric: "confidence_rank",
        scale: "global",
        better: Direction::Lower,
        decimals: 2,
        ..PLAIN
    },
    Figure {
        name: "confidence, error of the trusted half",
        short: "trusted half",
        subject: "confidence",
        metric: "sparsification",
        scale: "global",
        better: Direction::Lower,
        decimals: 2,
        ..PLAIN
    },
];

/// A figure of one method in one case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    pub value: f64,
    pub against: Option<f64>,
    /// Value that rendering noise alone would allow.
    pub floor: Option<f64>,
}

impl Figure {
    /// The row of the scores, as `unshade compare` names it.
    pub fn row_id(&self) -> String {
        let light = match self.relit_in {
            RelitIn::No => "",
            RelitIn::Own => "/<own light>",
            RelitIn::Others => "/<other lights, mean>",
        };
        format!("{}{light}/{}@{}:{}", self.subject, self.metric, self.region, self.scale)
    }

    /// Looks the figure up; none if the method has no such score.
    pub fn find(&self, column: &Column, own: &str) -> Option<Found> {
        // Scores against photographs have no factor.
        let scale = match column.factor() {
            None if self.subject == "relit" => "none",
            _ => self.scale,
        };
        let of = |subject: &str, light| column.find(subject, light, self.metric, scale);
        match self.relit_in {
            RelitIn::No | RelitIn::Own => {
                let light = (self.relit_in == RelitIn::Own).then_some(own);
                let row = of(self.subject, light)?;
                let against = self.against.and_then(|subject| of(subject, light)?.value);
                Some(Found { value: row.value?, against, floor: row.floor })
            }
            RelitIn::Others => {
                let others = others(column, own);
                let rows = others.iter().filter_map(|light| of(self.subject, Some(light)));
                let rows: Vec<_> = rows.collect();
                let value = mean(rows.iter().filter_map(|row| row.value))?;
                let floor = mean(rows.iter().filter_map(|row| row.floor));
                Some(Found { value, against: None, floor })
            }
        }
    }
}

/// The lights other than the capture's that the method was relit in, sorted.
pub(super) fn others<'a>(column: &Column<'a>, own: &str) -> Vec<&'a str> {
    let mut lights: Vec<&str> =
        column.rows().iter().filter_map(|row| row.light.as_deref()).collect();
    lights.sort_unstable();
    lights.dedup();
    lights.retain(|light| *light != own);
    lights
}

/// None of nothing.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

#[cfg(test)]
mod tests {
    use scoring::metrics::Metric;

    use super::*;
    use crate::metric;

    #[test]
    fn every_figure_is_a_metric_of_a_subject_and_knows_which_values_are_better() {
        for figure in TABLES.iter().flat_map(|(_, figures)| *figures) {
            let metric = Metric::find(figure.metric).unwrap();
            assert_eq!(figure.better, metric.direction, "{}", figure.name);
            assert_ne!(metric::subject(figure.subject), figure.subject, "{}", figure.name);
            let trivial =
                figure.against.is_none_or(|id| metric::trivial(figure.subject) == Some(id));
            assert!(trivial, "{}", figure.name);
        }
    }
}
