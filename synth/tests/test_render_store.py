"""Pictures kept by content: what changed is rendered again, and nothing else."""

import os
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import pytest

from unshade.errors import StorageError
from unshade.files.content_key import content_key
from unshade.render.layers import Layers
from unshade.render.picture_store import PictureStore


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
    store = PictureStore(tmp_path / "renders")
    assert store.get("a") is None
    store.put("a", layers(0.1))
    back = store.get("a")
    for name in ("diffuse", "specular", "variance"):
        assert getattr(back, name).tobytes() == getattr(layers(0.1), name).tobytes()
    assert back.half is None
    halved = replace(layers(0.1), half=np.full((16, 16, 3), 0.3, np.float32))
    store.put("halved", halved)
    assert store.get("halved").half.tobytes() == halved.half.tobytes()
    (tmp_path / "renders/a.npz").write_bytes(b"half")
    assert store.get("a") is None


def test_the_least_recently_used_pictures_make_room(tmp_path):
    one = PictureStore(tmp_path)
    one.put("a", layers(0))
    size = (tmp_path / "a.npz").stat().st_size
    store = PictureStore(tmp_path, limit_bytes=2 * size + 10)
    os.utime(tmp_path / "a.npz", ns=(1, 1))
    store.put("b", layers(1))
    os.utime(tmp_path / "b.npz", ns=(2, 2))
    assert store.get("a") is not None  # used just now
    store.put("c", layers(2))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz", "c.npz"]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="UNSHADE_RENDER_CACHE=off"):
        PictureStore(tmp_path / "file" / "renders").put("a", layers(0))


def test_a_store_that_is_off_keeps_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", "off")
    store = PictureStore.of_user()
    store.put("a", layers(0))
    assert store.folder is None and store.get("a") is None
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", str(tmp_path))
    assert PictureStore.of_user().folder == tmp_path
