//! Cost of a stage: how much there is to do, times what the like of it took.
//!
//! The work of a stage follows from its scene: rays of what is rendered, pixels of what is solved or
//! scored. Seconds are a fixed part (a process that starts, a head that is built) and a part that grows
//! with the work; the second is measured where a run has done the like, and else of a machine of two cores.

use std::collections::BTreeMap;

use formats::content_hash::hash_parts;

use super::cases::Case;
use super::file::Suite;
use super::method::{Method, MethodKind};
use super::plan::{Kind, Task};
use super::record::Record;

/// Cameras of a rig that does not say how many it has.
const CAMERAS: u64 = 16;

/// Seconds of stages that nobody has measured: a fixed part, and a part per unit of work; on two cores,
/// with `unshade`'s settings.
fn unmeasured(kind: Kind, method: Option<&Method>) -> (f64, f64) {
    match (kind, method.map(|method| &method.kind)) {
        (Kind::Capture, _) => (4.0, 0.9),
        (Kind::Lights, _) => (2.0, 0.0),
        (Kind::Maps, Some(MethodKind::Fields { .. } | MethodKind::Program(_))) => (1.0, 10.0),
        (Kind::Maps, Some(MethodKind::Competitor { .. })) => (3.0, 20.0),
        (Kind::Maps, _) => (0.1, 1.0),
        (Kind::Relit, _) => (2.2, 0.4),
        (Kind::Scores, _) => (0.3, 1.5),
    }
}

/// Share of bare numbers that stays when they are written.
const COMPRESSED: f64 = 0.5;

/// A case's size, as far as its scene tells.
struct Size {
    pixels: f64,
    samples: f64,
    train: f64,
    test: f64,
    /// The capture's own and the others.
    lights: f64,
    texels: f64,
}

impl Size {
    fn of(case: &Case) -> Self {
        let number = |section: &str, key: &str, default: u64| -> f64 {
            let value =
                case.scene.table.get(section).and_then(|table| table.get(key)?.as_integer());
            value.map_or(default, i64::unsigned_abs).max(1) as f64
        };
        Self {
            pixels: number("render", "width", 512) * number("render", "height", 512),
            samples: number("render", "samples", 64),
            train: number("rig", "train", CAMERAS),
            test: number("rig", "test", CAMERAS / 4),
            lights: case.scene.relight().len() as f64 + 1.0,
            texels: number("face", "texture_size", 512).powi(2),
        }
    }
}

/// Millions of rays of a stage that renders, or of pixels of one that solves or scores.
pub(super) fn work(suite: &Suite, task: &Task) -> f64 {
    let Size { pixels, samples, train, test, lights, texels } = Size::of(&suite.cases[task.case]);
    let pictures = test * lights * suite.scales.len() as f64;
    1e-6 * match task.kind {
        Kind::Capture => pixels * samples * (train + test * lights),
        Kind::Lights => 0.0,
        Kind::Maps => pixels * train,
        Kind::Relit => pixels * samples * pictures,
        Kind::Scores => pixels * pictures + texels,
    }
}

/// Rays of one picture of a case, if all were in flight at once.
pub(super) fn frame(suite: &Suite, task: &Task) -> u64 {
    let Size { pixels, samples, .. } = Size::of(&suite.cases[task.case]);
    (pixels * samples) as u64
}

/// Bytes of a stage's output as bare numbers: 25 floats for a view with its layers, nine for every relit
/// one, and 13 for a texel.
pub(super) fn raw(suite: &Suite, task: &Task) -> f64 {
    let Size { pixels, train, test, lights, texels, .. } = Size::of(&suite.cases[task.case]);
    4.0 * match task.kind {
        Kind::Capture => pixels * ((train + test) * 25.0 + test * lights * 9.0) + texels * 13.0,
        Kind::Lights => 0.0,
        Kind::Maps => texels * 13.0,
        Kind::Relit => pixels * test * lights * suite.scales.len() as f64 * 9.0,
        Kind::Scores => 2e4 * lights,
    }
}

/// Key of stages whose costs can be compared.
pub(super) fn what(suite: &Suite, task: &Task) -> String {
    match task.method.map(|method| &suite.methods[method]) {
        Some(method) if task.kind == Kind::Maps => {
            format!("maps {}", &hash_parts(&[&format!("{:?}", method.kind)])[..12])
        }
        _ if task.kind == Kind::Relit => format!("relit {}", suite.relight),
        _ => task.kind.word().to_owned(),
    }
}

/// Expected cost of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cost {
    pub seconds: f64,
    pub bytes: f64,
    /// Whether the like of it was measured.
    pub measured: bool,
}

/// Costs that runs have measured, to estimate others from.
#[derive(Default)]
pub(super) struct Costs {
    by_id: BTreeMap<String, Record>,
    by_what: BTreeMap<String, Vec<Record>>,
}

impl Costs {
    /// Adds what a run measured.
    pub fn add(&mut self, records: BTreeMap<String, Record>) {
        for (id, record) in records {
            if !record.what.is_empty() {
                self.by_what.entry(record.what.clone()).or_default().push(record.clone());
                self.by_id.insert(id, record);
            }
        }
    }

    /// Cost of `task`: its measured one, else that of the like of it, grown with the work, else that on two
    /// cores.
    pub fn estimate(&self, suite: &Suite, task: &Task) -> Cost {
        let method = task.method.map(|method| &suite.methods[method]);
        let (fixed, rate) = unmeasured(task.kind, method);
        let (work, raw, what) = (work(suite, task), raw(suite, task), what(suite, task));
        let own = self.by_id.get(&task.id).filter(|record| record.what == what);
        let like = match own {
            Some(own) => std::slice::from_ref(own),
            None => self.by_what.get(&what).map_or(&[][..], Vec::as_slice),
        };
        if like.is_empty() {
            return Cost { seconds: fixed + rate * work, bytes: COMPRESSED * raw, measured: false };
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

    fn record(suite: &Suite, task: &Task, seconds: f64, bytes: u64) -> Record {
        Record {
            id: task.id.clone(),
            seconds,
            bytes,
            work: work(suite, task),
            raw: raw(suite, task),
            what: what(suite, task),
            ..Record::default()
        }
    }

    #[test]
    fn what_was_measured_is_what_is_expected_and_it_grows_with_the_pictures() {
        let (small, large) = (tiny(96), tiny(192));
        let of = |suite: &Suite, id: &str| {
            plan(suite).into_iter().find(|task| task.id.starts_with(id)).unwrap()
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
            what(&small, &of(&small, "maps/tiny-studio/quick")),
            what(&small, &of(&small, "maps/tiny-studio/oracle"))
        );
    }
}
