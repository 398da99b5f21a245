//! The plan of a suite: stages, and which of them come before which.

use std::path::{Path, PathBuf};

use super::cases::Case;
use super::file::Suite;
use super::method::Method;

/// Kinds of stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
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

impl Kind {
    /// All, in the order of a case.
    pub const ALL: [Self; 5] = [Self::Capture, Self::Lights, Self::Maps, Self::Relit, Self::Scores];

    /// The first word of ids of stages.
    pub fn word(self) -> &'static str {
        match self {
            Self::Capture => "capture",
            Self::Lights => "lights",
            Self::Maps => "maps",
            Self::Relit => "relit",
            Self::Scores => "scores",
        }
    }

    /// The run's folder that holds what such stages leave.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Capture => "captures",
            other => other.word(),
        }
    }
}

/// A stage of a run.
#[derive(Clone, Debug)]
pub struct Task {
    /// `<kind>/<case>[/<method>]`.
    pub id: String,
    /// The kind of its work.
    pub kind: Kind,
    /// The index of its case in the suite.
    pub case: usize,
    /// The index of its method, of a stage that has one.
    pub method: Option<usize>,
    /// Whether it is run if no valid output is there; else it and what follows from it are left out.
    pub wanted: bool,
    /// The indices, in the plan, of the stages whose outputs it reads.
    pub after: Vec<usize>,
    /// Its output, below the run's folder.
    pub path: PathBuf,
}

impl Task {
    /// Whose failure a fault of this stage is: `<case>/<method>`.
    pub fn name(&self, suite: &Suite) -> Option<String> {
        let method = &suite.methods.get(self.method?)?;
        Some(format!("{}/{}", suite.cases.get(self.case)?.id, method.id))
    }
}

/// All stages of a suite, in the order in which one process does them.
pub fn plan(suite: &Suite) -> Vec<Task> {
    let handed = suite.methods.iter().any(Method::gives_pictures);
    let asked =
        suite.methods.iter().any(|method| method.gives_pictures() && suite.runs_method(method));
    let mut tasks: Vec<Task> = Vec::new();
    for (case, one @ Case { id, photographed, .. }) in suite.cases.iter().enumerate() {
        let mut add = |kind: Kind, method: Option<usize>, after: Vec<usize>| {
            let name = match method {
                Some(method) => format!("{id}/{}", suite.methods[method].id),
                None => id.clone(),
            };
            let wanted = suite.runs_case(one)
                && match method {
                    Some(method) => suite.runs_method(&suite.methods[method]),
                    None => kind == Kind::Capture || asked,
                };
            let file = if kind == Kind::Scores { format!("{name}.json") } else { name.clone() };
            let path = Path::new(kind.folder()).join(file);
            let id = format!("{}/{name}", kind.word());
            tasks.push(Task { id, kind, case, method, wanted, after, path });
            tasks.len() - 1
        };
        let rendered = photographed.is_none();
        let capture: Vec<usize> =
            rendered.then(|| add(Kind::Capture, None, vec![])).into_iter().collect();
        let lights = (handed && rendered).then(|| add(Kind::Lights, None, capture.clone()));
        for (method, given) in suite.methods.iter().enumerate() {
            let lights = lights.filter(|_| given.gives_pictures());
            let inputs = capture.iter().copied().chain(lights).collect();
            let maps = add(Kind::Maps, Some(method), inputs);
            let inputs = capture.iter().copied().chain([maps]).collect();
            let relit = add(Kind::Relit, Some(method), inputs);
            let inputs = capture.iter().copied().chain([maps, relit]).collect();
            add(Kind::Scores, Some(method), inputs);
        }
    }
    tasks
}
