"""The fingerprint of each rendering stage: the code that it reaches, and the versions of the libraries that the code uses.

The code is that of all modules that a stage imports, in whatever function, without comments and docstrings.
``python -m unshade.fingerprint`` prints the fingerprints of all stages as one JSON object. An output is valid while
the fingerprint of its stage stays the same.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import hashlib
import importlib.metadata
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import unshade

from ._native import sources
from .cache_folder import cache_folder

_COMMON = ("render.llvm", "render.truth_scene", "scene_file")
"""Modules through which `stage` leads to each of the following."""

STAGES = {
    "capture": ("readers", "render.capture", *_COMMON),
    "lights": ("readers", "render.handed_lights", *_COMMON),
    "mitsuba": ("readers", "render.relight", *_COMMON),
    # Blender runs its part as a script.
    "cycles": ("readers", "cycles.relight", "cycles.blender_child", *_COMMON),
    "photographed": ("capture", "render.photographed", "render.llvm"),
    "lpips": ("readers", "perceptual"),
    "sh-lambert": ("capture", "methods.sh_lambert", *_COMMON),
    "path-traced": ("capture", "methods.path_traced", *_COMMON),
    "binary-patterns": ("capture", "methods.binary_patterns", "methods.laboratory", *_COMMON),
    "flash-only": ("capture", "methods.flash_only", "methods.laboratory", *_COMMON),
    "light-stage": ("capture", "methods.light_stage", "methods.laboratory", *_COMMON),
    # A function of a suite may call all that the package has.
    "python": ("all", "plugin", *sorted(set(unshade._HOMES.values()) - {"_native"}), "metrics"),
}
"""Stages as keys of results name them: the compiled sources that they use, and the modules where their work begins."""

_DISTRIBUTIONS = {"PIL": "pillow", "cv2": "opencv-python-headless", "igl": "libigl", "mitsuba_oidn": "mitsuba-oidn"}
_UNNAMED = {"mitsuba": ("drjit", "karellen-llvm-core", "anny")}
"""Distributions that are used beside one that is imported, and are never imported."""

_Imports = list[tuple[str, str]]
"""Module and attribute, both absolute."""


@functools.cache  # sources that change later are not those at work here
def fingerprint(*modules: str, native: str = "readers") -> str:
    """Versions of the libraries and hash of the code that ``modules`` of the package reach; ``native`` names the
    compiled sources. Raises `ModuleNotFoundError` for a module that is not there.
    """
    code = _Code.shared()
    found: dict[str, str] = {}
    libraries: set[str] = set()
    waiting = [name.removeprefix("unshade.") for name in modules]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found[name], reached, used = code.of(name)
        waiting += reached
        libraries |= used
    code.keep()
    digest = hashlib.blake2b(json.dumps(found, sort_keys=True).encode(), digest_size=16).hexdigest()
    libraries -= sys.stdlib_module_names
    names = {_DISTRIBUTIONS.get(library, library) for library in libraries}
    names.update(*(_UNNAMED.get(library, ()) for library in libraries))
    versions = " ".join(f"{name}={_version(name)}" for name in sorted(names))
    return f"{versions} sources={digest} {native}={sources[native]}"


def imports_of(module: str) -> list[str]:
    """The modules of the package that ``module`` imports, in whatever function, with the packages above them."""
    return _Code.shared().of(module)[1]


def _modules(module: str, attribute: str) -> Iterator[str]:
    """The modules that ``from module import attribute`` runs. Those of the package itself are loaded on first use."""
    if not module:
        module, attribute = unshade._HOMES.get(attribute, attribute), ""
    if not module or module == "_native":
        return
    parts = module.split(".")
    yield from (".".join(parts[: end + 1]) for end in range(len(parts)))
    if attribute and _file(f"{module}.{attribute}"):
        yield f"{module}.{attribute}"


def _file(name: str) -> Path | None:
    base = Path(unshade.__file__).parent.joinpath(*name.split("."))
    return next((path for path in (base / "__init__.py", base.with_suffix(".py")) if path.is_file()), None)


class _Code:
    """Hashes of modules without comments and docstrings. They are kept by the text's own hash, as parsing is slow."""

    def __init__(self) -> None:
        self._path = cache_folder() / f"code-{sys.implementation.cache_tag}.json"
        self._new = False
        self._known: dict[str, tuple[str, _Imports]] = {}
        self._read: dict[str, tuple[str, list[str], set[str]]] = {}
        with contextlib.suppress(OSError, ValueError):
            self._known = json.loads(self._path.read_text())

    @staticmethod
    @functools.cache
    def shared() -> _Code:
        """The instance of this process."""
        return _Code()

    def of(self, name: str) -> tuple[str, list[str], set[str]]:
        """Hash of the module ``name`` of the package, the modules that it imports from there, and the libraries."""
        if name not in self._read:
            digest, imports = self._of(name)
            names = [(*module.partition("."), attribute) for module, attribute in imports]
            ours = {of for top, _, rest, attribute in names if top == "unshade" for of in _modules(rest, attribute)}
            self._read[name] = digest, sorted(ours), {top for top, *_ in names if top != "unshade"}
        return self._read[name]

    def _of(self, name: str) -> tuple[str, _Imports]:
        path = _file(name)
        if path is None:
            raise ModuleNotFoundError(f"there is no module unshade.{name}")
        package = ["unshade", *name.split(".")]
        if path.name != "__init__.py":
            package.pop()
        text = path.read_bytes()
        key = hashlib.blake2b(".".join(package).encode() + b"\1" + text, digest_size=16).hexdigest()
        if key not in self._known:
            self._new = True
            tree = _Running().visit(ast.parse(text, path))
            imports = list(_imports(tree, package))
            for node in ast.walk(tree):
                if isinstance(body := getattr(node, "body", None), list):
                    body[:] = [line for line in body if not _is_text(line)]
            self._known[key] = hashlib.blake2b(ast.dump(tree).encode(), digest_size=16).hexdigest(), imports
        return self._known[key]

    def keep(self) -> None:
        """Writes what is new; a folder that cannot be written costs time only."""
        if self._new:
            partial = self._path.with_name(f"{self._path.name}.{os.getpid()}.partial")
            with contextlib.suppress(OSError):
                self._path.parent.mkdir(parents=True, exist_ok=True)
                partial.write_text(json.dumps(self._known))
                partial.replace(self._path)
            self._new = False


class _Running(ast.NodeTransformer):
    """Leaves out what only type checkers read."""

    def visit_If(self, node: ast.If) -> ast.AST | list[ast.stmt]:
        self.generic_visit(node)
        return node.orelse if isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING" else node


def _is_text(line: ast.stmt) -> bool:
    return isinstance(line, ast.Expr) and isinstance(line.value, ast.Constant) and isinstance(line.value.value, str)


def _imports(tree: ast.Module, package: list[str]) -> Iterator[tuple[str, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*above, *filter(None, [node.module])])
            yield from ((module, alias.name) for alias in node.names)


@functools.cache
def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "none"


if __name__ == "__main__":
    prints = {stage: fingerprint(*modules, native=native) for stage, (native, *modules) in STAGES.items()}
    print(json.dumps(prints))
