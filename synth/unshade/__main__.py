"""The ``unshade`` command: hands its arguments to the Rust command line, those of ``import`` to ours."""

from __future__ import annotations

import os
import signal
import sys


def main() -> int:
    """Run the command line of :mod:`sys` and return its exit code."""
    # The rendering stages run in the interpreter that this package is installed in.
    os.environ.setdefault("UNSHADE_PYTHON", sys.executable)
    # Ctrl-C belongs to the Rust side, which stops its stages cleanly.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.argv[1:2] == ["import"]:
        from unshade.importing.command import main as import_main

        return import_main(sys.argv[2:])
    from unshade._native import run_command_line

    return run_command_line(["unshade", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
