"""Checks the types of what users of the package meet, and of the documentation's examples.

    python tests/check_types.py        mypy and pyright, both strict; the stubs against the code; the order of imports

The rendering behind it is no part of this: it is typed for its readers.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from doc_examples import ROOT, examples
from metric_stub import STUB, stub

SOURCES = ROOT / "synth"
PUBLIC = (
    "__init__.pyi", "_native.pyi", "metrics.pyi", "bookkeeping.py", "errors.py", "exr.py", "maps.py", "own_metrics.py",
    "scores.py", "stages.py", "stopping.py",
)  # fmt: skip
COMPILED = ("unshade._native", "unshade.metrics")


def main() -> int:
    STUB.write_text(stub())
    public = [str(SOURCES / "unshade" / name) for name in PUBLIC]
    with tempfile.TemporaryDirectory(prefix="unshade-types-") as temporary:
        folder = Path(temporary)
        files = list(public)
        for place, code in examples().items():
            file = folder / f"example_{re.sub(r'[^0-9a-z]+', '_', place.lower())}.py"
            file.write_text(code)
            files.append(str(file))
        environment = {**os.environ, "MYPYPATH": str(SOURCES), "MYPY_CACHE_DIR": str(ROOT / ".venv" / "mypy")}
        config = folder / "pyrightconfig.json"
        config.write_text(json.dumps({"include": files, "extraPaths": [str(SOURCES)], "typeCheckingMode": "strict"}))
        python = [sys.executable, "-m"]
        checks = {
            "mypy": [*python, "mypy", "--strict", "--no-error-summary", "--explicit-package-bases", *files],
            "pyright": [*python, "basedpyright", "--project", str(config), "--pythonpath", sys.executable],
            "stubtest": [*python, "mypy.stubtest", "--concise", *COMPILED],
            "order of imports": [sys.executable, str(SOURCES / "tests" / "import_order.py")],
        }
        # Each says its own; the last line of all is the verdict.
        failed = [name for name, words in checks.items() if subprocess.run(words, env=environment, cwd=ROOT).returncode]
    print(f"types: {', '.join(failed)} failed" if failed else "types: right")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
