"""The recovered head as a page: in a notebook, or opened from disk."""

from __future__ import annotations

import html
import re
import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from unshade._native import Capture

from .commands import Progress as _Progress
from .commands import command
from .maps import Maps
from .stages import _folder_of, _Path, _path_of


class HeadPage:
    """The page of a head. ``path`` is its ``index.html``; a notebook shows the page itself."""

    path: Path

    def __init__(self, path: Path, temporary: tempfile.TemporaryDirectory[str] | None = None) -> None:
        self.path = path
        # A page without a folder of its own lives as long as this object.
        self._temporary = temporary

    def __repr__(self) -> str:
        return f"HeadPage({str(self.path)!r})"

    def _repr_html_(self) -> str:
        """The whole page inside a frame, data included: a notebook's server need not reach the folder."""
        return (
            f'<iframe srcdoc="{html.escape(self._whole())}" style="width:100%;height:760px;border:0" '
            'title="a recovered head, to be turned and relit"></iframe>'
        )

    def _whole(self) -> str:
        folder = self.path.parent
        arrays = "".join(
            _inline(file.read_text("utf-16")) for file in sorted((folder / "data").glob("*.js")) if file.stem != "scene"
        )
        page = re.sub(
            r'<link rel="stylesheet" href="(.*?)">',
            lambda found: f"<style>{(folder / found[1]).read_text('utf-8')}</style>",
            self.path.read_text("utf-8"),
        )
        return re.sub(
            r'<script src="(.*?)"></script>',
            # The manifest opens the page, so the arrays come before it.
            lambda found: (
                (arrays if found[1] == "data/scene.js" else "") + _inline((folder / found[1]).read_text("utf-8"))
            ),
            page,
        )


def _inline(script: str) -> str:
    closed = script.replace("</script", "<\\/script")
    return f"<script>{closed}</script>"


def view(
    capture: Capture | _Path, *maps: Maps | _Path, out: _Path | None = None, progress: _Progress | None = None
) -> HeadPage:
    """Write the head of a capture with up to three folders of maps as a page that opens offline.

    Without ``out`` the page lasts as long as the returned object, which a notebook shows. Methods are called as
    their folders. Raises `CaptureError`, `MapsError` and `StorageError`.
    """
    temporary = None if out is not None else tempfile.TemporaryDirectory(prefix="unshade-view-")
    place = Path(out) if out is not None else Path(temporary.name) / "page"  # type: ignore[union-attr]
    with ExitStack() as stack:
        folders = [stack.enter_context(_folder_of(each)) for each in maps]
        arguments: dict[str, Any] = {"capture": _path_of(capture), "maps": folders, "out": place}
        command("view", **arguments, progress=progress)
    return HeadPage(place / "index.html", temporary)
