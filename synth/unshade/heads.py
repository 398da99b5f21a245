"""`build_head`: the face of a scene, generated or read from files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .face import Face, build_face
from .files.array_store import ArrayStore
from .files.content_key import content_key
from .fingerprint import fingerprint
from .own_head.build import build_own_head
from .own_head.spec import HeadFiles
from .scene_file import AnyHead


def build_head(head: AnyHead) -> Face:
    """Raises `FaceError` for a head that cannot be built.

    Maps and raised surface of a generated face are made once and kept (`ArrayStore`): the stages of a suite need them
    again and again.
    """
    if isinstance(head, HeadFiles):
        return build_own_head(head)
    store, source = ArrayStore.of_user(), fingerprint("face.build")

    def keep(name: str, kind: type, make: Callable[[], Any]) -> Any:
        key = content_key(source, name, head)
        arrays = store.get(key, kind)
        if arrays is None:
            arrays = make()
            store.put(key, arrays)
        return arrays

    return replace(build_face(head), keep=keep)
