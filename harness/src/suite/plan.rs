//! The plan of a suite: stages, and which of them come before which.

use std::path::{Path, PathBuf};

use super::cases::Case;
use super::file::Suite;
use super::method::Method;

/// A kind of stage; [`stage`](super::stage) has what each does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StageKind {
    /// Renders a case.
    Capture,
    /// Writes the lights of a case for methods that give pictures.
    Lights,
    /// Turns a capture into maps.
    Maps,
    /// Renders maps.
    Relit,
    /// Measures maps and pictures.
    Scores,
}

impl StageKind {
    /// All, in the order of a case.
    pub const ALL: [Self; 5] = [Self::Capture, Self::Lights, Self::Maps, Self::Relit, Self::Scores];

    /// The first word of ids of stages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Capture => "capture",
            Self::Lights => "lights",
            Self::Maps => "maps",
            Self::Relit => "relit",
            Self::Scores => "scores",
        }
    }

    /// Whether there is such a stage for each method.
    pub fn has_method(self) -> bool {
        matches!(self, Self::Maps | Self::Relit | Self::Scores)
    }

    /// The id of such a stage: `<kind>/<case>[/<method>]`.
    pub fn id(self, case: &str, method: Option<&str>) -> String {
        let name = self.name();
        method.map_or_else(|| format!("{name}/{case}"), |method| format!("{name}/{case}/{method}"))
    }

    /// The run's folder that holds the outputs of such stages.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Capture => "captures",
            other => other.name(),
        }
    }
}

/// A stage of a run.
#[derive(Clone, Debug)]
pub struct Stage {
    /// See [`StageKind::id`].
    pub id: String,
    /// Its kind.
    pub kind: StageKind,
    /// The index of its case in the suite.
    pub case: usize,
    /// The index of its method, of a stage that has one.
    pub method: Option<usize>,
    /// Whether `--method` and `--case` select it. If not, only a valid earlier output of it is used.
    pub wanted: bool,
    /// The indices, in the plan, of the stages whose outputs it reads.
    pub after: Vec<usize>,
    /// Its output, below the run's folder.
    pub path: PathBuf,
}

impl Stage {
    /// The case and method, `<case>/<method>`, that fail with this stage.
    pub fn cell(&self, suite: &Suite) -> Option<String> {
        let method = &suite.methods.get(self.method?)?;
        Some(format!("{}/{}", suite.cases.get(self.case)?.id, method.id))
    }
}

/// All stages of a suite, in the order in which one process does them.
pub fn plan(suite: &Suite) -> Vec<Stage> {
    let gives_pictures = |method: &Method| method.work().gives_pictures();
    let handed = suite.methods.iter().any(gives_pictures);
    let asked =
        suite.methods.iter().any(|method| gives_pictures(method) && suite.runs_method(method));
    let mut stages: Vec<Stage> = Vec::new();
    for (case, one @ Case { id, photographed, .. }) in suite.cases.iter().enumerate() {
        let mut add = |kind: StageKind, method: Option<usize>, after: Vec<usize>| {
            let of_method = method.map(|method| &*suite.methods[method].id);
            let name = of_method.map_or_else(|| id.clone(), |method| format!("{id}/{method}"));
            let wanted = suite.runs_case(one)
                && match method {
                    Some(method) => suite.runs_method(&suite.methods[method]),
                    None => kind == StageKind::Capture || asked,
                };
            let file =
                if kind == StageKind::Scores { format!("{name}.json") } else { name.clone() };
            let path = Path::new(kind.folder()).join(file);
            let id = kind.id(id, of_method);
            stages.push(Stage { id, kind, case, method, wanted, after, path });
            stages.len() - 1
        };
        let rendered = photographed.is_none();
        let capture: Vec<usize> =
            rendered.then(|| add(StageKind::Capture, None, vec![])).into_iter().collect();
        let lights = (handed && rendered).then(|| add(StageKind::Lights, None, capture.clone()));
        for (method, given) in suite.methods.iter().enumerate() {
            let lights = lights.filter(|_| gives_pictures(given));
            let inputs = capture.iter().copied().chain(lights).collect();
            let maps = add(StageKind::Maps, Some(method), inputs);
            let inputs = capture.iter().copied().chain([maps]).collect();
            let relit = add(StageKind::Relit, Some(method), inputs);
            let inputs = capture.iter().copied().chain([maps, relit]).collect();
            add(StageKind::Scores, Some(method), inputs);
        }
    }
    stages
}
