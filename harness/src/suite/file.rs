//! Suite files: which faces, lights, variants and solvers are run against each other.

use std::path::{Path, PathBuf};

use scoring::run::Class;
use toml::{Table, Value};

use super::cases::{self, Case};
use super::error::RunError;
use super::method::{self, Method};
use super::near;
use super::own_metrics::OwnMetrics;
use super::packaged::Kind;
use super::relative_path;
use super::scene::{self, Scene, SceneError};

const KEYS: [&str; 17] = [
    "format", "name", "title", "author", "scene", "captures", "faces", "lights", "face", "render",
    "variant", "seeds", "scales", "relight", "lpips", "metrics", "method",
];

/// Keys that say something of a scene.
const OF_SCENES: [&str; 6] = ["faces", "lights", "face", "render", "variant", "seeds"];

/// Factors on the diffuse albedo before maps are relit: none, and the one factor that aligns it with
/// the truth.
pub const SCALES: [&str; 2] = ["none", "global"];

/// Renderers that can relight maps: that of the truth, and a second judge.
pub const RENDERERS: [&str; 2] = ["mitsuba", "cycles"];

/// Networks that can judge pictures (LPIPS); the weights on their features are of version 0.1.
pub const NETS: [&str; 2] = ["alex", "vgg"];

/// A suite with its cases spelt out.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The file.
    pub path: PathBuf,
    /// Short name.
    pub name: String,
    /// Shown in the report.
    pub title: String,
    /// Every face in every input light, in every variant.
    pub cases: Vec<Case>,
    /// Solvers and baselines in the order of the table.
    pub methods: Vec<Method>,
    /// Those of [`SCALES`] under which maps are relit.
    pub scales: Vec<&'static str>,
    /// Renderer that relights maps: one of [`RENDERERS`].
    pub relight: &'static str,
    /// Network that judges pictures beside the scores, one of [`NETS`]; none if nobody asks for it.
    pub lpips: Option<&'static str>,
    /// Metrics of the user, beside unshade's own.
    pub metrics: OwnMetrics,
    /// The file's text, kept with the results.
    pub text: String,
    /// Names of the methods that are run; empty for all.
    pub only_methods: Vec<String>,
    /// Ids of the cases that are run; empty for all.
    pub only_cases: Vec<String>,
}

impl Suite {
    /// Reads a suite file, or a suite that comes with unshade, with its scene, faces and lights.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let suite = Self::open_for_captures(path)?;
        match suite.methods.is_empty() {
            true => {
                let reason = "is missing; write [[method]] tables";
                Err(SceneError::value(&suite.path, "method", reason))
            }
            false => Ok(suite),
        }
    }

    /// Opens a suite that may have no methods: only its captures are rendered.
    pub fn open_for_captures(path: &Path) -> Result<Self, SceneError> {
        let path = &scene::typed(path, Kind::Suite)?;
        let table = scene::read_toml(path)?;
        scene::check_format(path, &table)?;
        if table.contains_key("solver") {
            let reason = "has been renamed; write [[method]] tables";
            return Err(SceneError::value(path, "solver", reason));
        }
        scene::check_keys(path, &table, &KEYS)?;
        let name = text_of(path, &table, "name")?;
        let photographed = cases::photographed(path, &table)?;
        let mut cases = if photographed.is_empty() || table.contains_key("scene") {
            rendered(path, &table)?
        } else if let Some(key) = OF_SCENES.into_iter().find(|key| table.contains_key(*key)) {
            let reason = "does not apply to captures; remove it, or name a scene";
            return Err(SceneError::value(path, key, reason));
        } else {
            Vec::new()
        };
        let twice = |case: &Case| photographed.iter().any(|other| other.id == case.id);
        if let Some(case) = cases.iter().find(|case| twice(case)) {
            let reason =
                format!("{} is the name of a rendered case too; rename the folder", case.id);
            return Err(SceneError::value(path, "captures", reason));
        }
        let methods = method::methods_of(path, &table)?;
        let privileged = methods.iter().find(|method| method.work().class() == Class::Privileged);
        if let (Some(method), false) = (privileged, photographed.is_empty()) {
            let reason =
                format!("photographs have no true maps; remove the method {:?}", method.id);
            return Err(SceneError::in_table(path, &method.id, "name", reason));
        }
        cases.extend(photographed);
        let scales = scales_of(path, &table)?;
        let relight = one_of(path, &table, "relight", &RENDERERS)?.unwrap_or(RENDERERS[0]);
        let lpips = one_of(path, &table, "lpips", &NETS)?;
        let metrics = own_metrics(path, &table)?;
        let title = table.get("title").and_then(Value::as_str).unwrap_or(&name).to_owned();
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::Read {
            path: path.to_path_buf(),
            reason: error.to_string(),
        })?;
        let path = path.to_path_buf();
        let (only_methods, only_cases) = (Vec::new(), Vec::new());
        Ok(Self {
            path,
            name,
            title,
            cases,
            methods,
            scales,
            relight,
            lpips,
            metrics,
            text,
            only_methods,
            only_cases,
        })
    }

    /// This suite, of which no more is run than these methods and cases; of an empty list, all. A name that several
    /// methods of a sweep share stands for all of them.
    pub fn only(mut self, methods: Vec<String>, cases: Vec<String>) -> Result<Self, RunError> {
        let mut known: Vec<&str> = Vec::new();
        for name in self.methods.iter().flat_map(|method| [&method.stated, &method.id]) {
            if !known.contains(&name.as_str()) {
                known.push(name);
            }
        }
        let is_known = |name: &&String| self.methods.iter().any(|method| method.is_named(name));
        if let Some(name) = methods.iter().find(|name| !is_known(name)) {
            let reason = near::unknown("the suite has no method", name, &known);
            return Err(RunError::UnknownName { flag: "--method", reason });
        }
        let known: Vec<&str> = self.cases.iter().map(|case| case.id.as_str()).collect();
        if let Some(name) = cases.iter().find(|name| !known.contains(&name.as_str())) {
            let reason = near::unknown("the suite has no case", name, &known);
            return Err(RunError::UnknownName { flag: "--case", reason });
        }
        (self.only_methods, self.only_cases) = (methods, cases);
        Ok(self)
    }

    /// Whether a case is run, and not only kept.
    pub(super) fn runs_case(&self, case: &Case) -> bool {
        self.only_cases.is_empty() || self.only_cases.contains(&case.id)
    }

    /// Whether a method is run, and not only kept.
    pub(super) fn runs_method(&self, method: &Method) -> bool {
        self.only_methods.is_empty() || self.only_methods.iter().any(|name| method.is_named(name))
    }
}

/// The cases of the suite's scene.
fn rendered(path: &Path, table: &Table) -> Result<Vec<Case>, SceneError> {
    let mut base =
        Scene::open(&scene::referenced(path, "scene", &text_of(path, table, "scene")?)?)?;
    match table.get("render") {
        None => {}
        Some(Value::Table(_)) => {
            let render = ("render".to_owned(), table["render"].clone());
            base = base.with_changes(&Table::from_iter([render]));
        }
        Some(_) => return Err(SceneError::value(path, "render", "must be a table")),
    }
    cases::cases_of(path, &base, table)
}

fn own_metrics(path: &Path, table: &Table) -> Result<OwnMetrics, SceneError> {
    let Some(listed) = table.get("metrics") else { return Ok(OwnMetrics::default()) };
    let names: Option<Vec<String>> =
        listed.as_array().and_then(|l| l.iter().map(|v| v.as_str().map(str::to_owned)).collect());
    let names = names.filter(|names| !names.is_empty()).ok_or_else(|| {
        let reason = "must be a list of functions; write [\"module:function\"] or [\"file.py\"]";
        SceneError::value(path, "metrics", reason)
    })?;
    Ok(OwnMetrics::new(names, relative_path::beside(path, "")))
}

fn scales_of(path: &Path, table: &Table) -> Result<Vec<&'static str>, SceneError> {
    let Some(scales) = table.get("scales") else { return Ok(SCALES.to_vec()) };
    let wanted: Vec<&str> =
        scales.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let known: Vec<_> = SCALES.into_iter().filter(|scale| wanted.contains(scale)).collect();
    if known.is_empty() || scales.as_array().is_none_or(|all| all.len() != known.len()) {
        let reason = format!("must be a list of some of {}, each once", SCALES.join(", "));
        return Err(SceneError::value(path, "scales", reason));
    }
    Ok(known)
}

fn one_of(
    path: &Path,
    table: &Table,
    key: &str,
    known: &[&'static str],
) -> Result<Option<&'static str>, SceneError> {
    let Some(wanted) = table.get(key) else { return Ok(None) };
    let found = known.iter().find(|known| wanted.as_str() == Some(known)).copied();
    let reason = || SceneError::value(path, key, format!("must be one of {}", known.join(", ")));
    found.map(Some).ok_or_else(reason)
}

fn text_of(path: &Path, table: &Table, key: &str) -> Result<String, SceneError> {
    match table.get(key) {
        Some(Value::String(text)) => Ok(text.clone()),
        Some(_) => Err(SceneError::value(path, key, "must be a text")),
        None => Err(SceneError::value(path, key, "is missing")),
    }
}

#[cfg(test)]
mod tests;
