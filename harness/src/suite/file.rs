//! Suite files: which faces, lights and solvers are run against each other.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::{Table, Value};

use super::scene::{self, Scene, SceneError};

/// One capture: a face in a light.
#[derive(Clone, Debug)]
pub struct Case {
    /// `<face>-<light>`.
    pub id: String,
    /// What is rendered.
    pub scene: Scene,
}

/// How a solver is started.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// Our own solver with these settings (TOML text that names its `base`).
    Fields {
        /// A preset's name or the text of a configuration.
        config: String,
        /// `auto`, `cpu` or `gpu`.
        backend: String,
    },
    /// Any program: arguments with `{capture}` and `{maps}` replaced.
    Command(Vec<String>),
    /// A Python function `module:function(capture, maps)`.
    Python(String),
    /// The true maps: the floor that rendering noise and the pipeline set.
    Oracle,
    /// The mean of the projected colours as diffuse albedo.
    MeanTexture,
}

/// A column of the table.
#[derive(Clone, Debug)]
pub struct Entrant {
    /// Names its folders; letters, digits, `-` and `_`.
    pub id: String,
    /// Shown in the report.
    pub title: String,
    /// How it is started.
    pub method: Method,
}

impl Entrant {
    /// `solver`, `baseline` or `oracle`.
    pub fn kind(&self) -> &'static str {
        match self.method {
            Method::Oracle => "oracle",
            Method::MeanTexture => "baseline",
            _ => "solver",
        }
    }
}

/// A suite with its cases spelt out.
#[derive(Clone, Debug)]
pub struct Suite {
    /// Short name.
    pub name: String,
    /// Shown in the report.
    pub title: String,
    /// Every face in every input light.
    pub cases: Vec<Case>,
    /// Solvers and baselines in the order of the table.
    pub entrants: Vec<Entrant>,
    /// The file's text, kept with the results.
    pub text: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SolverTable {
    name: String,
    title: Option<String>,
    /// Preset or configuration file; without it the name is the preset.
    config: Option<String>,
    /// Single values that replace those of the configuration.
    #[serde(default)]
    set: Table,
    backend: Option<String>,
    command: Option<CommandLine>,
    python: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum CommandLine {
    Words(Vec<String>),
    Line(String),
}

impl Suite {
    /// Reads a suite file, its scene, faces and lights.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let table = scene::read_toml(path)?;
        scene::check_format(path, &table)?;
        scene::check_keys(
            path,
            &table,
            &["format", "name", "title", "scene", "faces", "lights", "render", "solver"],
        )?;
        let name = text_of(path, &table, "name")?;
        let base_path = beside(path, &text_of(path, &table, "scene")?);
        let mut base = Scene::open(&base_path)?;
        if let Some(render) = table.get("render") {
            override_render(path, &mut base, render)?;
        }
        let faces = referenced(path, &table, "faces")?;
        let lights = referenced(path, &table, "lights")?;
        let cases = cases_of(path, &base, &faces, &lights)?;
        let entrants = entrants_of(path, &table)?;
        let title = table.get("title").and_then(Value::as_str).unwrap_or(&name).to_owned();
        let text = std::fs::read_to_string(path).map_err(|error| SceneError::Read {
            path: path.to_path_buf(),
            reason: error.to_string(),
        })?;
        Ok(Self { name, title, cases, entrants, text })
    }
}

fn beside(path: &Path, name: &str) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

fn text_of(path: &Path, table: &Table, key: &str) -> Result<String, SceneError> {
    match table.get(key) {
        Some(Value::String(text)) => Ok(text.clone()),
        Some(_) => Err(SceneError::value(path, key, "must be a text")),
        None => Err(SceneError::value(path, key, "is missing")),
    }
}

fn referenced(path: &Path, table: &Table, key: &str) -> Result<Vec<Table>, SceneError> {
    match table.get(key) {
        None => Ok(Vec::new()),
        Some(Value::Array(list)) if !list.is_empty() => {
            list.iter().map(|value| scene::resolve(path, key, value.clone())).collect()
        }
        Some(_) => Err(SceneError::value(path, key, "must be a list of file names or tables")),
    }
}

fn override_render(path: &Path, scene: &mut Scene, render: &Value) -> Result<(), SceneError> {
    let (Value::Table(render), Some(Value::Table(target))) =
        (render, scene.table.get_mut("render"))
    else {
        return Err(SceneError::value(path, "render", "must be a table"));
    };
    for (key, value) in render {
        target.insert(key.clone(), value.clone());
    }
    Ok(())
}

fn cases_of(
    path: &Path,
    base: &Scene,
    faces: &[Table],
    lights: &[Table],
) -> Result<Vec<Case>, SceneError> {
    let section = |name: &str| base.table.get(name).and_then(Value::as_table).cloned();
    let own_face: Vec<Table> = section("face").into_iter().collect();
    let own_light: Vec<Table> = section("light").into_iter().collect();
    let faces = if faces.is_empty() { &own_face } else { faces };
    let lights = if lights.is_empty() { &own_light } else { lights };
    let others: Vec<Table> = lights.iter().cloned().chain(base.relight()).collect();
    let mut cases: Vec<Case> = Vec::new();
    for face in faces {
        for light in lights {
            let scene = base.clone().with_face(face.clone()).with_lights(light, &others);
            let id = format!("{}-{}", scene.name_of("face"), scene.name_of("light"));
            check_id(path, &id)?;
            if cases.iter().any(|case| case.id == id) {
                return Err(SceneError::value(
                    path,
                    "faces",
                    format!("{id} occurs twice; rename one"),
                ));
            }
            let mut scene = scene;
            scene.table.insert("name".to_owned(), Value::String(id.clone()));
            cases.push(Case { id, scene });
        }
    }
    Ok(cases)
}

fn entrants_of(path: &Path, table: &Table) -> Result<Vec<Entrant>, SceneError> {
    let list = match table.get("solver") {
        Some(Value::Array(list)) if !list.is_empty() => list,
        _ => return Err(SceneError::value(path, "solver", "is missing; write [[solver]] tables")),
    };
    let mut entrants: Vec<Entrant> = Vec::new();
    for value in list {
        let solver: SolverTable = value
            .clone()
            .try_into()
            .map_err(|error: toml::de::Error| SceneError::value(path, "solver", error.message()))?;
        let entrant = entrant_of(path, solver)?;
        if entrants.iter().any(|other| other.id == entrant.id) {
            let reason = format!("{:?} occurs twice; rename one", entrant.id);
            return Err(SceneError::value(path, "solver", reason));
        }
        entrants.push(entrant);
    }
    Ok(entrants)
}

fn entrant_of(path: &Path, solver: SolverTable) -> Result<Entrant, SceneError> {
    check_id(path, &solver.name)?;
    let method = match (solver.command, solver.python, solver.name.as_str()) {
        (Some(_), Some(_), _) => {
            let reason = format!("{:?} has both a command and a python function", solver.name);
            return Err(SceneError::value(path, "solver", reason));
        }
        (Some(CommandLine::Words(words)), None, _) => Method::Command(words),
        (Some(CommandLine::Line(line)), None, _) => {
            Method::Command(line.split_whitespace().map(str::to_owned).collect())
        }
        (None, Some(function), _) => Method::Python(function),
        (None, None, "oracle") => Method::Oracle,
        (None, None, "mean_texture") => Method::MeanTexture,
        (None, None, name) => Method::Fields {
            config: config_text(path, solver.config.as_deref().unwrap_or(name), &solver.set)?,
            backend: solver.backend.unwrap_or_else(|| "auto".to_owned()),
        },
    };
    let title = solver.title.unwrap_or_else(|| match method {
        Method::Oracle => "oracle (true maps)".to_owned(),
        Method::MeanTexture => "mean projected texture".to_owned(),
        _ => solver.name.clone(),
    });
    Ok(Entrant { id: solver.name, title, method })
}

/// The configuration as TOML text: a file's, or one that names a preset, with `set` on top.
fn config_text(path: &Path, config: &str, set: &Table) -> Result<String, SceneError> {
    let mut table = if config.ends_with(".toml") {
        scene::read_toml(&beside(path, config))?
    } else {
        Table::from_iter([("base".to_owned(), Value::String(config.to_owned()))])
    };
    for (key, value) in set {
        match (table.get_mut(key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => old.extend(new.clone()),
            _ => drop(table.insert(key.clone(), value.clone())),
        }
    }
    toml::to_string(&table).map_err(|error| SceneError::value(path, "solver", error.to_string()))
}

/// Ids become folder names.
fn check_id(path: &Path, id: &str) -> Result<(), SceneError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if id.is_empty() || !id.chars().all(plain) {
        let reason = format!("{id:?} cannot name a folder; use letters, digits, - and _");
        return Err(SceneError::value(path, "name", reason));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        path
    }

    fn scenes(folder: &Path) {
        write(folder, "face.toml", "name = \"ada\"\nseed = 3\n");
        write(folder, "lights/key.toml", "name = \"key\"\nkind = \"studio\"\n");
        write(
            folder,
            "lights/hall.toml",
            "name = \"hall\"\nkind = \"envmap\"\npath = \"hall.exr\"\n",
        );
        write(
            folder,
            "scene.toml",
            "format = 1\nname = \"s\"\nface = \"face.toml\"\nlight = \"lights/key.toml\"\n\
             relight = [\"lights/hall.toml\"]\nrig = { name = \"r\", kind = \"phone\" }\n\
             [render]\nwidth = 8\nheight = 8\n",
        );
    }

    #[test]
    fn every_light_is_relit_in_all_the_others() {
        let root = tempfile::tempdir().unwrap();
        scenes(root.path());
        let path = write(
            root.path(),
            "suite.toml",
            "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n\
             lights = [\"lights/key.toml\", \"lights/hall.toml\"]\n[render]\nwidth = 16\n\
             [[solver]]\nname = \"paper\"\nset = { seed = 4 }\n\
             [[solver]]\nname = \"mine\"\ncommand = \"run {capture} {maps}\"\n",
        );
        let suite = Suite::open(&path).unwrap();
        let ids: Vec<_> = suite.cases.iter().map(|case| case.id.as_str()).collect();
        assert_eq!(ids, ["ada-key", "ada-hall"]);
        let relit = suite.cases[1].scene.relight();
        assert_eq!(relit.len(), 1);
        assert_eq!(relit[0]["name"].as_str(), Some("key"));
        // The picture of a light is found beside the light's own file.
        let hall = suite.cases[1].scene.table["light"]["path"].as_str().unwrap();
        assert_eq!(Path::new(hall), root.path().join("lights/hall.exr"));
        assert_eq!(suite.cases[0].scene.table["render"]["width"].as_integer(), Some(16));
        let Method::Fields { config, .. } = &suite.entrants[0].method else { panic!() };
        assert_eq!(config.parse::<Table>().unwrap()["seed"].as_integer(), Some(4));
        assert_eq!(
            suite.entrants[1].method,
            Method::Command(vec!["run".into(), "{capture}".into(), "{maps}".into()])
        );
        // The resolved text stands alone: it parses back to the same scene.
        let text = suite.cases[0].scene.to_toml().unwrap();
        assert_eq!(text.parse::<Table>().unwrap(), suite.cases[0].scene.table);
    }

    #[test]
    fn errors_name_the_file_the_key_and_the_mend() {
        let root = tempfile::tempdir().unwrap();
        scenes(root.path());
        let head = "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n";
        for (text, expected) in [
            ("name = \"m\"\n", "format: is missing; write format = 1"),
            (&*format!("{head}solvers = 1\n"), "solvers: is unknown; there are"),
            (head, "solver: is missing; write [[solver]] tables"),
            (&*format!("{head}[[solver]]\nname = \"a b\"\n"), "cannot name a folder"),
            (&*format!("{head}[[solver]]\nname = \"a\"\nthreads = 2\n"), "unknown field `threads`"),
            (
                &*format!("{head}faces = [\"no.toml\"]\n[[solver]]\nname = \"a\"\n"),
                "no.toml: cannot be read",
            ),
        ] {
            let path = write(root.path(), "suite.toml", text);
            let error = Suite::open(&path).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
