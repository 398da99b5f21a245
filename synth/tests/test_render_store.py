"""Pictures kept by content: what changed is rendered again, and nothing else."""

import os
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import pytest
import render_toy

from unshade import heads
from unshade.errors import StorageError
from unshade.files.array_store import ArrayStore
from unshade.files.content_key import content_key
from unshade.render.layers import Layers


class Hue(Enum):
    RED = 1
    BLUE = 2


@dataclass(frozen=True)
class Thing:
    size: float
    shape: np.ndarray
    hue: Hue = Hue.RED


THING = Thing(1.0, np.arange(6, dtype=np.float32))
GRID = np.arange(12.0).reshape(3, 4)


@pytest.mark.parametrize(
    "other",
    [
        replace(THING, size=1),
        replace(THING, size=np.nextafter(1.0, 2.0)),
        replace(THING, shape=THING.shape.reshape(2, 3)),
        replace(THING, shape=THING.shape.astype(np.int32)),
        replace(THING, shape=THING.shape[::-1]),
        replace(THING, hue=Hue.BLUE),
        (THING,),
        [THING, None],
        {"thing": THING},
    ],
)
def test_keys_tell_contents_apart(other):
    assert content_key(other) != content_key(THING)


def test_equal_contents_have_equal_keys():
    assert content_key(replace(THING, shape=THING.shape.copy())) == content_key(THING)
    assert content_key(GRID[:, ::2]) == content_key(GRID[:, ::2].copy())
    assert content_key(["ab", "c"]) != content_key(["a", "bc"])
    with pytest.raises(TypeError, match="a object has no content key"):
        content_key(object())


def layers(value, size=16):
    return Layers(*(np.full((size, size, 3), value + i, np.float32) for i in range(3)))


def test_a_kept_picture_comes_back_bit_by_bit(tmp_path):
    store = ArrayStore(tmp_path / "renders")
    assert store.get("a", Layers) is None
    store.put("a", layers(0.1))
    back = store.get("a", Layers)
    for name in ("diffuse", "specular", "variance"):
        assert getattr(back, name).tobytes() == getattr(layers(0.1), name).tobytes()
    assert back.half is None
    halved = replace(layers(0.1), half=np.full((16, 16, 3), 0.3, np.float32))
    store.put("halved", halved)
    assert store.get("halved", Layers).half.tobytes() == halved.half.tobytes()
    (tmp_path / "renders/a.npz").write_bytes(b"half")
    assert store.get("a", Layers) is None


def test_the_least_recently_used_pictures_make_room(tmp_path):
    one = ArrayStore(tmp_path)
    one.put("a", layers(0))
    size = (tmp_path / "a.npz").stat().st_size
    store = ArrayStore(tmp_path, limit_bytes=2 * size + 10)
    os.utime(tmp_path / "a.npz", ns=(1, 1))
    store.put("b", layers(1))
    os.utime(tmp_path / "b.npz", ns=(2, 2))
    assert store.get("a", Layers) is not None  # used just now
    store.put("c", layers(2))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz", "c.npz"]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="UNSHADE_RENDER_CACHE=off"):
        ArrayStore(tmp_path / "file" / "renders").put("a", layers(0))


def test_a_store_that_is_off_keeps_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", "off")
    store = ArrayStore.of_user()
    store.put("a", layers(0))
    assert store.folder is None and store.get("a", Layers) is None
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", str(tmp_path))
    assert ArrayStore.of_user().folder == tmp_path


def test_a_face_is_painted_once(tmp_path, monkeypatch):
    painted = []

    def build(spec):
        face = render_toy.toy_face(spec)
        return replace(face, paint=lambda: painted.append(spec.seed) or face.paint())

    monkeypatch.setenv("UNSHADE_RENDER_CACHE", str(tmp_path))
    monkeypatch.setattr(heads, "build_face", build)
    first, again = (heads.build_head(render_toy.SPEC).maps for _ in range(2))
    assert painted == [1] and again.height is None
    assert first.roughness.tobytes() == again.roughness.tobytes() and first.labels.dtype == again.labels.dtype
    heads.build_head(replace(render_toy.SPEC, texture_size=32, seed=2)).maps  # noqa: B018
    assert painted == [1, 2]
