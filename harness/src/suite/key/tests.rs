//! Which stages run after an edit. Keys, records and earlier results are real; outputs are made up.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use formats::atomic::{self, Folder};
use tempfile::TempDir;

use super::super::clean::clean;
use super::super::earlier::Bound;
use super::super::executor::{Contents, StageExecutor};
use super::super::file::Suite;
use super::super::method::MethodKind;
use super::super::plan::{Stage, StageKind, plan};
use super::super::preflight;
use super::super::record::Records;
use super::super::sources::Sources;
use super::*;
use crate::synth::{Fingerprints, Interpreter, Interrupt, Tools};

const SCENE: &str = r#"
format = 1
name = "scene"
face = { name = "ada", seed = 3 }
light = { name = "key", kind = "studio" }
relight = [{ name = "even", kind = "uniform" }]
rig = { name = "few", kind = "phone", train = 1, test = 1 }
[render]
width = 8
height = 8
samples = 4
"#;

const SUITE: &str = r#"
format = 1
name = "edits"
scene = "scene.toml"
[[method]]
name = "mine"
python = "mine:solve"
environment = { PYTHONPATH = "on_path", LEVEL = "1" }
inputs = ["weights.bin"]
[[method]]
name = "tool"
command = ["bin/tool.sh", "{capture}", "{maps}", "tool.cfg"]
[[method]]
name = "fast"
backend = "cpu"
[[method]]
name = "mean_texture"
[[method]]
name = "flash-only"
set = { samples = 16 }
[[method]]
name = "label-means"
[[method]]
name = "oracle"
"#;

/// A suite with programs, their interpreter and its packages, and a run of it.
struct Place {
    root: TempDir,
    renderer: Fingerprints,
    sources: Sources,
}

impl Place {
    fn new() -> Self {
        let stages = [
            "capture",
            "lights",
            "mitsuba",
            "cycles",
            "photographed",
            "lpips",
            "python",
            "flash-only",
        ];
        let renderer = Fingerprints(stages.map(|name| (name.to_owned(), "1".to_owned())).into());
        let place = Self { root: tempfile::tempdir().unwrap(), renderer, sources: Sources::BUILT };
        for (name, text) in [
            ("suite/suite.toml", SUITE),
            ("suite/scene.toml", SCENE),
            (
                "suite/mine.py",
                "import installed, linked, on_path, shade\ndef solve(capture): ...\n",
            ),
            ("suite/shade.py", "x = 1\n"),
            ("suite/unused.py", "x = 1\n"),
            ("suite/weights.bin", "1"),
            ("suite/on_path/on_path.py", "import also_on_path\n"),
            ("suite/on_path/also_on_path.py", "x = 1\n"),
            ("suite/bin/tool.sh", "#!/bin/sh\n"),
            ("suite/tool.cfg", "1"),
            ("elsewhere/linked/__init__.py", "from . import deep\n"),
            ("elsewhere/linked/deep.py", "x = 1\n"),
            ("elsewhere/linked/table.json", "1"),
        ] {
            place.write(name, text);
        }
        let made = Command::new("python3")
            .args(["-m", "venv", "--without-pip"])
            .arg(place.path("venv"))
            .status();
        assert!(made.unwrap().success());
        let libraries =
            fs::read_dir(place.path("venv/lib")).unwrap().next().unwrap().unwrap().path();
        let packages = libraries.join("site-packages");
        fs::write(packages.join("linked.pth"), place.path("elsewhere").display().to_string())
            .unwrap();
        fs::create_dir(packages.join("installed")).unwrap();
        fs::write(packages.join("installed/__init__.py"), "x = 1\n").unwrap();
        atomic::claim(&place.path("run")).unwrap();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// Runs the suite; the stages that were not valid, as `maps: fast mine; relit: fast`.
    fn run(&self, redo: &[&str]) -> Result<String, RunError> {
        let suite = Suite::open(&self.path("suite/suite.toml")).unwrap();
        let interpreter = Interpreter::at(&self.path("venv/bin/python"));
        let tools = Tools { interpreter, interrupt: Interrupt::default() };
        let methods = preflight::methods(&suite, &tools).unwrap();
        let redo: Vec<String> = redo.iter().map(|name| (*name).to_owned()).collect();
        let out = self.path("run");
        let mut executor =
            StageExecutor::new(&suite, &out, &tools, &self.renderer, &methods, &redo);
        executor.sources = self.sources;
        let records = Records::open(&out)?;
        let mut contents = Contents::new();
        let mut ran: BTreeMap<StageKind, Vec<&str>> = BTreeMap::new();
        for stage in plan(&suite) {
            let key = executor.key(&stage, &contents)?.hash;
            let make = |path: &Path| make(&executor, &stage, path, &key).map(|()| None);
            let done = executor.run_by(&stage, &contents, &records, make)?;
            if !done.kept {
                let method = stage.method.map(|method| &*suite.methods[method].id);
                ran.entry(stage.kind).or_default().extend(method);
            }
            contents.insert(stage.id.clone(), done.record.output);
        }
        let lines = ran.into_iter().map(|(kind, methods)| match methods.len() {
            0 => kind.name().to_owned(),
            all if all == suite.methods.len() => format!("{}: all", kind.name()),
            _ => format!("{}: {}", kind.name(), methods.join(" ")),
        });
        Ok(lines.collect::<Vec<_>>().join("; "))
    }
}

/// Leaves what a stage would: a capture that follows from its scene, true maps, or what follows from the key.
fn make(executor: &StageExecutor, stage: &Stage, path: &Path, key: &str) -> Result<(), RunError> {
    let scene = &executor.suite.cases[stage.case].scene;
    if stage.kind == StageKind::Scores {
        return Ok(fs::write(path, key)?);
    }
    let folder = Folder::begin(path)?;
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    };
    match (stage.kind, executor.method(stage).map(|found| &found.method.kind)) {
        (StageKind::Capture, _) => {
            let own = scene.clone().without_relight().to_toml().unwrap();
            let cameras = r#"{"mesh": "mesh.obj", "train_filenames": ["images/0.exr"],
                "frames": [{"file_path": "images/0.exr"}, {"file_path": "images/1.exr"}]}"#;
            write("transforms.json", cameras);
            write("mesh.obj", "v 0 0 0");
            write("images/0.exr", &own);
            write("images/1.exr", &own);
            write("truth/diffuse_albedo.exr", &scene.table["face"].to_string());
            for light in scene.relight() {
                write(&format!("truth/relit/{}/1.exr", light["name"]), &own);
            }
        }
        (StageKind::Maps, Some(MethodKind::Oracle)) => {
            write("diffuse_albedo.exr", &scene.table["face"].to_string());
        }
        _ => write("diffuse_albedo.exr", key),
    }
    Ok(folder.commit()?)
}

const ALL: &str = "maps: all; relit: all; scores: all";
const MINE: &str = "maps: mine; relit: mine; scores: mine";
const NAME: &str = "name = \"edits\"";
/// Maps of methods that do not copy the truth.
const MADE: &str = "maps: tool fast mean_texture flash-only label-means";
const PICTURES: &str = "relit: all; scores: all";

fn only(methods: &str) -> String {
    format!("maps: {methods}; relit: {methods}; scores: {methods}")
}

/// Applies each edit to the place as it was before the one above it, and runs once.
fn run_edits(place: &Place, edits: &[(&str, &str, &str, &str)]) {
    for (file, old, new, runs) in edits {
        let path = place.path(file);
        let before = fs::read_to_string(&path).unwrap();
        assert!(before.contains(old), "{file} has no {old}");
        fs::write(&path, before.replacen(old, new, 1)).unwrap();
        assert_eq!(place.run(&[]).unwrap(), *runs, "{file}: {old} -> {new}");
        fs::write(&path, before).unwrap();
    }
}

#[test]
fn an_edit_runs_the_stages_that_read_it_and_undoing_it_runs_none() {
    let mut place = Place::new();
    assert_eq!(place.run(&[]).unwrap(), format!("capture; {ALL}"));
    let libraries = fs::read_dir(place.path("venv/lib")).unwrap().next().unwrap().unwrap();
    let installed = format!(
        "venv/lib/{}/site-packages/installed/__init__.py",
        libraries.file_name().to_string_lossy()
    );
    run_edits(
        &place,
        &[
            ("suite/mine.py", "...", "pass", MINE),
            ("suite/shade.py", "1", "2", MINE),
            ("suite/unused.py", "1", "2", ""),
            ("suite/on_path/on_path.py", "\n", "\n\n", MINE),
            ("suite/on_path/also_on_path.py", "1", "2", MINE),
            ("elsewhere/linked/deep.py", "1", "2", MINE),
            ("elsewhere/linked/table.json", "1", "2", MINE),
            (&installed, "1", "2", MINE),
            ("suite/weights.bin", "1", "2", MINE),
            ("suite/suite.toml", "LEVEL = \"1\"", "LEVEL = \"2\"", MINE),
        ],
    );
    // Its maps come out the same.
    assert_eq!(place.run(&["mine"]).unwrap(), "maps: mine");

    // Without the function, for which Python is started each time.
    let (head, mine) = SUITE.split_once("[[method]]").unwrap();
    let (_, others) = mine.split_once("[[method]]").unwrap();
    place.write("suite/suite.toml", &format!("{head}[[method]]{others}"));
    run_edits(
        &place,
        &[
            (
                "suite/scene.toml",
                "samples = 4",
                "samples = 5",
                &format!("capture; {MADE}; {PICTURES}"),
            ),
            ("suite/scene.toml", "seed = 3", "seed = 3, freckles = 1", &format!("capture; {ALL}")),
            (
                "suite/scene.toml",
                "relight = [",
                "relight = [{ name = \"noon\", kind = \"sun\" }, ",
                &format!("capture; {PICTURES}"),
            ),
            ("suite/bin/tool.sh", "\n", "\n\n", &only("tool")),
            ("suite/tool.cfg", "1", "2", &only("tool")),
            ("suite/suite.toml", "tool.cfg", "--quick", &only("tool")),
            ("suite/suite.toml", "\"cpu\"", "\"cpu\"\nset = { seed = 9 }", &only("fast")),
            ("suite/suite.toml", "samples = 16", "samples = 17", &only("flash-only")),
            ("suite/suite.toml", NAME, &format!("{NAME}\nscales = [\"none\"]"), PICTURES),
            ("suite/suite.toml", NAME, &format!("{NAME}\nrelight = \"cycles\""), PICTURES),
            ("suite/suite.toml", NAME, &format!("{NAME}\nlpips = \"alex\""), "scores: all"),
            ("suite/suite.toml", NAME, &format!("# A comment.\n{NAME}\ntitle = \"Edits\""), ""),
            ("suite/suite.toml", "\"oracle\"", "\"oracle\"\ntitle = \"truth\"", ""),
        ],
    );
    // Code of the renderer, by its stages. A capture that comes out the same is the end of it.
    for (stage, runs) in [
        ("capture", "capture"),
        ("mitsuba", PICTURES),
        ("cycles", ""),
        ("photographed", ""),
        ("lpips", ""),
        ("flash-only", &only("flash-only")),
    ] {
        place.renderer.0.insert(stage.to_owned(), "2".to_owned());
        assert_eq!(place.run(&[]).unwrap(), runs, "{stage}");
        place.renderer.0.insert(stage.to_owned(), "1".to_owned());
    }
    let built = Sources::BUILT;
    for (sources, runs) in [
        (Sources { capture: "2", ..built }, String::new()),
        (Sources { solver: "2", ..built }, only("fast mean_texture")),
        (Sources { scores: "2", ..built }, format!("maps: label-means oracle; {PICTURES}")),
        (built, String::new()),
    ] {
        place.sources = sources;
        assert_eq!(place.run(&[]).unwrap(), runs);
    }
    // What was kept goes when that is asked for.
    let run = place.path("run");
    let part = |bound| {
        let parts = clean(&run, &[], bound).unwrap().parts;
        parts.into_iter().find(|part| part.name == "earlier").map(|part| (part.bytes, part.removed))
    };
    let (bytes, removed) = part(Bound::default()).unwrap();
    assert!(bytes > 0 && removed == 0);
    let (left, removed) = part(Bound { bytes: Some(bytes / 2), ..Bound::default() }).unwrap();
    assert!(left <= bytes / 2 && left > 0 && left + removed == bytes, "{left} {removed} {bytes}");
    assert_eq!(part(Bound { seconds: Some(3600.0), ..Bound::default() }), Some((left, 0)));
    assert_eq!(part(Bound { seconds: Some(0.0), ..Bound::default() }), Some((0, left)));
    assert_eq!(part(Bound::default()), None);
    // What somebody put into a folder is not moved away.
    place.write("run/maps/ada-key/tool/notes.txt", "mine");
    place.write("suite/tool.cfg", "3");
    let error = place.run(&[]).unwrap_err().to_string();
    assert!(error.contains("notes.txt"), "{error}");
}
