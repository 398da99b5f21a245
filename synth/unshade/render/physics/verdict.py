"""The verdict of a physics check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

_FIX = "compare the versions of `unshade doctor` with those unshade asks for; if they agree, the fault lies in {}"


@dataclass(frozen=True)
class Verdict:
    """Outcome of one check: measured figures in words, and the code to look at where it failed."""

    name: str
    ok: bool
    found: str
    suspect: str

    def entry(self) -> dict[str, Any]:
        """The entry of a list as `doctor.examine` makes it."""
        fix = {} if self.ok else {"fix": _FIX.format(self.suspect)}
        return {"name": self.name, "ok": self.ok, "found": self.found} | fix
