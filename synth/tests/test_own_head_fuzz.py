"""glTF files with changed bytes, words and structure: read, or refused in one line, in time and memory.

`UNSHADE_FUZZ_INPUTS` is the number of inputs, `UNSHADE_FUZZ_SEED` chooses others; one that fails is written
to the test's folder, which the message names.
"""

import copy
import json
import os
import random
import resource
import signal
import struct
import tempfile
import warnings
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

from unshade.face import FaceError
from unshade.own_head.mesh_file import read_pieces
from unshade.own_head.spec import MeshWarning

SECONDS, BYTES = 5, 2 << 30

EDGES = [
    0,
    1,
    -1,
    2,
    3,
    0.5,
    -0.0,
    255,
    65535,
    65536,
    2**31,
    2**32 - 1,
    2**32,
    2**63,
    1e39,
    1e308,
    float("nan"),
    float("inf"),
]
"""Numbers at which arithmetic turns over."""
OTHERS = [None, True, False, "", "a", "SCALAR", "VEC3", "MAT4", [], {}, [0], [[]], {"a": 1}]
"""Values of other types."""
KINDS = [5120, 5121, 5122, 5123, 5125, 5126]


def documents() -> list[tuple[dict, bytes]]:
    """Documents with their buffer: floats with a moved texture, quantised integers with sparse values, a morph and a
    skin, nodes in nodes."""
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], "<f4")
    uv = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], "<f4")
    indices = np.array([0, 1, 2, 1, 3, 2], "<u2")
    small = np.zeros((4, 4), "<i2")
    small[:, :3] = positions * 32767
    data = b"".join(
        part.tobytes()
        for part in (positions, uv, indices, small, np.array([1, 3], "<u4"), positions[:2], np.eye(4, dtype="<f4"))
    )
    sizes = (48, 32, 12, 32, 8, 24, 64)
    views = [
        {"buffer": 0, "byteOffset": int(end - size), "byteLength": size} for end, size in zip(np.cumsum(sizes), sizes)
    ]
    views[3]["byteStride"] = 8
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        {"bufferView": 3, "byteOffset": 0, "componentType": 5122, "normalized": True, "count": 4, "type": "VEC3"},
        {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
            "count": 2, "indices": {"bufferView": 4, "componentType": 5125}, "values": {"bufferView": 5}}},
        {"bufferView": 6, "componentType": 5126, "count": 4, "type": "VEC4"},
        {"bufferView": 6, "componentType": 5126, "count": 1, "type": "MAT4"},
    ]  # fmt: skip
    attributes = {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 0}
    base = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    plain = base | {"scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "head", "mesh": 0}],
        "materials": [{"name": "a", "normalTexture": {"index": 0, "extensions": {
            "KHR_texture_transform": {"offset": [0, 1], "rotation": 0.5, "scale": [1, -1], "texCoord": 0}}}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 2, "material": 0}]}]}  # fmt: skip
    rich = base | {
        "extensionsRequired": ["KHR_mesh_quantization"],
        "nodes": [
            {"children": [1, 2], "scale": [2, 2, 2], "rotation": [0, 0, 0.6, 0.8], "translation": [1, 2, 3]},
            {"name": "a", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1], "weights": [0.5]},
            {"name": "a", "mesh": 1, "skin": 0},
        ],
        "skins": [{"joints": [0, 1]}, {"joints": [2], "inverseBindMatrices": 6}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 3}, "targets": [{"POSITION": 4}], "mode": 5}], "weights": [1]},
            {
                "primitives": [
                    {"attributes": {"POSITION": 0, "JOINTS_0": 5, "WEIGHTS_0": 5}, "mode": 6},
                    {"attributes": {"POSITION": 4}, "mode": 1},
                ]
            },
        ],
    }
    return [(plain, data), (rich, data)]


def glb(document: dict, data: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def places(value, found=None) -> list[tuple]:
    """Every container of a document with each of its keys."""
    found = [] if found is None else found
    for key in list(value) if isinstance(value, dict) else range(len(value)):
        found.append((value, key))
        if isinstance(value[key], (dict, list)):
            places(value[key], found)
    return found


def changed(draw: random.Random, seeds: list[tuple[dict, bytes]]) -> bytes:
    document, data = draw.choice(seeds)
    document = copy.deepcopy(document)
    for _ in range(draw.choice([0, 1, 1, 2, 3, 6])):
        container, key = draw.choice(places(document) or [({}, "a")])
        way = draw.randrange(7)
        if way == 0:
            container.pop(key, None) if isinstance(container, dict) else container.pop(key)
        elif way == 1:
            container[key] = copy.deepcopy(draw.choice(OTHERS))
        elif way == 2:
            other, there = draw.choice(places(document) or [({}, "a")])
            container[key] = copy.deepcopy(other.get(there) if isinstance(other, dict) else other[there])
        elif way == 3 and isinstance(container, list):
            container.extend(container[key : key + 1] * draw.choice([1, 2, 40]))
        elif key == "componentType":
            container[key] = draw.choice(KINDS)
        else:
            container[key] = draw.choice(EDGES) if draw.random() < 0.6 else draw.randrange(-2, 12)
    file = bytearray(glb(document, data))
    for _ in range(draw.choice([0, 0, 1, 2, 8])):
        at, way = draw.randrange(len(file) or 1), draw.randrange(5)
        if way == 0:
            file[at : at + 1] = bytes([draw.randrange(256)])
        elif way == 1:
            file[at : at + 4] = struct.pack("<I", draw.choice([0, 1, 2**31, 2**32 - 1, len(file)]))
        elif way == 2:
            del file[at : at + draw.choice([1, 4, 32])]
        elif way == 3:
            file[at:at] = file[at : at + draw.choice([1, 4, 32])]
        elif draw.random() < 0.2:
            del file[at:]
    return bytes(file)


def outcome(path) -> str:
    try:
        pieces = read_pieces(path)
    except FaceError as error:
        message = str(error)
        assert message and "\n" not in message and len(message) < 2000, message[:200]
        return "refused"
    for piece in pieces:
        count = len(piece.vertices)
        assert np.isfinite(piece.vertices).all() and piece.triangles.min() >= 0 and piece.triangles.max() < count
        for values, width in ((piece.uv, 2), (piece.normals, 3)):
            assert values is None or values.shape == (count, width)
    return "read"


@pytest.fixture
def limits():
    """An alarm, and the memory that the process may have beyond what it has."""

    def late(*_):
        raise TimeoutError(f"more than {SECONDS} s")

    before = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as state:
        used = int(state.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + BYTES, before[1]))
    handler = signal.signal(signal.SIGALRM, late)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, handler)
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="the limit on memory is Linux's")
def test_changed_gltf_files_are_read_or_refused(tmp_path, limits):
    # Where there is memory for files, no disk has to keep up.
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        fuzz(Path(folder) / "head.glb", tmp_path / "failed.glb")


def fuzz(path: Path, kept: Path) -> None:
    count, run = int(os.environ.get("UNSHADE_FUZZ_INPUTS", 3000)), os.environ.get("UNSHADE_FUZZ_SEED", "0")
    seeds, counts = documents(), {"read": 0, "refused": 0}
    for seed in seeds:
        path.write_bytes(glb(*seed))
        with pytest.warns(MeshWarning) if "skins" in seed[0] else nullcontext():
            assert outcome(path) == "read"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for index in range(count):
            path.write_bytes(changed(random.Random(f"{run}/{index}"), seeds))
            signal.alarm(SECONDS)
            try:
                counts[outcome(path)] += 1
            except BaseException as error:  # recursion, memory, time and the like
                kept.write_bytes(path.read_bytes())
                raise AssertionError(f"input {index} of run {run} in {kept}: {error!r}") from error
            finally:
                signal.alarm(0)
    print(f"glb: {count} inputs from {len(seeds)} seeds: {counts}")
    assert counts["read"] > count // 20
