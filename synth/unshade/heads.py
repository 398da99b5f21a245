"""`build_head`: the face of a scene, generated or read from files."""

from __future__ import annotations

from dataclasses import replace

from .face import Face, FaceSpec, Maps, build_face
from .files.array_store import ArrayStore
from .files.content_key import content_key
from .fingerprint import fingerprint
from .own_head.build import build_own_head
from .own_head.spec import HeadFiles
from .scene_file import AnyHead


def build_head(head: AnyHead) -> Face:
    """Raises `FaceError` for a head that cannot be built.

    Maps of a generated face are painted once and kept (`ArrayStore`): the stages of a suite need them again and again.
    """
    if isinstance(head, HeadFiles):
        return build_own_head(head)
    face = build_face(head)
    return replace(face, paint=lambda: _painted(face, head))


def _painted(face: Face, spec: FaceSpec) -> Maps:
    store = ArrayStore.of_user()
    key = content_key(fingerprint("face.build"), spec)
    maps = store.get(key, Maps)
    if maps is None:
        maps = face.paint()
        store.put(key, maps)
    return maps
