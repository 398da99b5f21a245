"""The files of the Rust crates import one another in one direction, and a circle is seen."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from import_circles import ROOT, Module, circle, crates

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

CRATES = crates(ROOT)

# What a crate may know of the others, at most. Scoring in particular needs no solver, and so no GPU's compiler.
WALLS = {
    "formats": set(),
    "capture": {"formats"},
    "scoring": {"formats", "capture"},
    "view": {"formats", "capture", "scoring"},
    "report": {"formats", "capture", "scoring", "view"},
    "sealing": {"formats"},
    "solver": {"formats", "capture"},
    "bench": {"formats", "capture", "solver"},
}


def made(root: Path, files: dict[str, str]) -> list[str]:
    """The circle in a crate of these files, by their names below `src`."""
    (root / "Cargo.toml").write_text('[workspace]\nmembers = ["one"]\n')
    for name, text in files.items():
        path = root / "one" / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    [crate] = crates(root)
    return [Path(file).relative_to(root / "one" / "src").as_posix() for file in circle(crate)]


@pytest.mark.parametrize("crate", CRATES, ids=lambda crate: crate.file.parent.parent.name)
def test_no_circle(crate: Module) -> None:
    assert circle(crate) == []


def dependencies() -> dict[str, set[str]]:
    """Of each crate of the workspace, the crates that it is built with, its tests too."""
    manifests = [tomllib.loads((crate.file.parents[1] / "Cargo.toml").read_text()) for crate in CRATES]
    tables = ("dependencies", "dev-dependencies", "build-dependencies")
    return {
        manifest["package"]["name"]: {name for table in tables for name in manifest.get(table, {})}
        for manifest in manifests
    }


@pytest.mark.parametrize("name", WALLS)
def test_a_crate_knows_no_more_than_it_may(name: str) -> None:
    known = dependencies()
    assert {other for other in known[name] if other in known} <= WALLS[name]
    assert "wgpu" not in known[name] or name == "solver"


def test_every_crate_is_read_whole() -> None:
    for crate in CRATES:
        files = {module.file for module in crate.walk()}
        tests = {"tests.rs", "testing.rs", "test_scene.rs", "sample_run.rs", "main.rs"}
        left = [
            file
            for file in crate.file.parent.rglob("*.rs")
            if file not in files and file.name not in tests and "tests" not in file.parts
        ]
        assert left == []


def test_a_planted_circle_is_named(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "solver" / "formats" / "src", tmp_path / "formats" / "src")
    (tmp_path / "Cargo.toml").write_text('[workspace]\nmembers = [\n    "formats",\n]\n')
    [crate] = crates(tmp_path)
    assert circle(crate) == []
    # The pictures are read by the maps; now they know them.
    write = tmp_path / "formats" / "src" / "picture" / "write.rs"
    write.write_text(write.read_text() + "\nfn planted() -> Option<crate::Maps> {\n    None\n}\n")
    [crate] = crates(tmp_path)
    found = [Path(file).name for file in circle(crate)]
    assert {"write.rs", "maps.rs"} <= set(found) and found[0] == found[-1]


CIRCLES = {
    "two files": {
        "lib.rs": "mod a; mod b;",
        "a.rs": "use crate::b::B; pub struct A(B);",
        "b.rs": "pub struct B(super::a::A);",
    },
    "through a re-export": {
        "lib.rs": "pub mod a; pub use a::Inner;",
        "a/mod.rs": "mod inner; mod outer; pub use inner::{Inner as Renamed, Inner}; pub use outer::Outer;",
        "a/inner.rs": "use super::Outer; pub struct Inner(Outer);",
        "a/outer.rs": "pub struct Outer(Option<Box<crate::Inner>>);",
    },
    "a mod.rs with items": {
        "lib.rs": "mod a;",
        "a/mod.rs": "mod part; pub struct Whole(part::Part);",
        "a/part.rs": "pub struct Part(Vec<super::Whole>);",
    },
    "a module by its name": {
        "lib.rs": "mod a; mod b;",
        "a.rs": "use crate::b; pub fn a() { b::b() }",
        "b.rs": "pub fn b() { crate::a::a() }",
    },
    "nested braces": {
        "lib.rs": "mod a; mod b;",
        "a.rs": "use crate::{\n    b::{self, B},\n};\npub struct A(B);",
        "b.rs": "use super::a::A; pub struct B(Vec<A>);",
    },
}

STRAIGHT = {
    "declares and re-exports alone": {
        "lib.rs": "mod a;",
        "a/mod.rs": "mod error; mod part; pub use error::Error; pub use part::Part;",
        "a/error.rs": "pub struct Error;",
        "a/part.rs": "use super::Error; pub struct Part(Error);",
    },
    "tests import what they like": {
        "lib.rs": "mod a; mod b;",
        "a.rs": "use crate::b::B; pub struct A(B);",
        "b.rs": "pub struct B;\n#[cfg(test)]\nmod tests {\n    use crate::a::A;\n    fn f(_: A) { if true {} }\n}\n",
    },
    "comments and texts": {
        "lib.rs": "mod a; mod b;",
        "a.rs": "use crate::b::B; pub struct A(B);",
        "b.rs": '//! See [`crate::a::A`].\npub struct B; pub const C: (&str, char) = ("use crate::a::A;", \'"\');',
    },
}


@pytest.mark.parametrize("name", CIRCLES)
def test_circles_are_seen(name: str, tmp_path: Path) -> None:
    assert len(set(made(tmp_path, CIRCLES[name]))) == 2


@pytest.mark.parametrize("name", STRAIGHT)
def test_what_is_no_circle(name: str, tmp_path: Path) -> None:
    assert made(tmp_path, STRAIGHT[name]) == []
