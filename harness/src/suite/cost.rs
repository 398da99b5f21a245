//! Cost of a stage: how much there is to do, times what it took elsewhere.
//!
//! The work of a stage follows from the size of its case: rays of a rendering, pixels of a scoring, steps of a solve.
//! Seconds are a fixed part (a process that starts, a head that is built) and a part that grows with the work; the
//! second goes by earlier runs where they have such stages, else by a machine of two cores.

use std::collections::BTreeMap;
use std::thread;

use formats::content_hash::hash_parts;
use solver::{Config, Extent};

use super::baseline::BaselineMethod;
use super::case_size::CaseSize;
use super::file::Suite;
use super::method::{Method, MethodKind};
use super::plan::{Kind, Task};
use super::record::Record;

/// Seconds of a stage on two cores: a fixed part, and a part per unit of [`work`].
fn on_two_cores(kind: Kind, method: Option<&Method>) -> (f64, f64) {
    match (kind, method.map(|method| &method.kind)) {
        (Kind::Capture, _) => (4.0, 0.9),
        (Kind::Lights, _) => (2.0, 0.0),
        // The work is in seconds already.
        (Kind::Maps, Some(MethodKind::Fields { .. })) => (0.2, 1.0),
        (Kind::Maps, Some(MethodKind::Program(_))) => (1.0, 10.0),
        (Kind::Maps, Some(MethodKind::Competitor { .. })) => (3.0, 1.0),
        (Kind::Maps, _) => (0.1, 0.3),
        (Kind::Relit, _) => (2.2, 0.4),
        (Kind::Scores, _) => (0.3, 1.5),
    }
}

/// Cores of a machine that has more of them, over two: what every stage makes good use of.
fn cores_over_two() -> f64 {
    thread::available_parallelism().map_or(2.0, |cores| cores.get() as f64).clamp(1.0, 16.0) / 2.0
}

/// Share of bare numbers that stays when they are written.
const COMPRESSED: f64 = 0.5;

/// Lights that the maps of a method are relit in.
fn lights(size: &CaseSize, method: Option<&Method>) -> f64 {
    let own = match method.map(|method| &method.kind) {
        // A baseline recovers no light, and that of photographs is unknown.
        Some(MethodKind::Baseline { .. }) if size.photographed => 0.0,
        _ => 1.0,
    };
    own + size.other_lights
}

/// Scales of the albedo that maps are relit with: one, where there is no truth.
fn scales(suite: &Suite, size: &CaseSize) -> f64 {
    if size.photographed { 1.0 } else { suite.scales.len() as f64 }
}

/// Millions of rays of a stage that renders, of pixels of one that scores or projects; of a solve, seconds on two
/// cores.
pub(super) fn work(suite: &Suite, task: &Task) -> f64 {
    let size = CaseSize::of(&suite.cases[task.case]);
    let method = task.method.map(|method| &suite.methods[method]);
    let CaseSize { train, test, samples, texels, .. } = size;
    let pictures = test * lights(&size, method) * scales(suite, &size);
    1e-6 * match task.kind {
        Kind::Capture => samples * (train + test * (1.0 + size.other_lights)),
        Kind::Lights => 0.0,
        Kind::Maps => return method.map_or(0.0, |method| work_of_maps(&size, method)),
        Kind::Relit => samples * pictures,
        // The views that a method synthesises itself are scored too.
        Kind::Scores => pictures + test + texels,
    }
}

fn work_of_maps(size: &CaseSize, method: &Method) -> f64 {
    let millions = 1e-6 * size.train;
    match &method.kind {
        MethodKind::Fields { config, .. } => {
            let Ok(config) = Config::from_toml(config) else { return 0.0 };
            let (views, pixels) = (size.views, size.covered as usize);
            let texture_size = config.texture_size().expected(views, pixels);
            solver::seconds_on_two_cores(&config, &Extent { views, pixels, texture_size })
        }
        MethodKind::Competitor { competitor, settings } => {
            competitor.seconds_on_two_cores(settings, millions, 1e-6 * size.frame())
        }
        MethodKind::Baseline { texture_size, .. } => {
            millions + 1e-6 * (texture_size * texture_size * size.views) as f64
        }
        MethodKind::Program(_) => millions,
        MethodKind::Oracle | MethodKind::LabelMeans => 1e-6 * size.texels,
    }
}

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

/// Rays of one picture of a case, if all were in flight at once.
pub(super) fn frame(suite: &Suite, task: &Task) -> u64 {
    let size = CaseSize::of(&suite.cases[task.case]);
    (size.frame() * size.samples) as u64
}

/// Bytes of a stage's output as bare numbers: 25 floats for a view with its layers, nine for every relit
/// one, and 13 for a texel.
pub(super) fn raw(suite: &Suite, task: &Task) -> f64 {
    let size = CaseSize::of(&suite.cases[task.case]);
    let method = task.method.map(|method| &suite.methods[method]);
    let CaseSize { train, test, texels, .. } = size;
    let lights = lights(&size, method);
    4.0 * match task.kind {
        Kind::Capture => (train + test) * 25.0 + test * lights * 9.0 + texels * 13.0,
        Kind::Lights => 0.0,
        Kind::Maps => texels_of_maps(&size, method) * 13.0,
        Kind::Relit => test * lights * scales(suite, &size) * 9.0,
        Kind::Scores => 2e4 * lights,
    }
}

fn texels_of_maps(size: &CaseSize, method: Option<&Method>) -> f64 {
    match method.map(|method| &method.kind) {
        Some(MethodKind::Baseline { texture_size, .. }) => texture_size.pow(2) as f64,
        _ if size.photographed => BaselineMethod::TEXTURE_SIZE.pow(2) as f64,
        _ => size.texels,
    }
}

/// Key of stages whose costs can be compared.
pub(super) fn what(suite: &Suite, task: &Task) -> String {
    match task.method.map(|method| &suite.methods[method]) {
        // The work of a solve counts its steps, whatever its configuration; only the device differs.
        Some(Method { kind: MethodKind::Fields { backend, .. }, .. })
            if task.kind == Kind::Maps =>
        {
            format!("maps fields {backend:?}")
        }
        Some(method) if task.kind == Kind::Maps => {
            format!("method {}", &hash_parts(&[&format!("{:?}", method.kind)])[..12])
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
    /// Whether earlier runs have such a stage.
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

    /// Cost of `task`: as measured, else that of similar stages in proportion to their work, else that of a machine
    /// of two cores, in proportion to the cores here.
    pub fn estimate(&self, suite: &Suite, task: &Task) -> Cost {
        let method = task.method.map(|method| &suite.methods[method]);
        let (fixed, rate) = on_two_cores(task.kind, method);
        let (work, raw, what) = (work(suite, task), raw(suite, task), what(suite, task));
        let own = self.by_id.get(&task.id).filter(|record| record.what == what);
        let like = match own {
            Some(own) => std::slice::from_ref(own),
            None => self.by_what.get(&what).map_or(&[][..], Vec::as_slice),
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
