//! Cost of a stage: how much there is to do, times what it took elsewhere.
//!
//! The work of a stage follows from the size of its case: rays of a rendering, pixels of a scoring, steps of a solve.
//! Seconds are a fixed part (a process that starts, a head that is built) and a part that grows with the work; the
//! second goes by earlier runs where they have such stages, else by a machine of two cores.

use std::collections::BTreeMap;
use std::thread;

use super::case_size::CaseSize;
use super::file::Suite;
use super::finished::Record;
use super::plan::Stage;
use super::stage_work::Effort;

/// Cores of a machine that has more of them, over two: what every stage makes good use of.
fn cores_over_two() -> f64 {
    thread::available_parallelism().map_or(2.0, |cores| cores.get() as f64).clamp(1.0, 16.0) / 2.0
}

/// Share of bare numbers that stays when they are written.
const COMPRESSED: f64 = 0.5;

/// Millions of pixels that the report draws.
pub(super) fn drawn(suite: &Suite) -> f64 {
    let methods = suite.methods.len() as f64;
    let of_case = |case| {
        let size = CaseSize::of(case);
        // Own view, each light that has a reference, and of rendered views two layers of two pictures.
        let figures = if size.photographed { 2.0 } else { 2.0 + size.other_lights + 4.0 };
        // Reference, and of each method the picture and its error; maps are four.
        size.train + size.test * figures * (1.0 + 2.0 * methods) + size.texels * 8.0 * methods
    };
    1e-6 * suite.cases.iter().map(of_case).sum::<f64>()
}

/// Expected cost of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cost {
    pub seconds: f64,
    pub bytes: f64,
    /// Whether earlier runs have such a stage.
    pub measured: bool,
}

/// Costs that runs have measured, to estimate others from.
#[derive(Default)]
pub(super) struct Costs {
    by_id: BTreeMap<String, Record>,
    by_class: BTreeMap<String, Vec<Record>>,
}

impl Costs {
    /// Adds what a run measured.
    pub fn add(&mut self, records: BTreeMap<String, Record>) {
        for (id, record) in records {
            if !record.what.is_empty() {
                self.by_class.entry(record.what.clone()).or_default().push(record.clone());
                self.by_id.insert(id, record);
            }
        }
    }

    /// Cost of `stage`: as measured, else that of similar stages in proportion to their work, else that of a machine
    /// of two cores, in proportion to the cores here.
    pub fn estimate(&self, suite: &Suite, stage: &Stage) -> Cost {
        let Effort { fixed, rate, work, raw, class } = stage.effort(suite);
        let own = self.by_id.get(&stage.id).filter(|record| record.what == class);
        let like = match own {
            Some(own) => std::slice::from_ref(own),
            None => self.by_class.get(&class).map_or(&[][..], Vec::as_slice),
        };
        if like.is_empty() {
            let seconds = fixed + rate * work / cores_over_two();
            return Cost { seconds, bytes: COMPRESSED * raw, measured: false };
        }
        let mean = |value: &dyn Fn(&Record) -> f64| {
            like.iter().map(value).sum::<f64>() / like.len() as f64
        };
        let grown = |from: f64, to: f64| if from > 0.0 { to / from } else { 1.0 };
        let seconds = mean(&|record| {
            let fixed = fixed.min(0.8 * record.seconds);
            fixed + (record.seconds - fixed) * grown(record.work, work)
        });
        let bytes = mean(&|record| record.bytes as f64 * grown(record.raw, raw));
        Cost { seconds, bytes, measured: true }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::plan::plan;
    use super::*;

    fn tiny(side: usize) -> Suite {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/scenes/tiny.toml");
        let mut suite = Suite::open(&file).unwrap();
        let render = toml::Table::from_iter(
            ["width", "height"].map(|key| (key.to_owned(), (side as i64).into())),
        );
        let changes = toml::Table::from_iter([("render".to_owned(), render.into())]);
        suite.cases[0].scene = suite.cases[0].scene.clone().with_changes(&changes);
        suite
    }

    fn record(suite: &Suite, stage: &Stage, seconds: f64, bytes: u64) -> Record {
        let Effort { work, raw, class, .. } = stage.effort(suite);
        Record { id: stage.id.clone(), seconds, bytes, work, raw, what: class, ..Record::default() }
    }

    #[test]
    fn the_estimate_is_the_measured_cost_and_grows_with_the_pictures() {
        let (small, large) = (tiny(96), tiny(192));
        let of = |suite: &Suite, id: &str| {
            plan(suite).into_iter().find(|stage| stage.id.starts_with(id)).unwrap()
        };
        let relit = of(&small, "relit/");
        let mut costs = Costs::default();
        costs.add(BTreeMap::from([(relit.id.clone(), record(&small, &relit, 5.0, 1000))]));
        let same = costs.estimate(&small, &relit);
        assert!(same.measured && (same.seconds - 5.0).abs() < 1e-9 && same.bytes == 1000.0);
        // Four times the rays: the fixed part stays, pixels are all that there is.
        let grown = costs.estimate(&large, &of(&large, "relit/"));
        assert!(grown.seconds > 5.0 && grown.seconds < 20.0, "{grown:?}");
        assert_eq!(grown.bytes, 4000.0);
        // Nobody has measured a capture; other methods' maps cost something else.
        assert!(!costs.estimate(&small, &of(&small, "capture/")).measured);
        assert_ne!(
            of(&small, "maps/tiny-studio/quick").effort(&small).class,
            of(&small, "maps/tiny-studio/oracle").effort(&small).class
        );
    }
}
