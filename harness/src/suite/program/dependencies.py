"""What a Python program is made of, as one line of JSON; run by the program's own interpreter.

Arguments: FOLDER, then ``script PATH`` or ``module NAME[:FUNCTION]``. ``files`` are the program's file
and all that it imports from its folder, found without running it; ``system`` are the folders of the
interpreter and its packages; ``arguments`` are the names that the function takes beside the capture, null where
its text does not tell; ``error`` says why it cannot run.
"""

import ast
import importlib.util
import json
import modulefinder
import os
import sys


def main(folder, kind, name):
    del sys.path[0]  # of this text, not of the program
    system = {sys.prefix, sys.base_prefix, sys.exec_prefix, os.path.dirname(os.path.realpath(sys.executable))}
    system |= {path for path in sys.path if os.path.exists(path)}
    answer = {"executable": sys.executable, "system": sorted(system), "files": []}
    try:
        answer["files"] = of_script(os.path.join(folder, name)) if kind == "script" else of_module(folder, name)
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
    if not top.submodule_search_locations:
        return [top.origin] if top.origin and os.path.isfile(top.origin) else []
    found = []
    for location in top.submodule_search_locations:
        for root, _, files in os.walk(location):
            found += [os.path.join(root, file) for file in files if file.endswith(".py")]
    return sorted(found)


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


def imported(path, folder):
    """The file and every module below ``folder`` that it reaches."""
    finder = modulefinder.ModuleFinder(path=[folder])
    finder.run_script(path)
    files = {os.path.realpath(path)}
    files |= {os.path.realpath(module.__file__) for module in finder.modules.values() if module.__file__}
    return sorted(files)


main(*sys.argv[1:])
