mod errors;

use super::super::baseline::BaselineMethod;
use super::super::method::{BaselineSettings, MethodKind};
use super::super::program::Start;
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
    write(folder, "lights/hall.toml", "name = \"hall\"\nkind = \"envmap\"\npath = \"hall.exr\"\n");
    write(
        folder,
        "scene.toml",
        "format = 1\nname = \"s\"\nface = \"face.toml\"\nlight = \"lights/key.toml\"\n\
         relight = [\"lights/hall.toml\"]\nrig = { name = \"r\", kind = \"phone\" }\n\
         [render]\nwidth = 8\nheight = 8\n",
    );
}

#[test]
fn what_relights_is_one_of_the_renderers() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let open = |line: &str| {
        let text = format!(
            "format = 1\nname = \"s\"\nscene = \"scene.toml\"\n{line}\n\
             [[method]]\nname = \"oracle\"\n"
        );
        Suite::open(&write(root.path(), "suite.toml", &text)).map(|suite| suite.relight)
    };
    assert_eq!(open("").unwrap(), "mitsuba");
    assert_eq!(open("relight = \"cycles\"").unwrap(), "cycles");
    let error = open("relight = \"arnold\"").unwrap_err().to_string();
    assert!(error.contains("must be one of mitsuba, cycles"), "{error}");
}

#[test]
fn a_variant_takes_another_face_from_a_file_and_keeps_the_name_of_the_case() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    write(root.path(), "heads/other.toml", "name = \"other\"\nmesh = \"other.obj\"\n");
    let text = "format = 1\nname = \"s\"\nscene = \"scene.toml\"\n[face]\ndetail = \"natural\"\n\
                [[variant]]\nname = \"matched\"\n\
                [[variant]]\nname = \"another\"\nface = \"heads/other.toml\"\n\
                [[method]]\nname = \"oracle\"\n";
    let suite = Suite::open(&write(root.path(), "suite.toml", text)).unwrap();
    let face = |case: usize| suite.cases[case].scene.table["face"].as_table().unwrap().clone();
    assert_eq!(face(0)["detail"].as_str(), Some("natural"));
    let mesh = root.path().join("heads/other.obj");
    assert_eq!(face(1)["mesh"].as_str().map(Path::new), Some(mesh.as_path()));
    assert_eq!(face(1)["name"].as_str(), Some("ada"));
    assert_eq!(face(1).len(), 2, "nothing of the other face stays");
    assert_eq!(suite.cases[1].id, "ada-key-another");
}

#[test]
fn seeds_make_cases_of_the_renderer_and_methods_of_our_solver() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let open = |seeds: &str, method: &str| {
        let text = format!(
            "format = 1\nname = \"s\"\nscene = \"scene.toml\"\n{seeds}\n[[method]]\n{method}\n"
        );
        Suite::open(&write(root.path(), "suite.toml", &text))
    };
    let suite = open("seeds = [0, 7]", "name = \"paper\"\nseeds = [1, 2]").unwrap();
    let cases = suite
        .cases
        .iter()
        .map(|case| (case.id.as_str(), case.seed, case.scene.table["render"]["seed"].as_integer()));
    let expected = [("ada-key-seed0", Some(0), Some(0)), ("ada-key-seed7", Some(7), Some(7))];
    assert_eq!(cases.collect::<Vec<_>>(), expected);
    for (method, seed) in suite.methods.iter().zip([1, 2]) {
        assert_eq!(method.id, format!("paper-seed{seed}"));
        assert_eq!(method.replicate, Some(("paper".to_owned(), seed)));
        let MethodKind::Solver(solver) = &method.kind else { panic!() };
        let config = solver.config.parse::<Table>().unwrap();
        assert_eq!(config["base"].as_str(), Some("paper"));
        assert_eq!(config["seed"].as_integer(), Some(seed.cast_signed()));
    }
    let plain = open("", "name = \"paper\"").unwrap();
    assert_eq!((plain.cases[0].id.as_str(), plain.cases[0].seed), ("ada-key", None));
    assert_eq!((plain.methods[0].id.as_str(), &plain.methods[0].replicate), ("paper", &None));
    for (seeds, method, words) in [
        ("seeds = [1, 1]", "name = \"paper\"", "each once"),
        ("seeds = 3", "name = \"paper\"", "each once"),
        ("", "name = \"paper\"\nseeds = [-1]", "each once"),
        ("", "name = \"oracle\"\nseeds = [1]", "does not support seeds"),
    ] {
        let error = open(seeds, method).unwrap_err().to_string();
        assert!(error.contains(words) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn a_sweep_makes_a_method_of_each_combination_and_seeds_one_of_each() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let open = |lines: &str| {
        let text = format!(
            "format = 1\nname = \"s\"\nauthor = \"Ada\"\nscene = \"scene.toml\"\n[[method]]\n{lines}\n"
        );
        Suite::open(&write(root.path(), "suite.toml", &text))
    };
    let mine = "name = \"mine\"\npython = \"mine:recover\"\nset = { layers = [1, 2] }\n";
    let suite = open(&format!("{mine}sweep = {{ lr = [0.1, 1e-3] }}\nseeds = [1, 2]")).unwrap();
    let ids: Vec<_> = suite.methods.iter().map(|method| method.id.as_str()).collect();
    assert_eq!(
        ids,
        ["mine-lr0_1-seed1", "mine-lr0_1-seed2", "mine-lr0_001-seed1", "mine-lr0_001-seed2"]
    );
    let last = &suite.methods[3];
    assert_eq!(last.title, "mine, lr = 0.001, seed 2");
    assert_eq!(last.replicate, Some(("mine-lr0_001".to_owned(), 2)));
    assert_eq!(last.author.as_deref(), Some("Ada"));
    let MethodKind::Program(program) = &last.kind else { panic!() };
    assert_eq!(program.settings_json(), r#"{"layers":[1,2],"lr":0.001,"seed":2}"#);
    assert_eq!(program.with_settings("--lr={lr} {seed} {maps}"), "--lr=0.001 2 {maps}");
    let runs = |name: &str| {
        let suite = suite.clone().only(vec![name.to_owned()], Vec::new()).unwrap();
        suite.methods.iter().filter(|method| suite.runs_method(method)).count()
    };
    assert_eq!((runs("mine"), runs("mine-lr0_1-seed2")), (4, 1));
    let near = suite.clone().only(vec!["mime".to_owned()], Vec::new()).unwrap_err().to_string();
    assert!(near.starts_with("--method: the suite has no method \"mime\"; did you mean \"mine\"?"));
    let near = suite.only(Vec::new(), vec!["ada-kee".to_owned()]).unwrap_err().to_string();
    assert!(
        near.starts_with("--case: the suite has no case \"ada-kee\"; did you mean \"ada-key\"?")
    );
    let ours = "name = \"fast\"\nsweep.maps.texture_size = [256, 512]";
    let ours = open(ours).unwrap().methods;
    let MethodKind::Solver(solver) = &ours[1].kind else { panic!() };
    let config = solver.config.parse::<Table>().unwrap();
    assert_eq!(ours[1].id, "fast-texture_size512");
    assert_eq!(config["maps"]["texture_size"].as_integer(), Some(512));
    for (lines, words) in [
        ("sweep = { lr = 0.1 }", "suite.toml:9: sweep: lr must be a list of values"),
        ("sweep = { layers = [1, 2] }", "sweep: set has layers too; remove one"),
        ("set.seed = 1\nseeds = [1]", "seeds: set has a seed too"),
        ("set.debug = 1", "debug is the name of a path"),
    ] {
        let mine = if lines.starts_with("set.") {
            mine.replace("set = { layers = [1, 2] }", "")
        } else {
            mine.to_owned()
        };
        let error = open(&format!("{mine}{lines}")).unwrap_err().to_string();
        assert!(error.contains(words) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn a_picture_of_surroundings_is_a_light_of_its_name() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let text =
        "format = 1\nname = \"s\"\nscene = \"scene.toml\"\nlights = [\"hdri/my room.HDR\"]\n";
    let path = write(root.path(), "suite.toml", text);
    let suite = Suite::open_for_captures(&path).unwrap();
    assert_eq!(suite.cases[0].id, "ada-my-room");
    let light = &suite.cases[0].scene.table["light"];
    assert_eq!(light["kind"].as_str(), Some("envmap"));
    let place = root.path().join("hdri/my room.HDR");
    assert_eq!(light["path"].as_str(), place.to_str());
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
         [[method]]\nname = \"paper\"\nset = { seed = 4 }\n\
         [[method]]\nname = \"mine\"\ncommand = \"run {capture} {maps}\"\n",
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
    let MethodKind::Solver(solver) = &suite.methods[0].kind else { panic!() };
    assert_eq!(solver.config.parse::<Table>().unwrap()["seed"].as_integer(), Some(4));
    let MethodKind::Program(program) = &suite.methods[1].kind else { panic!() };
    let words = ["run", "{capture}", "{maps}"].map(str::to_owned).to_vec();
    assert_eq!(program.start, Start::Command(words));
    assert_eq!(program.folder, root.path());
    // The resolved text stands alone: it parses back to the same scene.
    let text = suite.cases[0].scene.to_toml().unwrap();
    assert_eq!(text.parse::<Table>().unwrap(), suite.cases[0].scene.table);
}

#[test]
fn a_capture_in_lights_by_turns_is_a_case_that_no_other_is_relit_in() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let turns = "name = \"both\"\nkind = \"turns\"\nlights = [\"key.toml\", \"hall.toml\"]\n";
    write(root.path(), "lights/both.toml", turns);
    let path = write(
        root.path(),
        "suite.toml",
        "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n\
         lights = [\"lights/key.toml\", \"lights/both.toml\"]\n[[method]]\nname = \"oracle\"\n",
    );
    let suite = Suite::open(&path).unwrap();
    let ids: Vec<_> = suite.cases.iter().map(|case| case.id.as_str()).collect();
    assert_eq!(ids, ["ada-key", "ada-both"]);
    let relit = |case: usize| -> Vec<String> {
        let lights = suite.cases[case].scene.relight();
        lights.iter().map(|light| light["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(relit(0), ["hall"]);
    assert_eq!(relit(1), ["key", "hall"]);
    let scene = &suite.cases[1].scene;
    let hall = &scene.table["light"]["lights"][1];
    assert_eq!(hall["kind"].as_str(), Some("envmap"));
    let picture = root.path().join("lights/hall.exr");
    assert_eq!(hall["path"].as_str(), picture.to_str());
    assert_eq!(scene.files().iter().filter(|file| **file == picture).count(), 2);
    let text = scene.to_toml().unwrap();
    assert_eq!(text.parse::<Table>().unwrap(), scene.table);
}

#[test]
fn lights_by_turns_are_single_lights() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let turns = "name = \"both\"\nkind = \"turns\"\nlights = [\"key.toml\", \"both.toml\"]\n";
    write(root.path(), "lights/both.toml", turns);
    let text = "format = 1\nname = \"m\"\nscene = \"scene.toml\"\nlights = [\"lights/both.toml\"]\n\
                [[method]]\nname = \"oracle\"\n";
    let path = write(root.path(), "suite.toml", text);
    let message = Suite::open(&path).unwrap_err().to_string();
    assert!(message.contains("both.toml") && message.contains("name single lights"), "{message}");
}

#[test]
fn maps_are_relit_under_every_scale_unless_the_suite_names_some() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let open = |line: &str| {
        let text = format!(
            "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n{line}\n[[method]]\nname = \"oracle\"\n"
        );
        Suite::open(&write(root.path(), "suite.toml", &text)).map(|suite| suite.scales)
    };
    assert_eq!(open("").unwrap(), SCALES);
    assert_eq!(open("scales = [\"global\"]").unwrap(), ["global"]);
    for wrong in ["[]", "[\"channel\"]", "[\"none\", \"none\"]", "\"none\"", "[1]"] {
        let message = open(&format!("scales = {wrong}")).unwrap_err().to_string();
        assert!(message.contains("scales") && message.contains("none, global"), "{message}");
    }
}

#[test]
fn every_case_is_there_in_every_variant_and_a_variant_changes_only_what_it_names() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let path = write(
        root.path(),
        "suite.toml",
        "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n\
         lights = [\"lights/key.toml\", \"lights/hall.toml\"]\n\
         [[variant]]\nname = \"as captured\"\n\
         [[variant]]\nname = \"no labels\"\n[variant.labels]\nomit = true\n\
         [variant.render]\nwidth = 32\n[variant.light]\nexposure = 0.5\n[face]\ntexture_size = 1024\n\
         [[method]]\nname = \"semantic_initialisation\"\n",
    );
    let suite = Suite::open(&path).unwrap();
    let ids: Vec<_> = suite.cases.iter().map(|case| case.id.as_str()).collect();
    assert_eq!(
        ids,
        ["ada-key-as-captured", "ada-key-no-labels", "ada-hall-as-captured", "ada-hall-no-labels"]
    );
    let table = |case: usize| &suite.cases[case].scene.table;
    assert_eq!(suite.cases[1].variant.as_deref(), Some("no labels"));
    assert_eq!(table(3)["face"]["texture_size"].as_integer(), Some(1024));
    assert!(!table(0).contains_key("labels"));
    assert_eq!(table(1)["labels"]["omit"].as_bool(), Some(true));
    let size = |case: usize| {
        ["width", "height"].map(|key| table(case)["render"][key].as_integer().unwrap())
    };
    assert_eq!((size(0), size(1)), ([8, 8], [32, 8]));
    let exposed = |case: usize| table(case)["light"].get("exposure").and_then(Value::as_float);
    assert_eq!((exposed(0), exposed(1)), (None, Some(0.5)));
    // The text of a varied scene is one that can be read again.
    let text = suite.cases[3].scene.to_toml().unwrap();
    assert_eq!(&text.parse::<Table>().unwrap(), table(3));
    let baseline = BaselineMethod::SemanticInitialisation;
    assert_eq!(
        suite.methods[0].kind,
        MethodKind::Baseline(BaselineSettings { baseline, texture_size: 512 })
    );
    assert_eq!(suite.methods[0].role(), scoring::run::Kind::Baseline);
}

#[test]
fn a_competitor_is_named_with_its_settings_and_has_a_class() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let open = |lines: &str| {
        let text = format!("format = 1\nname = \"m\"\nscene = \"scene.toml\"\n[[method]]\n{lines}");
        Suite::open(&write(root.path(), "suite.toml", &text))
    };
    let suite = open(
        "name = \"sh-lambert\"\nset = { order = 3 }\n[[method]]\nname = \"light-stage\"\n\
         [[method]]\nname = \"oracle\"\n[[method]]\nname = \"paper-tuned\"\n",
    );
    let suite = suite.unwrap();
    let classes: Vec<_> = suite.methods.iter().map(|method| method.work().class().name()).collect();
    assert_eq!(classes, ["passive", "controlled", "privileged", "passive"]);
    let MethodKind::Competitor(found) = &suite.methods[0].kind else { panic!() };
    assert_eq!(found.settings, "{\"order\":3}");
    let wrong = open("name = \"sh-lambert\"\ntexture_size = 64\n").unwrap_err().to_string();
    assert!(wrong.contains("set = { texture_size"), "{wrong}");
    let renamed =
        open("name = \"order-3\"\nconfig = \"sh-lambert\"\nset = { order = 3 }\n").unwrap();
    assert_eq!(renamed.methods[0].kind, suite.methods[0].kind);
    let known =
        open("name = \"known\"\nconfig = \"fast\"\ngiven = [\"light\", \"normals\"]\n").unwrap();
    assert_eq!(known.methods[0].work().class().name(), "privileged");
    let wrong = open("name = \"fast\"\ngiven = [\"albedo\"]\n").unwrap_err().to_string();
    assert!(wrong.contains("given") && wrong.contains("normals"), "{wrong}");
    let wrong = open("name = \"oracle\"\ngiven = [\"light\"]\n").unwrap_err().to_string();
    assert!(wrong.contains("given"), "{wrong}");
    let wrong = open("name = \"oracle\"\nconfig = \"sh-lambert\"\n").unwrap_err().to_string();
    assert!(wrong.contains("config"), "{wrong}");
    // Under a configuration, it is our solver's name for once.
    let ours = open("name = \"sh-lambert\"\nconfig = \"fast\"\n").unwrap();
    assert!(matches!(ours.methods[0].kind, MethodKind::Solver(_)));
}

#[test]
fn every_suite_of_the_project_can_be_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/suites");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let suite = Suite::open(&path).unwrap();
        assert_eq!(path.file_stem().unwrap().to_str(), Some(suite.name.as_str()));
        for method in &suite.methods {
            if let MethodKind::Solver(solver) = &method.kind {
                solver::Config::from_toml(&solver.config).unwrap();
            }
        }
        count += suite.cases.len();
    }
    assert!(count > 16 + 16 + 16, "{count}");
}
