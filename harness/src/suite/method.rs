//! The `[[method]]` tables of a suite: who is run, and how each is started.

use std::collections::BTreeMap;
use std::path::Path;

use capture::TruthPart;
use serde::Deserialize;
use solver::{BackendError, Choice};
use toml::{Table, Value};

use super::baseline::BaselineMethod;
use super::competitor::Competitor;
use super::program::{Gives, Limits, PLACEHOLDERS, Program, Start};
use super::relative_path;
use super::scene::{self, SceneError};
use super::sweep::replicates;

/// The methods that read the truth, as a suite names them.
const ORACLE: &str = "oracle";
const LABEL_MEANS: &str = "label-means";

/// Our own solver.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverMethod {
    /// Its settings, TOML text that names its `base`.
    pub config: String,
    /// The device that computes.
    pub backend: Choice,
    /// Parts that it holds at their truth, which makes it privileged.
    pub given: Vec<TruthPart>,
}

/// A method that comes with unshade and is not a configuration of its solver.
#[derive(Clone, Debug, PartialEq)]
pub struct CompetitorMethod {
    /// Which one.
    pub competitor: Competitor,
    /// Its settings as JSON.
    pub settings: String,
}

/// An answer that needs no optimisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaselineSettings {
    /// Which one.
    pub baseline: BaselineMethod,
    /// Side of its textures, texels.
    pub texture_size: usize,
}

/// A kind of method with its settings; [`methods`](super::methods) has what each does.
#[derive(Clone, Debug, PartialEq)]
pub enum MethodKind {
    /// Our own solver.
    Solver(SolverMethod),
    /// A program of the user.
    Program(Box<Program>),
    /// The true maps: the floor that rendering noise and the pipeline set.
    Oracle,
    /// A method of the Python package.
    Competitor(CompetitorMethod),
    /// The true mean colour of every label: made from the truth too, see [`scoring::score::label_mean_maps`].
    LabelMeans,
    /// A baseline.
    Baseline(BaselineSettings),
}

/// A method of a suite: one `[[method]]` table, or one value of its `sweep` or `seeds`.
#[derive(Clone, Debug)]
pub struct Method {
    /// Names its folders; letters, digits, `-` and `_`.
    pub id: String,
    /// Shown in the report.
    pub title: String,
    /// How it is started.
    pub kind: MethodKind,
    /// The method's name and the seed, for a method with several seeds.
    pub replicate: Option<(String, u64)>,
    /// Who made it, of a program: its own `author`, else that of the suite.
    pub author: Option<String>,
    /// Its `name` in the file, which several methods of a sweep share.
    pub stated: String,
    /// Single values that replace those of its configuration, or are handed to its program.
    pub set: Table,
}

impl Method {
    /// Whether a name of the command line stands for it: its own, or that of its table.
    pub(super) fn is_named(&self, name: &str) -> bool {
        [&self.id, &self.stated].iter().any(|known| *known == name)
    }
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct MethodTable {
    name: String,
    title: Option<String>,
    author: Option<String>,
    /// Preset, configuration file or competitor; without it the name is the preset or the competitor.
    config: Option<String>,
    /// Single values that replace those of the configuration, or are handed to a program.
    #[serde(default)]
    set: Table,
    /// Lists of such values: the method is run once with each combination.
    #[serde(default)]
    sweep: Table,
    /// Seeds: the method is run once with each.
    seeds: Option<Value>,
    backend: Option<String>,
    /// Parts of the truth that our own solver holds fixed.
    #[serde(default)]
    given: Vec<String>,
    command: Option<CommandLine>,
    python: Option<String>,
    /// Side of the textures of a baseline, or of a program that gives pictures.
    texture_size: Option<usize>,
    /// Outputs of a program.
    gives: Option<Gives>,
    timeout_s: Option<f64>,
    memory_gib: Option<f64>,
    threads: Option<usize>,
    version: Option<String>,
    inputs: Option<Vec<String>>,
    environment: Option<BTreeMap<String, String>>,
    /// Whether a program may use the network.
    network: Option<bool>,
}

#[derive(Clone, Deserialize)]
#[serde(untagged)]
enum CommandLine {
    Words(Vec<String>),
    Line(String),
}

/// The methods in the order of the file.
pub(super) fn methods_of(path: &Path, table: &Table) -> Result<Vec<Method>, SceneError> {
    let list = match table.get("method") {
        None => return Ok(Vec::new()),
        Some(Value::Array(list)) => list,
        Some(_) => {
            return Err(SceneError::value(path, "method", "must be tables; write [[method]]"));
        }
    };
    let author = match table.get("author") {
        None => None,
        Some(Value::String(author)) => Some(author.clone()),
        Some(_) => return Err(SceneError::value(path, "author", "must be a text")),
    };
    let mut methods: Vec<Method> = Vec::new();
    for value in list {
        let name = value.get("name").and_then(Value::as_str).unwrap_or_default();
        let read = |value: Value| -> Result<MethodTable, SceneError> {
            let table = value.try_into();
            table.map_err(|error: toml::de::Error| {
                SceneError::in_table(path, name, "method", error.message())
            })
        };
        // Before `sweep` and `seeds` are removed from the table.
        read(value.clone())?.check_keys(path)?;
        for (replicate, table) in replicates(path, value.as_table().unwrap_or(&Table::new()))? {
            let method = method_of(path, read(Value::Table(table))?)?;
            let of_suite =
                || author.clone().filter(|_| matches!(method.kind, MethodKind::Program(_)));
            let author = method.author.clone().or_else(of_suite);
            let method = Method { replicate, author, stated: name.to_owned(), ..method };
            if methods.iter().any(|other| other.id == method.id) {
                let reason = format!("{:?} occurs twice; rename one", method.id);
                return Err(SceneError::value(path, "method", reason));
            }
            methods.push(method);
        }
    }
    Ok(methods)
}

fn method_of(path: &Path, table: MethodTable) -> Result<Method, SceneError> {
    scene::check_id(path, &table.name)?;
    table.check_keys(path)?;
    let program = table.program(path)?;
    let baseline = BaselineMethod::ALL.into_iter().find(|method| method.name() == table.name);
    let competitor = table.competitor();
    let kind = match (program, table.name.as_str()) {
        (Some(program), _) => MethodKind::Program(Box::new(program)),
        (None, ORACLE) => MethodKind::Oracle,
        (None, LABEL_MEANS) => MethodKind::LabelMeans,
        (None, name) => match baseline {
            None if let Some(competitor) = competitor => {
                let settings = serde_json::to_string(&table.set)
                    .map_err(|error| SceneError::in_table(path, name, "set", error.to_string()))?;
                MethodKind::Competitor(CompetitorMethod { competitor, settings })
            }
            Some(baseline) => {
                let texture_size = table.texture_size(path)?;
                MethodKind::Baseline(BaselineSettings { baseline, texture_size })
            }
            None => MethodKind::Solver(SolverMethod {
                config: config_text(path, name, table.config.as_deref(), &table.set)?,
                backend: table.backend.as_deref().map_or(Ok(Choice::Auto), str::parse).map_err(
                    |error: BackendError| {
                        SceneError::in_table(path, name, "backend", error.to_string())
                    },
                )?,
                given: table.truth_parts(path)?,
            }),
        },
    };
    let title = table.title.unwrap_or_else(|| kind.work().title(&table.name));
    let stated = table.name.clone();
    let author = table.author;
    Ok(Method { id: table.name, title, kind, replicate: None, author, stated, set: table.set })
}

impl MethodTable {
    /// The competitor that it is: of the configuration's name or, without one, of its own.
    fn competitor(&self) -> Option<Competitor> {
        let baseline = BaselineMethod::ALL.iter().any(|method| method.name() == self.name);
        let taken = baseline || [ORACLE, LABEL_MEANS].contains(&self.name.as_str());
        let foreign = self.command.is_some() || self.python.is_some();
        let named = Competitor::find(self.config.as_ref().unwrap_or(&self.name));
        named.filter(|_| !taken && !foreign)
    }

    /// The program of the table, if it names one.
    fn program(&self, path: &Path) -> Result<Option<Program>, SceneError> {
        let start = match (&self.command, &self.python) {
            (Some(CommandLine::Words(words)), _) => Start::Command(words.clone()),
            (Some(CommandLine::Line(line)), _) => {
                Start::Command(line.split_whitespace().map(str::to_owned).collect())
            }
            (None, Some(function)) => Start::Python(function.clone()),
            (None, None) => return Ok(None),
        };
        let wrong = |key: &str, reason: &str| {
            Err(SceneError::in_table(path, &self.name, key, reason.to_owned()))
        };
        let positive = |value: Option<f64>| value.is_none_or(|v| v > 0.0 && v.is_finite());
        if !positive(self.timeout_s) {
            return wrong("timeout_s", "must be seconds above 0");
        }
        if !positive(self.memory_gib) {
            return wrong("memory_gib", "must be GiB above 0");
        }
        if self.threads == Some(0) {
            return wrong("threads", "must be 1 or more");
        }
        let gives = self.gives.unwrap_or_default();
        if gives == Gives::Pictures && self.command.is_none() {
            return wrong("gives", "is pictures, which a function cannot return; write a command");
        }
        if let Some(key) = PLACEHOLDERS.into_iter().find(|place| self.set.contains_key(*place)) {
            let reason =
                format!("{key} is the name of a path that the program is given; rename it");
            return wrong("set", &reason);
        }
        let Self { timeout_s, memory_gib, threads, .. } = *self;
        let folder = relative_path::folder_of(path);
        Ok(Some(Program {
            gives,
            texture_size: self.texture_size(path)?,
            start,
            inputs: self.inputs.iter().flatten().map(|input| folder.join(input)).collect(),
            folder,
            limits: Limits { timeout_s, memory_gib, threads },
            environment: self.environment.clone().unwrap_or_default(),
            version: self.version.clone(),
            settings: self.set.clone(),
            network: self.network.unwrap_or_default(),
        }))
    }

    /// The parts that our own solver holds at their truth.
    fn truth_parts(&self, path: &Path) -> Result<Vec<TruthPart>, SceneError> {
        let part = |name: &String| format!("{name}=truth").parse();
        let parts: Result<_, String> = self.given.iter().map(part).collect();
        parts.map_err(|reason| SceneError::in_table(path, &self.name, "given", reason))
    }

    /// Side of what is projected into the texture, texels.
    fn texture_size(&self, path: &Path) -> Result<usize, SceneError> {
        let size = self.texture_size.unwrap_or(BaselineMethod::TEXTURE_SIZE);
        if (16..=8192).contains(&size) {
            return Ok(size);
        }
        let reason = format!("{size} of {:?} is not from 16 to 8192", self.name);
        Err(SceneError::in_table(path, &self.name, "texture_size", reason))
    }

    /// Refuses keys that would do nothing.
    fn check_keys(&self, path: &Path) -> Result<(), SceneError> {
        // Without `..`, so that a new key does not compile until a list below names the methods that support it.
        let Self {
            name,
            title: _,
            author,
            config,
            set,
            sweep,
            seeds,
            backend,
            given: truth,
            command,
            python,
            texture_size,
            gives,
            timeout_s,
            memory_gib,
            threads,
            version,
            inputs,
            environment,
            network,
        } = self;
        let refused = |reason: String| {
            let reason = format!("{name:?} {reason}");
            Err(SceneError::in_table(path, name, "method", reason))
        };
        let foreign = command.is_some() || python.is_some();
        if command.is_some() && python.is_some() {
            return refused("has both command and python; remove one".to_owned());
        }
        let baseline = BaselineMethod::ALL.iter().any(|method| method.name() == name);
        let pictures = *gives == Some(Gives::Pictures);
        let competitor = self.competitor().is_some();
        let fields =
            !foreign && !baseline && !competitor && ![ORACLE, LABEL_MEANS].contains(&&**name);
        for (key, given, means) in [
            ("author", author.is_some(), foreign),
            ("config", config.is_some(), fields || competitor),
            ("set", !set.is_empty(), fields || competitor || foreign),
            ("sweep", !sweep.is_empty(), fields || competitor || foreign),
            ("seeds", seeds.is_some(), fields || foreign),
            ("backend", backend.is_some(), fields),
            ("given", !truth.is_empty(), fields),
            ("texture_size", texture_size.is_some(), if foreign { pictures } else { baseline }),
            ("gives", gives.is_some(), foreign),
            ("timeout_s", timeout_s.is_some(), foreign),
            ("memory_gib", memory_gib.is_some(), foreign),
            ("threads", threads.is_some(), foreign),
            ("version", version.is_some(), foreign),
            ("inputs", inputs.is_some(), foreign),
            ("environment", environment.is_some(), foreign),
            ("network", network.is_some(), foreign),
        ] {
            if given && !means {
                let fix = match key {
                    "texture_size" if competitor => "; write set = { texture_size = ... }",
                    "texture_size" if fields => {
                        "; write [method.set.maps] texture_size, or [method.set.fine_tuning] texture_size for `paper`"
                    }
                    _ => "; remove it",
                };
                return refused(format!("does not support {key}{fix}"));
            }
        }
        Ok(())
    }
}

/// The configuration as TOML text: a file's, or one that names a preset, with `set` on top. Checked
/// here, so that a wrong key is told with its place and before anything is rendered.
fn config_text(
    path: &Path,
    name: &str,
    config: Option<&str>,
    set: &Table,
) -> Result<String, SceneError> {
    let key = if config.is_some() { "config" } else { "name" };
    let config = config.unwrap_or(name);
    let mut table = if config.ends_with(".toml") {
        scene::read_toml(&relative_path::beside(path, config))?
    } else {
        Table::from_iter([("base".to_owned(), Value::String(config.to_owned()))])
    };
    scene::overlay(&mut table, set);
    let wrong = |reason: String| SceneError::in_table(path, name, key, reason);
    let text = toml::to_string(&table).map_err(|error| wrong(error.to_string()))?;
    match solver::Config::from_toml(&text) {
        Ok(_) => Ok(text),
        Err(error) => Err(wrong(error.to_string())),
    }
}
