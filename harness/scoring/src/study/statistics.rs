//! The study of some observations, as numbers.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::Observation;
use super::components::{Components, components};
use super::faces::{Face, interval, mean, pooled_decibels, spread};
use super::fairness::{Fairness, fairness};
use super::figures::{Figure, faces, place};
use super::paired::{effect_size, faces_needed, holm, sign_flip};
use crate::metrics::Statistic;

/// The level of every test and interval.
pub const LEVEL: f64 = 0.05;

/// Statistics over the faces of some runs.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// Version of the format.
    pub format: u32,
    /// Every figure of every method.
    pub summaries: Vec<Summary>,
    /// Every two methods that compete, in the figures that decide.
    pub comparisons: Vec<Comparison>,
    /// Components of variance of the figures that decide.
    pub components: Vec<Components>,
    /// The figures that decide by group of skin tone.
    pub fairness: Vec<Fairness>,
}

/// A figure of a method over the faces.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The figure.
    #[serde(flatten)]
    pub figure: Figure,
    /// The method.
    pub method: String,
    /// `solver`, `baseline`, `privileged`, `oracle`.
    pub kind: String,
    /// `passive`, `controlled`, `privileged`.
    pub class: String,
    /// The number of faces that have the figure.
    pub faces: usize,
    /// Mean over faces of their means over lights and seeds.
    pub mean: f64,
    /// 95 % interval of it over faces; none of one face.
    pub ci95: Option<[f64; 2]>,
    /// Standard deviation of the faces.
    pub spread: Option<f64>,
    /// The face with the worst mean, and that.
    pub worst: (String, f64),
    /// PSNR of the mean squared error over all faces; none of other metrics.
    pub pooled: Option<f64>,
    /// The 95 % interval, of four faces or more.
    pub pooled_ci95: Option<[f64; 2]>,
}

/// Verdict of a paired comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The first method is better.
    Better,
    /// The first method is worse.
    Worse,
    /// The data cannot tell.
    CannotTell,
}

/// Two methods on the same faces, lights and seeds.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The figure.
    #[serde(flatten)]
    pub figure: Figure,
    /// The first method.
    pub method: String,
    /// The second method.
    pub against: String,
    /// Faces that both have.
    pub faces: usize,
    /// Mean over faces of how much better the first is, in the metric's unit.
    pub gain: f64,
    /// The 95 % interval over faces.
    pub ci95: Option<[f64; 2]>,
    /// Gain over its standard deviation, Hedges' correction.
    pub effect: Option<f64>,
    /// Share of the faces on which the first is better.
    pub better_on: f64,
    /// Sign-flip permutation test.
    pub p: f64,
    /// Holm's correction within the figure.
    pub p_holm: f64,
    /// At 5 %, corrected.
    pub verdict: Verdict,
    /// Standard deviation of the gain over faces.
    pub spread: Option<f64>,
    /// Faces that a study needs to find a true difference of this gain in 80 % of cases.
    pub faces_needed: Option<usize>,
}

type Scores<'a> = BTreeMap<String, Vec<&'a Observation>>;

/// Scores by figure and method.
fn grouped(observations: &[Observation]) -> BTreeMap<Figure, Scores<'_>> {
    let mut groups: BTreeMap<Figure, Scores> = BTreeMap::new();
    for observation in observations {
        let methods = groups.entry(Figure::of(observation)).or_default();
        methods.entry(observation.method.clone()).or_default().push(observation);
    }
    groups
}

impl Study {
    /// Statistics of observations, each once.
    pub fn of(observations: &[Observation]) -> Self {
        let groups = grouped(observations);
        let mut study = Self {
            format: 1,
            summaries: Vec::new(),
            comparisons: Vec::new(),
            components: Vec::new(),
            fairness: Vec::new(),
        };
        for (figure, methods) in &groups {
            study.summaries.extend(methods.values().filter_map(|scores| summary(figure, scores)));
        }
        let mut key: Vec<_> = groups.iter().filter(|(figure, _)| figure.key().is_some()).collect();
        key.sort_by_key(|(figure, _)| (figure.variant.clone(), figure.key()));
        for (figure, methods) in key {
            study.comparisons.extend(comparisons(figure, methods));
            for (method, scores) in methods {
                study.components.extend(components(figure, method, scores));
                study.fairness.extend(fairness(figure, method, scores));
            }
        }
        study
    }
}

fn summary(figure: &Figure, scores: &[&Observation]) -> Option<Summary> {
    let faces = faces(scores, None);
    let first = scores.first().filter(|_| !faces.is_empty())?;
    let means: Vec<f64> = faces.iter().map(Face::mean).collect();
    let worse = |a: &&Face, b: &&Face| figure.direction().gain(b.mean(), a.mean()).total_cmp(&0.0);
    let worst = faces.iter().min_by(worse)?;
    let is_psnr = figure
        .metric()
        .is_some_and(|m| matches!(m.statistic, Statistic::Psnr | Statistic::UnbiasedPsnr));
    let pooled = is_psnr.then(|| pooled_decibels(&faces));
    Some(Summary {
        figure: figure.clone(),
        method: first.method.clone(),
        kind: first.kind.clone(),
        class: first.class.clone(),
        faces: faces.len(),
        mean: mean(means.iter().copied()),
        ci95: interval(&means),
        spread: spread(&means),
        worst: (worst.name.clone(), worst.mean()),
        pooled: pooled.map(|pooled| pooled.0),
        pooled_ci95: pooled.and_then(|pooled| pooled.1),
    })
}

/// Every two methods that compete, each pair once; what is given more than the others, and what is
/// made from the truth, never competes.
fn comparisons(figure: &Figure, methods: &Scores) -> Vec<Comparison> {
    let competes = |scores: &&Vec<&Observation>| {
        scores
            .first()
            .is_some_and(|o| o.class == "passive" && o.kind != "oracle" && o.kind != "privileged")
    };
    let contenders: Vec<_> = methods.values().filter(competes).collect();
    let mut all = Vec::new();
    for (i, a) in contenders.iter().enumerate() {
        all.extend(contenders[i + 1..].iter().filter_map(|b| comparison(figure, a, b)));
    }
    let corrected = holm(&all.iter().map(|pair| pair.p).collect::<Vec<_>>());
    for (pair, p) in all.iter_mut().zip(corrected) {
        pair.p_holm = p;
        pair.verdict = match p <= LEVEL {
            true if pair.gain > 0.0 => Verdict::Better,
            true => Verdict::Worse,
            false => Verdict::CannotTell,
        };
    }
    all
}

fn comparison(figure: &Figure, a: &[&Observation], b: &[&Observation]) -> Option<Comparison> {
    let places = |scores: &[&Observation]| -> BTreeSet<_> {
        scores.iter().filter(|o| o.row.value.is_some()).map(|o| place(o)).collect()
    };
    let both: BTreeSet<_> = places(a).intersection(&places(b)).cloned().collect();
    let (ours, theirs) = (faces(a, Some(&both)), faces(b, Some(&both)));
    let gains: Vec<f64> = ours
        .iter()
        .zip(&theirs)
        .map(|(a, b)| figure.direction().gain(b.mean(), a.mean()))
        .collect();
    let gain = mean(gains.iter().copied());
    let spread = spread(&gains);
    Some(Comparison {
        figure: figure.clone(),
        method: a.first()?.method.clone(),
        against: b.first()?.method.clone(),
        faces: gains.len(),
        gain,
        ci95: interval(&gains),
        effect: effect_size(&gains),
        better_on: mean(gains.iter().map(|gain| f64::from(*gain > 0.0))),
        p: sign_flip(&gains)?,
        p_holm: 1.0,
        verdict: Verdict::CannotTell,
        spread,
        faces_needed: spread.filter(|spread| *spread > 0.0).and_then(|s| faces_needed(gain / s)),
    })
}
