//! Causes of change, in sentences: rows that changed are grouped by their subject, and a map that
//! changed accounts for the pictures that are made with it.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::row_id::RowId;
use super::verdict::{Comparison, Judged, Verdict};

/// Maps, and the pictures that a change of each shows in.
const MAPS: [(&str, &[&str]); 5] = [
    ("diffuse_albedo", &["relit", "relit_diffuse_layer"]),
    ("diffuse_normal", &["relit", "relit_diffuse_layer"]),
    ("specular_albedo", &["relit", "relit_specular_layer"]),
    ("specular_normal", &["relit", "relit_specular_layer"]),
    ("confidence", &[]),
];

/// The true maps through the pipeline: no method's doing.
const ORACLE: &str = "oracle";

/// A group of rows that changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// True if it is a regression.
    pub worse: bool,
    /// The change, in one sentence.
    pub sentence: String,
    /// The method of the scores.
    pub method: String,
    /// Subject of the scores.
    pub subject: String,
    /// The lights of the captures.
    pub lights: Vec<String>,
    /// Cases that it happened in.
    pub cases: Vec<String>,
    /// Rows of this subject.
    pub rows: usize,
    /// Rows of pictures that follow from it.
    pub following: usize,
}

/// Rows of one subject and method that changed the same way.
struct Group<'a> {
    rows: Vec<(&'a Judged, RowId<'a>)>,
    /// The largest change in allowances.
    severity: f64,
}

impl Comparison {
    /// Changes: regressions before improvements, causes before their consequences, the largest
    /// first. Rows that are explained by another group are counted there.
    pub fn findings(&self) -> Vec<Finding> {
        let mut found = self.of_verdicts(true);
        found.extend(self.of_verdicts(false));
        found
    }

    fn of_verdicts(&self, worse: bool) -> Vec<Finding> {
        let mut groups: BTreeMap<(&str, &str), Group> = BTreeMap::new();
        for row in &self.rows {
            let wanted =
                if worse { row.verdict.is_regression() } else { row.verdict == Verdict::Better };
            let Ok(id) = RowId::parse(&row.id) else { continue };
            if wanted {
                let empty = || Group { rows: Vec::new(), severity: 0.0 };
                let group = groups.entry((id.method, id.subject)).or_insert_with(empty);
                group.severity = group.severity.max(row.severity());
                group.rows.push((row, id));
            }
        }
        let mut following: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        let mut explained = BTreeSet::new();
        for ((method, subject), group) in &groups {
            let causes = MAPS.iter().filter(|(map, pictures)| {
                pictures.contains(subject) && groups.contains_key(&(*method, *map))
            });
            // Of several maps the one that moved most, in its own allowances.
            let severity = |map: &str| groups[&(*method, map)].severity;
            let cause = causes.max_by(|a, b| severity(a.0).total_cmp(&severity(b.0)));
            if let Some((map, _)) = cause {
                *following.entry((*method, *map)).or_default() += group.rows.len();
                explained.insert((*method, *subject));
            }
        }
        let mut shown: Vec<_> =
            groups.iter().filter(|(key, _)| !explained.contains(*key)).collect();
        shown.sort_by(|(a, x), (b, y)| {
            let first = |key: &(&str, &str)| !is_pipeline(key);
            first(a).cmp(&first(b)).then(y.severity.total_cmp(&x.severity)).then(a.cmp(b))
        });
        shown
            .into_iter()
            .map(|(key, group)| {
                self.finding(key, group, following.get(key).copied().unwrap_or(0), worse)
            })
            .collect()
    }

    fn finding(
        &self,
        &(method, subject): &(&str, &str),
        group: &Group,
        following: usize,
        worse: bool,
    ) -> Finding {
        let cases: BTreeSet<&str> = group.rows.iter().map(|(_, id)| id.case).collect();
        let lights: BTreeSet<&str> = cases
            .iter()
            .filter_map(|case| self.lights.iter().find(|(id, _)| id == case))
            .map(|(_, light)| light.as_str())
            .collect();
        let lights: Vec<String> = lights.into_iter().map(str::to_owned).collect();
        let cases: Vec<String> = cases.into_iter().map(str::to_owned).collect();
        let place = if lights.is_empty() { &cases } else { &lights };
        let mut sentence = format!(
            "{} of `{method}` {} under {}",
            subject.replace('_', " "),
            happened(subject, group, worse),
            and(place)
        );
        if is_pipeline(&(method, subject)) {
            sentence += "; no method caused this: the captures or the pipeline changed, and every \
                         method's rows with them";
        } else if following > 0 {
            sentence += &format!("; so do the pictures that are made with it (rows: {following})");
        } else if subject.starts_with("relit") {
            sentence += "; no map that it is made of moved as far";
        }
        Finding {
            worse,
            sentence,
            method: method.to_owned(),
            subject: subject.to_owned(),
            lights,
            cases,
            rows: group.rows.len(),
            following,
        }
    }
}

/// Returns whether a group says something of the pipeline rather than of a method.
fn is_pipeline((method, subject): &(&str, &str)) -> bool {
    *method == ORACLE || subject.starts_with("mesh_") || subject.starts_with("constant_")
}

/// The change of a group, by its most telling score.
fn happened(subject: &str, group: &Group, worse: bool) -> String {
    if group.rows.iter().all(|(row, _)| row.verdict == Verdict::Missing) {
        return format!("has lost {} rows", group.rows.len());
    }
    let scale = mean_of(group, |id| id.metric.id == "scale_global");
    if let (Some((old, new)), "diffuse_albedo") = (scale, subject) {
        // The factor that would put it right: a larger one means a darker albedo.
        let change = 100.0 * (old / new - 1.0);
        let word = if change < 0.0 { "darker" } else { "brighter" };
        let off = 100.0 * (1.0 / new - 1.0);
        let now = if off < 0.0 { "too dark" } else { "too bright" };
        return format!(
            "is {:.1} % {word} than the baseline's ({:.1} % {now} against the truth)",
            change.abs(),
            off.abs()
        );
    }
    let direction = if worse { "worse" } else { "better" };
    let angle = mean_of(group, |id| id.metric.id == "normal_mean_deg");
    if let Some((old, new)) = angle {
        return format!("is {:.2}° {direction} ({old:.2}° -> {new:.2}°)", (new - old).abs());
    }
    for metric in ["psnr_srgb", "psnr_lin"] {
        let wanted = |id: &RowId| id.metric.id == metric && id.is_whole() && !id.is_unscaled();
        let found = mean_of(group, wanted);
        let found = found.or_else(|| mean_of(group, |id| id.metric.id == metric && id.is_whole()));
        if let Some((old, new)) = found {
            let change = (new - old).abs();
            return format!("is {change:.2} dB {direction} (PSNR {old:.2} -> {new:.2} dB)");
        }
    }
    let worst = group.rows.iter().max_by(|a, b| a.0.severity().total_cmp(&b.0.severity()));
    match worst {
        Some((Judged { baseline: Some(old), current: Some(new), .. }, id)) => {
            let place = id.place.split(':').next().unwrap_or_default();
            format!("is {direction} ({} at {place} {old:.4} -> {new:.4})", id.metric.name)
        }
        _ => format!("is {direction}"),
    }
}

/// Mean of what was and of what is, over the rows that changed and are wanted.
fn mean_of(group: &Group, wanted: impl Fn(&RowId) -> bool) -> Option<(f64, f64)> {
    let pairs: Vec<(f64, f64)> = group
        .rows
        .iter()
        .filter(|(_, id)| wanted(id))
        .filter_map(|(row, _)| row.baseline.zip(row.current))
        .collect();
    let n = pairs.len() as f64;
    let (old, new) = pairs.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
    (!pairs.is_empty()).then(|| (old / n, new / n))
}

fn and(names: &[String]) -> String {
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}
