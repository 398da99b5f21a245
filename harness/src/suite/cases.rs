//! The cases of a suite: every face in every light, in every variant of the scene.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use formats::atomic;
use scoring::score;
use toml::{Table, Value};

use super::relative_path;
use super::scene::{self, Scene, SceneError};

/// One capture: a face in a light, in a variant of the scene.
#[derive(Clone, Debug)]
pub struct Case {
    /// `<face>-<light>[-<variant>][-seed<seed>]`.
    pub id: String,
    /// The variant's name; none in a suite without variants.
    pub variant: Option<String>,
    /// The renderer's seed, of a suite that has several.
    pub seed: Option<u64>,
    /// The scene to render; of photographs the names alone.
    pub scene: Scene,
    /// The capture's folder, if it was photographed and not rendered.
    pub photographed: Option<PathBuf>,
}

impl Case {
    /// Writes its scene into a folder, as `<case>.toml`, and returns the file.
    pub(super) fn write_scene(&self, folder: &Path) -> io::Result<PathBuf> {
        fs::create_dir_all(folder)?;
        let file = folder.join(format!("{}.toml", self.id));
        let text = self.scene.to_toml().map_err(io::Error::other)?;
        atomic::write_file(&file, text.as_bytes())?;
        Ok(file)
    }
}

/// The tables of a scene that a variant may change.
const VARIED: [&str; 7] =
    ["captured_mesh", "face", "image_formation", "labels", "light", "render", "rig"];

/// Those of them that have a name, which is the case's and stays.
const NAMED: [&str; 3] = ["face", "light", "rig"];

/// A `[[variant]]`: what is laid over the scene.
struct Variant {
    name: String,
    changes: Table,
    /// Tables of which nothing but the name stays: those that the variant takes from a file.
    replaced: Vec<&'static str>,
}

impl Variant {
    fn read(path: &Path, value: &Value) -> Result<Self, SceneError> {
        let Value::Table(table) = value else {
            return Err(SceneError::value(path, "variant", "must be tables; write [[variant]]"));
        };
        let mut changes = table.clone();
        let Some(Value::String(name)) = changes.remove("name") else {
            let reason = "has no name; write name = \"coarse mesh\"";
            return Err(SceneError::value(path, "variant", reason));
        };
        let key = format!("variant {name:?}");
        if let Some(unknown) = changes.keys().find(|key| !VARIED.contains(&key.as_str())) {
            let reason = format!("{unknown} is unknown; there are name, {}", VARIED.join(", "));
            return Err(SceneError::value(path, &key, reason));
        }
        let mut replaced = Vec::new();
        for section in NAMED {
            if let Some(file @ Value::String(_)) = changes.get(section) {
                let mut table = scene::resolve(path, section, file.clone())?;
                table.remove("name");
                changes.insert(section.to_owned(), Value::Table(table));
                replaced.push(section);
            }
        }
        if let Some((name, _)) = changes.iter().find(|(_, value)| !value.is_table()) {
            let file = if NAMED.contains(&name.as_str()) { " or a file's name" } else { "" };
            let reason = format!("{name} must be a table{file}; write [variant.{name}]");
            return Err(SceneError::value(path, &key, reason));
        }
        for section in NAMED {
            let Some(Value::Table(table)) = changes.get_mut(section) else { continue };
            if table.contains_key("name") {
                let reason = format!("[variant.{section}] changes one and cannot name another");
                return Err(SceneError::value(path, &key, reason));
            }
            scene::resolve_files(path, table);
        }
        Ok(Self { name, changes, replaced })
    }

    /// The scene with what the variant changes.
    fn over(&self, mut scene: Scene) -> Scene {
        for section in &self.replaced {
            let name = Value::String(scene.name_of(section).to_owned());
            let bare = Table::from_iter([("name".to_owned(), name)]);
            scene.table.insert((*section).to_owned(), Value::Table(bare));
        }
        scene.with_changes(&self.changes)
    }

    /// The name in ids of cases.
    fn id(&self) -> String {
        self.name.replace(' ', "-")
    }
}

/// Every face in every light in every variant; without faces or lights the scene's own.
pub(super) fn cases_of(path: &Path, base: &Scene, suite: &Table) -> Result<Vec<Case>, SceneError> {
    let section = |name: &str| base.table.get(name).and_then(Value::as_table).cloned();
    let or_own = |listed: Vec<Table>, own: &str| {
        if listed.is_empty() { section(own).into_iter().collect() } else { listed }
    };
    let mut faces = or_own(referenced(path, suite, "faces")?, "face");
    if let Some(changes) = suite.get("face") {
        let changes = face_changes(path, changes)?;
        faces.iter_mut().for_each(|face| scene::overlay(face, &changes));
    }
    let lights = or_own(referenced(path, suite, "lights")?, "light");
    let others: Vec<Table> = lights.iter().cloned().chain(base.relight()).collect();
    let variants = variants_of(path, suite)?;
    let seeds = seeds_of(path, suite)?;
    let mut cases: Vec<Case> = Vec::new();
    for face in &faces {
        for light in &lights {
            let scene = base.clone().with_face(face.clone()).with_lights(light, &others);
            for (variant, seed) in variants.iter().flat_map(|v| seeds.iter().map(move |s| (v, *s)))
            {
                let case = case(path, scene.clone(), variant.as_ref(), seed)?;
                if cases.iter().any(|other| other.id == case.id) {
                    let reason = format!("{} occurs twice; rename one", case.id);
                    let key = if variant.is_some() { "faces, lights, variant" } else { "faces" };
                    return Err(SceneError::value(path, key, reason));
                }
                cases.push(case);
            }
        }
    }
    Ok(cases)
}

/// The `[face]` table of a suite, laid over every face; a name would make one of all.
fn face_changes(path: &Path, value: &Value) -> Result<Table, SceneError> {
    match value {
        Value::Table(table) if !table.contains_key("name") => {
            let mut changes = table.clone();
            scene::resolve_files(path, &mut changes);
            Ok(changes)
        }
        Value::Table(_) => {
            let reason = "is laid over every face and cannot name one; list faces = [...]";
            Err(SceneError::value(path, "face", reason))
        }
        _ => Err(SceneError::value(path, "face", "must be a table; write [face]")),
    }
}

fn case(
    path: &Path,
    mut scene: Scene,
    variant: Option<&Variant>,
    seed: Option<u64>,
) -> Result<Case, SceneError> {
    let mut id = format!("{}-{}", scene.name_of("face"), scene.name_of("light"));
    if let Some(variant) = variant {
        id = format!("{id}-{}", variant.id());
        scene = variant.over(scene);
    }
    if let Some(seed) = seed {
        id = format!("{id}-seed{seed}");
        let render = Table::from_iter([("seed".to_owned(), Value::Integer(seed.cast_signed()))]);
        scene =
            scene.with_changes(&Table::from_iter([("render".to_owned(), Value::Table(render))]));
    }
    scene::check_id(path, &id)?;
    scene.table.insert("name".to_owned(), Value::String(id.clone()));
    let variant = variant.map(|variant| variant.name.clone());
    Ok(Case { id, variant, seed, scene, photographed: None })
}

/// The captures of the file's list, folders beside it, each a case of its folder's name.
pub(super) fn photographed(path: &Path, suite: &Table) -> Result<Vec<Case>, SceneError> {
    let Some(listed) = suite.get("captures") else { return Ok(Vec::new()) };
    let wrong = |reason: String| SceneError::value(path, "captures", reason);
    let names: Option<Vec<&str>> =
        listed.as_array().and_then(|list| list.iter().map(Value::as_str).collect());
    let names = names.filter(|names| !names.is_empty());
    let names = names.ok_or_else(|| wrong("must be a list of captures' folders".to_owned()))?;
    let mut cases: Vec<Case> = Vec::new();
    for name in names {
        let folder = relative_path::beside(path, name);
        let folder = std::path::absolute(&folder).unwrap_or(folder);
        if !score::is_photographed(&folder) {
            let reason =
                format!("{name} is not a capture without a truth; import one, or name a scene");
            return Err(wrong(reason));
        }
        if !has_withheld_pictures(&folder) {
            let reason = format!(
                "{name} has no pictures of its withheld views, as captures of a sealed round, so nothing can be scored \
                 here; write its maps with `unshade solve` or your method, and hand them in as a submission"
            );
            return Err(wrong(reason));
        }
        // `.` and `..` have no name, the folder that they lead to has.
        let named = match folder.file_name() {
            Some(_) => folder.clone(),
            None => folder.canonicalize().unwrap_or_else(|_| folder.clone()),
        };
        let id = named.file_name().unwrap_or_default().to_string_lossy().into_owned();
        scene::check_id(path, &id)?;
        if cases.iter().any(|other| other.id == id) {
            return Err(wrong(format!("{id} occurs twice; rename one folder")));
        }
        let scene = Scene::named(&id, score::FOUND_LIGHT);
        cases.push(Case { id, variant: None, seed: None, scene, photographed: Some(folder) });
    }
    Ok(cases)
}

/// Whether the pictures are there that a capture names as withheld.
fn has_withheld_pictures(capture: &Path) -> bool {
    let text = std::fs::read(capture.join("transforms.json")).unwrap_or_default();
    let transforms: serde_json::Value = serde_json::from_slice(&text).unwrap_or_default();
    let withheld = transforms["test_filenames"].as_array().into_iter().flatten();
    withheld.filter_map(serde_json::Value::as_str).all(|file| capture.join(file).is_file())
}

/// The renderer's seeds, each of which every case is rendered with; a single none where the file
/// has none.
fn seeds_of(path: &Path, suite: &Table) -> Result<Vec<Option<u64>>, SceneError> {
    let Some(listed) = suite.get("seeds") else { return Ok(vec![None]) };
    let seeds = seeds(listed).ok_or_else(|| {
        SceneError::value(path, "seeds", "must be a list of whole numbers from 0, each once")
    })?;
    Ok(seeds.into_iter().map(Some).collect())
}

/// A list of seeds, each once.
pub(super) fn seeds(listed: &Value) -> Option<Vec<u64>> {
    let seeds: Option<Vec<u64>> = listed
        .as_array()?
        .iter()
        .map(|seed| seed.as_integer().and_then(|seed| u64::try_from(seed).ok()))
        .collect();
    let distinct = |seeds: &Vec<u64>| {
        !seeds.is_empty() && seeds.iter().collect::<BTreeSet<_>>().len() == seeds.len()
    };
    seeds.filter(distinct)
}

/// The variants of the file; a single none where it has none.
fn variants_of(path: &Path, suite: &Table) -> Result<Vec<Option<Variant>>, SceneError> {
    match suite.get("variant") {
        None => Ok(vec![None]),
        Some(Value::Array(list)) if !list.is_empty() => {
            list.iter().map(|value| Variant::read(path, value).map(Some)).collect()
        }
        Some(_) => Err(SceneError::value(path, "variant", "must be tables; write [[variant]]")),
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
