"""`build_head`: the face of a scene, whether generated or read from files."""

from __future__ import annotations

from .face import Face, build_face
from .own_head.spec import HeadFiles
from .scene_file import AnyHead


def build_head(head: AnyHead) -> Face:
    """Raises `FaceError` for what cannot be built."""
    if isinstance(head, HeadFiles):
        # Reading pictures needs the renderer's variant, which generated faces do without.
        from .own_head.build import build_own_head

        return build_own_head(head)
    return build_face(head)
