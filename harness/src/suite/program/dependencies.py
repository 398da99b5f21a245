"""What a Python program is made of, as one line of JSON; run by the program's own interpreter.

Arguments: FOLDER, then ``script PATH`` or ``module NAME[:FUNCTION]``. Found without running it: ``files`` are the
program's file and all that it imports from its folder, ``packages`` are folders of what it imports from elsewhere
(PYTHONPATH, a ``.pth`` file, an editable install). ``installed`` are files and folders of the interpreter and of all
that is installed for it, ``listed`` are folders in which it looks for modules. ``arguments`` are the names that the
function takes beside the capture, null where its text does not tell; ``error`` says why it cannot run.
"""

import ast
import importlib.machinery
import importlib.util
import json
import modulefinder
import os
import re
import sys
import sysconfig


def main(folder, kind, name):
    del sys.path[0]  # of this text, not of the program
    answer = {"executable": sys.executable, "files": [], "packages": [], "installed": installed()}
    answer["listed"] = sorted(path for path in {folder, *sys.path, *stdlib()} if os.path.isdir(path))
    try:
        found = of_script(os.path.join(folder, name)) if kind == "script" else of_module(folder, name)
        answer["files"], answer["packages"] = found
        answer["arguments"] = arguments(answer["files"], name)
    except (ImportError, OSError, SyntaxError, ValueError) as error:
        place = f"{error.filename}:{error.lineno}: " if isinstance(error, SyntaxError) else ""
        answer["error"] = f"{place}{getattr(error, 'msg', None) or error}"
    print(json.dumps(answer))


def of_script(path):
    return imported(path, os.path.dirname(path))


def of_module(folder, spec):
    module, _, function = spec.partition(":")
    base = os.path.join(folder, *module.split("."))
    local = [path for path in (base + ".py", os.path.join(base, "__init__.py")) if os.path.isfile(path)]
    if local:
        if function and function not in names(local[0]):
            raise ImportError(f"{local[0]} has no function {function}")
        return imported(local[0], folder)
    top = importlib.util.find_spec(module.partition(".")[0])
    if top is None:
        raise ImportError(f"there is no module {module} in {folder} or among the packages of {sys.executable}")
    return elsewhere({module.partition(".")[0]})


def names(path):
    """What a module defines at its top level, as far as its text says; everything, after a star."""

    class Everything:
        def __contains__(self, _):
            return True

    found = set()
    with open(path, "rb") as file:
        tree = ast.parse(file.read(), path)
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            found.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            if any(alias.name == "*" for alias in node.names):
                return Everything()
            found |= {alias.asname or alias.name.partition(".")[0] for alias in node.names}
    return found


def arguments(files, spec):
    """What the function takes by name beside its first argument; None if that is unknown, or anything."""
    module, _, function = spec.partition(":")
    ends = (module.replace(".", os.sep) + ".py", os.path.join(module.replace(".", os.sep), "__init__.py"))
    for path in [path for path in files if function and path.endswith(ends)]:
        with open(path, "rb") as file:
            body = ast.parse(file.read(), path).body
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.name == function and not node.decorator_list:
                if node.args.kwarg is not None:
                    return None
                by_position = node.args.posonlyargs + node.args.args
                named = [each for each in by_position[1:] if each not in node.args.posonlyargs] + node.args.kwonlyargs
                return [each.arg for each in named]
    return None


class Finder(modulefinder.ModuleFinder):
    def find_module(self, name, path, parent=None):
        try:
            return super().find_module(name, path, parent)
        except AttributeError:  # its own, for a folder without __init__.py
            raise ImportError(name) from None


def imported(path, folder):
    """The file and every module below ``folder`` that it reaches; folders of what it imports from elsewhere."""
    finder = Finder(path=[folder])
    finder.run_script(path)
    files = {os.path.realpath(path)}
    files |= {os.path.realpath(module.__file__) for module in finder.modules.values() if module.__file__}
    more, packages = elsewhere({name.partition(".")[0] for name in finder.badmodules}, folder)
    return sorted(files | set(more)), packages


def elsewhere(names, folder=None):
    """Files and folders of modules that are not installed, and of what those import."""
    sys.path[:0] = [folder] if folder else []
    files, packages, seen, known = set(), set(), set(), installed()
    while names - seen:
        name = (names - seen).pop()
        seen.add(name)
        try:
            spec = importlib.util.find_spec(name)
        except (ImportError, ValueError, AttributeError):
            spec = None
        if spec is None or spec.origin in ("built-in", "frozen"):
            continue
        places = [os.path.realpath(place) for place in spec.submodule_search_locations or [spec.origin]]
        if all(any(place == path or place.startswith(path + os.sep) for path in known) for place in places):
            continue
        new = {path for place in places for path in below(place)}
        if spec.origin is None or not spec.submodule_search_locations:
            files |= new  # of a folder without __init__.py, which may hold anything else
        else:
            packages |= set(places)
        for path in new:
            if path.endswith(".py"):
                with open(path, encoding="utf-8", errors="replace") as file:
                    names = names | imports(file.read())
    return sorted(files), sorted(packages)


def below(place):
    if os.path.isfile(place):
        return [place]
    endings = (".py", *importlib.machinery.EXTENSION_SUFFIXES)
    walked = os.walk(place)
    return [os.path.join(root, file) for root, _, files in walked for file in files if file.endswith(endings)]


def imports(text):
    """The first parts of the modules that a text may import; a name too many does no harm."""
    found = re.findall(r"(?m)(?:^|[;:])[ \t]*(?:from[ \t]+(\w[\w.]*)[ \t]+import|import[ \t]+([^\n;#]+))", text)
    names = [name.strip() for module, several in found for name in [module, *several.split(",")]]
    return {name.split()[0].partition(".")[0] for name in names if name}


def stdlib():
    return {os.path.realpath(sysconfig.get_path(name)) for name in ("stdlib", "platstdlib")}


def installed():
    """Files and folders of the interpreter and its packages, without other environments that lie in them."""
    prefix = os.path.realpath(sys.prefix)
    found = set()
    if any(os.path.exists(os.path.join(prefix, mark)) for mark in ("pyvenv.cfg", "conda-meta")):
        found |= set(entries(prefix, ("envs", "pkgs")))
    for path in map(os.path.realpath, [*sys.path, *stdlib()]):
        if path in stdlib():
            found |= set(entries(path, ("site-packages", "dist-packages")))
        elif os.path.basename(path) in ("site-packages", "dist-packages", "lib-dynload"):
            found.add(path)
    return sorted(path for path in found if not any(path.startswith(other + os.sep) for other in found))


def entries(folder, without):
    listed = os.listdir(folder) if os.path.isdir(folder) else []
    return [os.path.realpath(os.path.join(folder, name)) for name in listed if name not in ("__pycache__", *without)]


main(*sys.argv[1:])
