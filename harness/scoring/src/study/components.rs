//! Components of a figure's variance: faces, lights, views, the renderer's seed, the solver's seed.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Observation;
use super::faces::{Face, spread};
use super::figures::{Figure, faces};

/// Standard deviations of a figure, each with all else held; none where there is but one.
///
/// Each is that of what is seen, and so holds what lies below it: views and seeds too.
#[derive(Clone, Debug, Serialize)]
pub struct Components {
    /// The figure.
    #[serde(flatten)]
    pub figure: Figure,
    /// The method.
    pub method: String,
    /// Standard deviation of the means of the faces.
    pub faces: Option<f64>,
    /// Standard deviation between the lights of a face.
    pub lights: Option<f64>,
    /// Standard deviation between the views of a picture's score.
    pub views: Option<f64>,
    /// Standard deviation between captures that differ in the renderer's seed alone.
    pub render_seeds: Option<f64>,
    /// Standard deviation between solves that differ in the solver's seed alone.
    pub solver_seeds: Option<f64>,
}

pub(super) fn components(
    figure: &Figure,
    method: &str,
    scores: &[&Observation],
) -> Option<Components> {
    let faces = faces(scores, None);
    if faces.is_empty() {
        return None;
    }
    let means: Vec<f64> = faces.iter().map(Face::mean).collect();
    let all = |o: &Observation| {
        (o.face.clone(), o.light.clone(), o.row.light.clone(), o.seed, o.method_seed)
    };
    let views = scores.iter().map(|o| o.row.per_frame.values().copied().collect::<Vec<_>>());
    Some(Components {
        figure: figure.clone(),
        method: method.to_owned(),
        faces: spread(&means),
        lights: within(scores, |o| {
            let (face, _, _, seed, own) = all(o);
            (face, String::new(), None, seed, own)
        }),
        views: pooled(views),
        render_seeds: within(scores, |o| {
            let (face, light, relit, _, own) = all(o);
            (face, light, relit, None, own)
        }),
        solver_seeds: within(scores, |o| {
            let (face, light, relit, seed, _) = all(o);
            (face, light, relit, seed, None)
        }),
    })
}

type GroupKey = (String, String, Option<String>, Option<u64>, Option<u64>);

/// The standard deviation within groups of scores that have all that is held in common.
fn within(scores: &[&Observation], key: impl Fn(&Observation) -> GroupKey) -> Option<f64> {
    let mut groups: BTreeMap<GroupKey, Vec<f64>> = BTreeMap::new();
    for score in scores {
        groups.entry(key(score)).or_default().extend(score.row.value);
    }
    pooled(groups.into_values())
}

/// The standard deviation within groups, pooled by their degrees of freedom.
fn pooled(groups: impl Iterator<Item = Vec<f64>>) -> Option<f64> {
    let (squares, freedom) = groups.fold((0.0, 0.0), |(squares, freedom), values| {
        let n = values.len().saturating_sub(1) as f64;
        (squares + n * spread(&values).unwrap_or(0.0).powi(2), freedom + n)
    });
    (freedom > 0.0).then(|| (squares / freedom).sqrt())
}
