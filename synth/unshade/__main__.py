"""The ``unshade`` command: hands its arguments to the Rust command line."""

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
    from unshade._native import run_command_line

    return run_command_line(["unshade", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
