//! Figures by group of skin tone: the worst group, and how far it is from the best.

use serde::Serialize;

use super::Observation;
use super::faces::{Face, interval, mean, spread, welch};
use super::figures::{Figure, faces};

/// Groups of skin tone by the individual typology angle, degrees, above which each lies (Del Bino
/// et al. 2006).
const GROUPS: [(&str, f64); 6] = [
    ("very light", 55.0),
    ("light", 41.0),
    ("intermediate", 28.0),
    ("tan", 10.0),
    ("brown", -30.0),
    ("dark", f64::NEG_INFINITY),
];

/// The group of an individual typology angle.
pub fn group_of(angle: f64) -> &'static str {
    GROUPS.iter().find(|(_, above)| angle > *above).map_or("dark", |(name, _)| name)
}

/// A figure of a method by group of skin tone.
#[derive(Clone, Debug, Serialize)]
pub struct Fairness {
    /// The figure.
    #[serde(flatten)]
    pub figure: Figure,
    /// The method.
    pub method: String,
    /// From light to dark.
    pub groups: Vec<Group>,
    /// The group with the worst mean; none of a single group.
    pub worst: Option<&'static str>,
    /// The gain of the best group's mean over the worst's; none of a single group.
    pub gap: Option<f64>,
    /// The 95 % interval, of two faces or more in both. The two groups are chosen by what is seen,
    /// so that it is too hopeful of finding a gap.
    pub gap_ci95: Option<[f64; 2]>,
    /// Standard deviation of the groups' means (n): of `ita_error` the bias of the FAIR benchmark;
    /// none of a single group.
    pub bias: Option<f64>,
}

/// The faces of a group.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// The name.
    pub group: &'static str,
    /// The number of faces.
    pub faces: usize,
    /// Mean over faces.
    pub mean: f64,
    /// 95 % interval over faces; none of one face.
    pub ci95: Option<[f64; 2]>,
}

pub(super) fn fairness(figure: &Figure, method: &str, scores: &[&Observation]) -> Option<Fairness> {
    let in_group = |name: &str| -> Vec<f64> {
        let of: Vec<&Observation> = scores
            .iter()
            .copied()
            .filter(|o| o.skin_tone.is_some_and(|angle| group_of(angle) == name))
            .collect();
        faces(&of, None).iter().map(Face::mean).collect()
    };
    let groups: Vec<(&'static str, Vec<f64>)> = GROUPS
        .iter()
        .map(|(name, _)| (*name, in_group(name)))
        .filter(|(_, values)| !values.is_empty())
        .collect();
    let of = |values: &Vec<f64>| mean(values.iter().copied());
    let gain = |a: &Vec<f64>, b: &Vec<f64>| figure.direction().gain(of(a), of(b));
    let by = |a: &&(&str, Vec<f64>), b: &&(&str, Vec<f64>)| gain(&b.1, &a.1).total_cmp(&0.0);
    let (worst, best) = (groups.iter().min_by(by)?, groups.iter().max_by(by)?);
    let several = groups.len() > 1;
    // The sign of the interval is that of the gain, whichever values are better.
    let signed =
        |ends: [f64; 2]| if of(&best.1) < of(&worst.1) { [-ends[1], -ends[0]] } else { ends };
    Some(Fairness {
        figure: figure.clone(),
        method: method.to_owned(),
        worst: several.then_some(worst.0),
        gap: several.then(|| gain(&worst.1, &best.1)),
        gap_ci95: several.then(|| welch(&best.1, &worst.1)).flatten().map(signed),
        bias: population_spread(&groups.iter().map(|(_, values)| of(values)).collect::<Vec<_>>()),
        groups: groups
            .iter()
            .map(|(name, values)| Group {
                group: name,
                faces: values.len(),
                mean: of(values),
                ci95: interval(values),
            })
            .collect(),
    })
}

fn population_spread(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    Some(spread(values)? * ((n - 1.0) / n).sqrt())
}
