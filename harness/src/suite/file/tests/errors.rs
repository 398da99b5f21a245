//! Errors of a suite's file.

use super::*;

#[test]
fn errors_name_the_file_the_key_and_the_fix() {
    let root = tempfile::tempdir().unwrap();
    scenes(root.path());
    let head = "format = 1\nname = \"m\"\nscene = \"scene.toml\"\n";
    for (text, expected) in [
        ("name = \"m\"\n", "format: is missing; write format = 1"),
        (&*format!("{head}solvers = 1\n"), "solvers: is unknown; there are"),
        (head, "method: is missing; write [[method]] tables"),
        (
            &*format!("{head}solver = []\n"),
            "suite.toml:4: solver: has been renamed; write [[method]] tables",
        ),
        (&*format!("{head}[[method]]\nname = \"a b\"\n"), "cannot name a folder"),
        (
            &*format!("{head}[[method]]\nname = \"a\"\nthread = 2\n"),
            "suite.toml:5: method: unknown field `thread`",
        ),
        (&*format!("{head}[[method]]\nname = \"a\"\n"), "no configuration is named \"a\""),
        (
            &*format!("{head}[[method]]\nname = \"fast\"\n[method.set]\nseed = \"x\"\n"),
            "suite.toml:5: name: configuration: ",
        ),
        (
            &*format!("{head}[[method]]\nname = \"a\"\ncommand = \"x\"\ntimeout_s = -1\n"),
            "suite.toml:7: timeout_s: must be seconds above 0",
        ),
        (
            &*format!("{head}[[method]]\nname = \"oracle\"\nversion = \"2\"\n"),
            "does not support version; remove it",
        ),
        (
            &*format!("{head}[[method]]\nname = \"label-means\"\ntexture_size = 512\n"),
            "\"label-means\" does not support texture_size; remove it",
        ),
        ("format = 1\nname = \n", "suite.toml:2: is not valid TOML"),
        (
            &*format!("{head}faces = [\"no.toml\"]\n[[method]]\nname = \"a\"\n"),
            "no.toml: cannot be read",
        ),
        ("format = 1\nname = \"m\"\nscene = \"no\\nsuch.toml\"\n", "no such.toml: cannot be read"),
        (
            &*format!("{head}[[method]]\nname = \"mean_texture\"\nconfig = \"fast\"\n"),
            "\"mean_texture\" does not support config; remove it",
        ),
        (
            &*format!("{head}[[method]]\nname = \"paper\"\ntexture_size = 512\n"),
            "does not support texture_size; write [method.set.maps] texture_size, or [method.set.fine_tuning] texture_size for `paper`",
        ),
        (
            &*format!("{head}[[method]]\nname = \"mean_texture\"\ntexture_size = 4\n"),
            "texture_size: 4 of \"mean_texture\" is not from 16 to 8192",
        ),
        (
            &*format!("{head}[[method]]\nname = \"paper\"\nbackend = \"tpu\"\n"),
            "backend: no backend is named \"tpu\"; there are auto, cpu and gpu",
        ),
        (&*format!("{head}[face]\nname = \"a\"\n"), "face: is laid over every face"),
        (&*format!("{head}[variant]\nname = \"a\"\n"), "variant: must be tables"),
        (
            &*format!(
                "{head}[[variant]]\nname = \"a\"\n[variant.rig]\nname = \"b\"\n[[method]]\nname = \"fast\"\n"
            ),
            "[variant.rig] changes one and cannot name another",
        ),
        (&*format!("{head}[[variant]]\nlabels = {{}}\n"), "variant: has no name; write"),
        (
            &*format!("{head}[[variant]]\nname = \"a\"\nmesh = {{}}\n"),
            "variant \"a\": mesh is unknown; there are name, captured_mesh",
        ),
        (
            &*format!("{head}[[variant]]\nname = \"a\"\nlabels = 1\n"),
            "labels must be a table; write [variant.labels]",
        ),
        (
            &*format!("{head}[[variant]]\nname = \"a\"\nface = 1\n"),
            "face must be a table or a file's name; write [variant.face]",
        ),
        (&*format!("{head}[[variant]]\nname = \"a/b\"\n"), "cannot name a folder"),
        (
            &*format!("{head}[[variant]]\nname = \"a b\"\n[[variant]]\nname = \"a-b\"\n"),
            "ada-key-a-b occurs twice",
        ),
    ] {
        let path = write(root.path(), "suite.toml", text);
        let error = Suite::open(&path).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
}
