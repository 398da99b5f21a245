"""`unshade.Maps`: what it takes, what it hands out, copies and pickles."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import unshade
from unshade import Maps
from unshade.errors import MapsError

SIZE = 8
PLANES = ("specular_albedo", "confidence")
COLOURS = ("diffuse_albedo", "diffuse_normal", "specular_normal", "roughness")


@pytest.fixture
def arrays() -> dict[str, np.ndarray]:
    random = np.random.default_rng(0)
    made = {name: random.random((SIZE, SIZE), dtype=np.float32) for name in PLANES}
    made |= {name: random.random((SIZE, SIZE, 3), dtype=np.float32) for name in COLOURS}
    return made | {"coverage": np.where(made["confidence"] > 0.5, 255, 0).astype(np.uint8)}


def test_every_map_survives_folder_copy_and_pickle(arrays, tmp_path: Path) -> None:
    maps = Maps(**arrays)
    maps.write(tmp_path / "maps")
    others = [Maps.read(tmp_path / "maps"), copy.copy(maps), copy.deepcopy(maps)]
    others += [pickle.loads(pickle.dumps(maps, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    for other in others:
        assert other == maps and not other != maps and other is not maps  # noqa: SIM202
        for name, array in arrays.items():
            found = getattr(other, name)
            np.testing.assert_array_equal(found, array)
            assert found.dtype == array.dtype
    changed = copy.copy(maps)
    changed.confidence = None
    assert changed != maps and maps.confidence is not None
    changed.confidence = arrays["confidence"] + 1e-3
    assert changed != maps and maps != "maps"
    assert Maps() == Maps() and Maps().size is None and maps.size == SIZE
    with pytest.raises(TypeError, match="unhashable"):
        hash(maps)


def test_it_says_what_it_holds(arrays) -> None:
    assert repr(Maps(coverage=arrays["coverage"], diffuse_albedo=arrays["diffuse_albedo"])) == (
        "Maps(8 x 8: diffuse_albedo, coverage)"
    )
    assert repr(Maps()) == "Maps(no map)"


def test_arrays_are_views_that_cannot_be_written_to(arrays) -> None:
    maps = Maps(**arrays)
    for name in arrays:
        first, second = getattr(maps, name), getattr(maps, name)
        assert np.shares_memory(first, second), name
        with pytest.raises(ValueError, match="read-only"):
            first[0, 0] = 1
        with pytest.raises(ValueError, match="WRITEABLE"):
            first.flags.writeable = True
    # What was given stays the caller's, and a view outlives what it came from.
    albedo = maps.diffuse_albedo
    before = albedo.copy()
    arrays["diffuse_albedo"][:] = 7
    maps.diffuse_albedo = 0.5 * before
    np.testing.assert_array_equal(maps.diffuse_albedo, 0.5 * before)
    del maps
    np.testing.assert_array_equal(albedo, before)


def test_any_float_array_is_taken(arrays) -> None:
    albedo = arrays["diffuse_albedo"]
    wide = np.zeros((SIZE, 2 * SIZE, 3))
    wide[:, ::-2] = albedo[:, ::-1][:, ::-1]
    alike = [
        albedo.astype(np.float64), albedo.tolist(), np.asfortranarray(albedo), albedo.astype(">f4"),
        wide[:, ::-2], np.ascontiguousarray(albedo.transpose(1, 0, 2)).transpose(1, 0, 2),
    ]  # fmt: skip
    for like in alike:
        assert Maps(diffuse_albedo=like) == Maps(diffuse_albedo=albedo)
    plane = arrays["specular_albedo"]
    assert Maps(specular_albedo=plane[..., None]) == Maps(specular_albedo=plane)
    covered = arrays["coverage"] > 127
    for like in (covered, covered.astype(np.uint8), covered.astype(int) * 255, covered.tolist()):
        assert Maps(coverage=like) == Maps(coverage=arrays["coverage"])


def test_what_is_no_map_is_refused_by_name(arrays) -> None:
    albedo, plane, coverage = (arrays[name] for name in ("diffuse_albedo", "specular_albedo", "coverage"))
    broken = albedo.copy()
    broken[3, 2, 1] = np.nan
    maps = Maps(diffuse_albedo=albedo)
    refused = {
        r"diffuse_albedo: has shape \(8, 7, 3\), expected \(size, size, 3\)": dict(diffuse_albedo=albedo[:, 1:]),
        r"diffuse_albedo: has shape \(8, 8\), expected \(size, size, 3\)": dict(diffuse_albedo=plane),
        r"specular_albedo: has shape \(8, 8, 3\), expected \(8, 8\)": dict(
            diffuse_albedo=albedo, specular_albedo=albedo
        ),
        r"specular_normal: has shape \(4, 4, 3\), expected \(8, 8, 3\)": dict(
            diffuse_albedo=albedo, specular_normal=albedo[:4, :4]
        ),
        r"diffuse_albedo: has shape \(4, 4, 3\), expected \(8, 8, 3\)": dict(
            coverage=coverage, diffuse_albedo=albedo[:4, :4]
        ),
        r"coverage: has shape \(8, 4\), expected \(size, size\)": dict(coverage=coverage[:, :4]),
        r"coverage: holds 0.5; give uint8": dict(coverage=np.full((8, 8), 0.5)),
        r"diffuse_albedo: has dtype uint8": dict(diffuse_albedo=(albedo * 255).astype(np.uint8)),
        r"confidence: expected a float array": dict(confidence="confidence.exr"),
        r"roughness: expected .* got shape \[8\]": dict(roughness=plane[0]),
        r"diffuse_normal: has shape \(0, 0, 3\)": dict(diffuse_normal=albedo[:0, :0]),
        r"diffuse_albedo: is NaN at column 2, row 3, channel 1": dict(diffuse_albedo=broken),
    }
    for words, given in refused.items():
        with pytest.raises(MapsError, match=words):
            Maps(**given)
    with pytest.raises(MapsError, match=r"specular_albedo: has shape \(4, 4\), expected \(8, 8\)"):
        maps.specular_albedo = plane[:4, :4]
    # The one map that there is may change its size.
    maps.diffuse_albedo = albedo[:4, :4]
    assert maps.size == 4


def test_texels_without_coverage_may_hold_anything(arrays, tmp_path: Path) -> None:
    albedo, coverage = arrays["diffuse_albedo"], arrays["coverage"].copy()
    coverage[0, 0], coverage[5, 5] = 0, 255
    albedo[coverage == 0] = np.nan
    maps = Maps(diffuse_albedo=albedo, coverage=coverage)
    assert np.isnan(maps.diffuse_albedo[0, 0]).all() and maps == copy.copy(maps)
    maps.write(tmp_path / "maps")
    back = Maps.read(tmp_path / "maps")
    np.testing.assert_array_equal(back.diffuse_albedo, np.where(coverage[..., None], albedo, 0))
    with pytest.raises(MapsError, match="diffuse_albedo: is NaN at column 0, row 0, channel 0"):
        maps.coverage = None
    assert maps.coverage is not None
    with pytest.raises(MapsError, match="is NaN"):
        maps.coverage = np.full((SIZE, SIZE), 255)


def test_maps_are_a_mapping_of_what_there_is(arrays) -> None:
    maps = Maps(confidence=arrays["confidence"], diffuse_albedo=arrays["diffuse_albedo"])
    assert maps.keys() == list(maps) == ["diffuse_albedo", "confidence"] and len(maps) == 2
    assert "confidence" in maps and "coverage" not in maps
    np.testing.assert_array_equal(maps["confidence"], arrays["confidence"])
    maps["confidence"] = None
    maps["coverage"] = arrays["coverage"]
    assert maps.keys() == ["diffuse_albedo", "coverage"]
    for wrong in (lambda: maps["confidence"], lambda: maps.__setitem__("albedo", arrays["confidence"])):
        with pytest.raises(KeyError, match="there are diffuse_albedo, coverage|use one of diffuse_albedo, "):
            wrong()
    html = maps._repr_html_()
    assert html.count("data:image/png;base64,") == 2 and "http" not in html.replace("data:", "")


def test_resized_maps_keep_means_lengths_and_holes(arrays) -> None:
    maps = Maps(**arrays)
    half = maps.resize(SIZE // 2)
    covered = (arrays["coverage"] > 127).reshape(SIZE // 2, 2, SIZE // 2, 2)
    blocks = arrays["specular_albedo"].reshape(covered.shape)
    count = covered.sum((1, 3))
    mean = (blocks * covered).sum((1, 3)) / np.maximum(count, 1)
    np.testing.assert_allclose(half.specular_albedo, mean, atol=1e-5)
    np.testing.assert_array_equal(half.coverage, np.where(count >= 2, 255, 0))
    lengths = np.linalg.norm(half.diffuse_normal, axis=-1)[count > 0]
    np.testing.assert_allclose(lengths, 1, atol=1e-5)
    flat = Maps(diffuse_albedo=np.full((SIZE, SIZE, 3), 0.25))
    for side in (3, 20):
        other = flat.resize(side)
        assert other.size == side and other.coverage is None
        np.testing.assert_allclose(other.diffuse_albedo, 0.25, atol=1e-6)
    assert maps.resize(SIZE) == maps and maps.resize(SIZE) is not maps
    with pytest.raises(MapsError, match="side is 0; give a size from 1"):
        maps.resize(0)


def test_the_truth_has_its_roughness(tiny_run: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / "tiny-studio")
    truth = capture.truth()
    assert truth.roughness is not None and truth.size is not None
    assert truth.roughness.shape == (truth.size, truth.size, 3)
    sharp, broad, weight = truth.roughness[truth.coverage > 127].T
    assert (0 < sharp).all() and (sharp < broad).all() and (broad < 1).all() and ((0 <= weight) & (weight <= 1)).all()
    assert "roughness" in repr(truth)
    again = pickle.loads(pickle.dumps(capture))
    assert again.path == capture.path and again.truth() == truth == pickle.loads(pickle.dumps(truth))
