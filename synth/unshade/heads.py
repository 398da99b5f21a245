"""`build_head`: the face of a scene, generated or read from files."""

from __future__ import annotations

from .face import Face, build_face
from .own_head.build import build_own_head
from .own_head.spec import HeadFiles
from .scene_file import AnyHead


def build_head(head: AnyHead) -> Face:
    """Raises `FaceError` for a head that cannot be built."""
    return build_own_head(head) if isinstance(head, HeadFiles) else build_face(head)
