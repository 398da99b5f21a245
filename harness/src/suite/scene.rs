//! Scene files: references to faces, lights and rigs are resolved into one table
//! that stands alone, so that a capture's `truth/scene.toml` renders it again.

use std::path::{Path, PathBuf};

use formats::content_hash::hash_path;
use toml::{Table, Value};

use super::packaged;
use super::place;
use super::relative_path::beside;

/// Faults of a scene or suite file.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: String,
    },
    /// A file is not TOML.
    #[error("{path}:{line}: is not valid TOML: {reason}")]
    Syntax {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// The parser's error, on one line.
        reason: String,
    },
    /// A value is missing or of the wrong kind.
    #[error("{path}{}: {key}: {reason}", line.map_or(String::new(), |line| format!(":{line}")))]
    Value {
        /// The file.
        path: PathBuf,
        /// From 1; none where the key is not in the file.
        line: Option<usize>,
        /// The key in question.
        key: String,
        /// The fault and the fix.
        reason: String,
    },
}

impl SceneError {
    pub(super) fn value(path: &Path, key: &str, reason: impl Into<String>) -> Self {
        let line = place::line_of(path, None, key);
        Self::Value { path: path.to_path_buf(), line, key: key.to_owned(), reason: reason.into() }
    }

    /// A fault of the table of a list whose `name` is given.
    pub(super) fn in_table(path: &Path, name: &str, key: &str, reason: impl Into<String>) -> Self {
        let line = place::line_of(path, Some(name), key);
        Self::Value { path: path.to_path_buf(), line, key: key.to_owned(), reason: reason.into() }
    }
}

/// Keys of faces and lights that name files, which lie beside the file that names them.
const FILES: [&str; 8] = [
    "path",
    "mesh",
    "diffuse_albedo",
    "specular_albedo",
    "diffuse_normal",
    "specular_normal",
    "roughness",
    "labels",
];

/// The key of a light that is several: views are taken in them by turns.
const GROUPS: &str = "lights";

/// A scene whose face, lights and rig are spelt out.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The table that `truth/scene.toml` will hold.
    pub table: Table,
}

impl Scene {
    /// Reads a scene file and everything it refers to; `synth/unshade/scene_file` checks the keys and their values.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let mut table = read_toml(path)?;
        check_format(path, &table)?;
        for key in ["face", "light", "rig"] {
            let value = table.remove(key).ok_or_else(|| {
                SceneError::value(path, key, "is missing; name a file or write a table")
            })?;
            table.insert(key.to_owned(), Value::Table(resolve(path, key, value)?));
        }
        let relight = match table.remove("relight") {
            None => Vec::new(),
            Some(Value::Array(lights)) => lights
                .into_iter()
                .map(|light| resolve(path, "relight", light))
                .collect::<Result<_, _>>()?,
            Some(_) => return Err(SceneError::value(path, "relight", "must be a list of lights")),
        };
        let mut scene = Self { table };
        scene.set_relight(relight);
        Ok(scene)
    }

    /// A scene that nothing renders: the names of a face and of the light on it.
    pub fn named(face: &str, light: &str) -> Self {
        let named = |name: &str| {
            Value::Table(Table::from_iter([("name".to_owned(), Value::String(name.to_owned()))]))
        };
        let table = [("face", face), ("light", light)];
        Self { table: table.map(|(key, name)| (key.to_owned(), named(name))).into_iter().collect() }
    }

    /// The name of the face, the light or the rig.
    pub fn name_of(&self, section: &str) -> &str {
        self.table
            .get(section)
            .and_then(|table| table.get("name"))
            .and_then(Value::as_str)
            .unwrap_or_default()
    }

    /// The lights that are not the capture's own.
    pub fn relight(&self) -> Vec<Table> {
        match self.table.get("relight") {
            Some(Value::Array(lights)) => {
                lights.iter().filter_map(|light| light.as_table().cloned()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Every file that the face and the lights name.
    pub fn files(&self) -> Vec<PathBuf> {
        let own = ["face", "light"].into_iter().filter_map(|key| self.table.get(key)?.as_table());
        let groups = own.clone().filter_map(|table| table.get(GROUPS)?.as_array()).flatten();
        let relight = self.relight();
        own.chain(groups.filter_map(Value::as_table))
            .chain(&relight)
            .flat_map(|table| FILES.iter().filter_map(|key| table.get(*key)?.as_str()))
            .map(PathBuf::from)
            .collect()
    }

    /// The scene, and the content of the files that it names, as keys of stages hold it.
    pub fn key(&self) -> Result<[String; 2], SceneError> {
        let unwritten = |error: toml::ser::Error| SceneError::Value {
            path: PathBuf::from("scene"),
            line: None,
            key: self.name_of("face").to_owned(),
            reason: error.to_string(),
        };
        Ok([self.to_toml().map_err(unwritten)?, self.content()?])
    }

    /// A hash of the content of each of [`Self::files`].
    pub fn content(&self) -> Result<String, SceneError> {
        let hash = |path: PathBuf| {
            hash_path(&path).map_err(|error| SceneError::Read { path, reason: error.to_string() })
        };
        let hashes: Result<Vec<_>, _> = self.files().into_iter().map(hash).collect();
        Ok(hashes?.join(" "))
    }

    /// This scene with another face.
    pub fn with_face(mut self, face: Table) -> Self {
        self.table.insert("face".to_owned(), Value::Table(face));
        self
    }

    /// This scene captured in `light` and relit in all the single `others` of another name.
    pub fn with_lights(mut self, light: &Table, others: &[Table]) -> Self {
        let mut relight: Vec<Table> = Vec::new();
        for other in others {
            let name = other.get("name");
            let known = name == light.get("name") || relight.iter().any(|l| l.get("name") == name);
            // A picture is relit in one light.
            if !known && !other.contains_key(GROUPS) {
                relight.push(other.clone());
            }
        }
        self.table.insert("light".to_owned(), Value::Table(light.clone()));
        self.set_relight(relight);
        self
    }

    /// This scene in its own light alone.
    pub fn without_relight(mut self) -> Self {
        self.set_relight(Vec::new());
        self
    }

    /// This scene with single values replaced: tables are merged.
    pub fn with_changes(mut self, changes: &Table) -> Self {
        overlay(&mut self.table, changes);
        // Changed tables may be new, and the list has to stay behind them.
        let relight = self.relight();
        self.set_relight(relight);
        self
    }

    /// The scene as TOML text; equal scenes give equal text.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(&self.table)
    }

    fn set_relight(&mut self, lights: Vec<Table>) {
        // Arrays of tables come last in TOML, so the list is put behind everything else.
        self.table.remove("relight");
        let lights = lights.into_iter().map(Value::Table).collect();
        self.table.insert("relight".to_owned(), Value::Array(lights));
    }
}

/// The file that was typed or, of a plain name, that comes with unshade.
pub(super) fn typed(path: &Path, kind: packaged::Kind) -> Result<PathBuf, SceneError> {
    packaged::file(path, kind)
        .map_err(|reason| SceneError::Read { path: path.to_path_buf(), reason })
}

/// The file that `name`, the value of `key` in the file `from`, stands for.
pub(super) fn referenced(from: &Path, key: &str, name: &str) -> Result<PathBuf, SceneError> {
    packaged::referenced(from, key, name).map_err(|reason| SceneError::value(from, key, reason))
}

/// Endings of pictures of surroundings.
const ENVIRONMENTS: [&str; 2] = ["hdr", "exr"];

/// Reads a face, light or rig: a table as it stands, or the file that a string names. A picture of surroundings is a
/// light of its file's name.
pub(super) fn resolve(from: &Path, key: &str, value: Value) -> Result<Table, SceneError> {
    let (mut table, origin) = resolve_single(from, key, value)?;
    if packaged::Kind::of_key(key) == packaged::Kind::Light
        && let Some(Value::Array(groups)) = table.remove(GROUPS)
    {
        let single = |one| {
            let (light, _) = resolve_single(&origin, GROUPS, one)?;
            // A file could name itself.
            if light.contains_key(GROUPS) {
                let reason = "has a light that is several itself; name single lights";
                return Err(SceneError::value(&origin, GROUPS, reason));
            }
            Ok(Value::Table(light))
        };
        let groups = groups.into_iter().map(single).collect::<Result<_, _>>()?;
        table.insert(GROUPS.to_owned(), Value::Array(groups));
    }
    Ok(table)
}

/// Reads one table like [`resolve`], without the lights that it lists. Returns it with the file that holds it.
fn resolve_single(from: &Path, key: &str, value: Value) -> Result<(Table, PathBuf), SceneError> {
    let (mut table, origin) = match value {
        Value::Table(table) => (table, from.to_path_buf()),
        Value::String(name) if is_environment(key, &name) => {
            let stem = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
            let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
            let id = stem.chars().map(plain).collect::<String>();
            let table = [("name", id), ("kind", "envmap".to_owned()), ("path", name)];
            let table = table.map(|(key, value)| (key.to_owned(), Value::String(value)));
            (Table::from_iter(table), from.to_path_buf())
        }
        Value::String(name) => {
            let path = referenced(from, key, &name)?;
            (read_toml(&path)?, path)
        }
        _ => return Err(SceneError::value(from, key, "must be a file name or a table")),
    };
    if !matches!(table.get("name"), Some(Value::String(_))) {
        return Err(SceneError::value(
            &origin,
            "name",
            format!("is missing; give the {key} a name"),
        ));
    }
    resolve_files(&origin, &mut table);
    Ok((table, origin))
}

fn is_environment(key: &str, name: &str) -> bool {
    let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().to_lowercase();
    packaged::Kind::of_key(key) == packaged::Kind::Light && ENVIRONMENTS.contains(&&*ending)
}

/// The folder of the user's environment maps, where a light's `path` is sought if it is not beside the light's file.
const LIGHTS_FOLDER: &str = "UNSHADE_LIGHTS";

/// Makes the files that the table of a face or light names absolute; they lie beside `origin`.
pub(super) fn resolve_files(origin: &Path, table: &mut Table) {
    for key in FILES {
        if let Some(Value::String(path)) = table.get_mut(key) {
            let mut file = beside(origin, path);
            if let (false, "path", Some(folder)) =
                (file.exists(), key, std::env::var_os(LIGHTS_FOLDER))
            {
                file = Path::new(&folder).join(path.as_str());
            }
            *path = std::path::absolute(&file).unwrap_or(file).to_string_lossy().into_owned();
        }
    }
}

/// Lays `above` over `below`: tables are merged, everything else is replaced.
pub(super) fn overlay(below: &mut Table, above: &Table) {
    for (key, value) in above {
        match (below.get_mut(key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => overlay(old, new),
            _ => drop(below.insert(key.clone(), value.clone())),
        }
    }
}

/// Ids become folder names.
pub(super) fn check_id(path: &Path, id: &str) -> Result<(), SceneError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if id.is_empty() || !id.chars().all(plain) {
        let reason = format!("{id:?} cannot name a folder; use letters, digits, - and _");
        return Err(SceneError::value(path, "name", reason));
    }
    Ok(())
}

pub(super) fn read_toml(path: &Path) -> Result<Table, SceneError> {
    // A file may name another with a line's end in it; a message is one line.
    let shown = || PathBuf::from(path.to_string_lossy().replace(char::is_control, " "));
    let text = std::fs::read_to_string(path)
        .map_err(|error| SceneError::Read { path: shown(), reason: error.to_string() })?;
    text.parse::<Table>().map_err(|error| SceneError::Syntax {
        path: shown(),
        line: error.span().map_or(1, |span| place::line_at(&text, span.start)),
        reason: error.message().replace('\n', " "),
    })
}

pub(super) fn check_format(path: &Path, table: &Table) -> Result<(), SceneError> {
    match table.get("format") {
        Some(Value::Integer(1)) => Ok(()),
        Some(other) => {
            Err(SceneError::value(path, "format", format!("is {other}; this version reads 1")))
        }
        None => Err(SceneError::value(path, "format", "is missing; write format = 1")),
    }
}

pub(super) fn check_keys(path: &Path, table: &Table, known: &[&str]) -> Result<(), SceneError> {
    match table.keys().find(|key| !known.contains(&key.as_str())) {
        Some(key) => {
            Err(SceneError::value(path, key, format!("is unknown; there are {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
