"""`unshade export` from the outside."""

from __future__ import annotations

import json
from pathlib import Path

from conftest import CASE, unshade


def test_recovered_maps_become_an_asset(tiny_run: Path, tmp_path: Path) -> None:
    capture, maps = tiny_run / "captures" / CASE, tiny_run / "maps" / CASE / "quick"
    out = tmp_path / "face"
    done = unshade("export", maps, "--capture", capture, "--format", "gltf", "-o", out)
    said = done.stdout.splitlines()
    assert said[0] == str(out / "face.glb") and (out / "face.glb").read_bytes()[:4] == b"glTF"
    rows = json.loads((out / "fidelity.json").read_text())["rows"]
    assert [row["light"] for row in rows] == ["studio", "uniform"]
    for row, line in zip(rows, said[1:], strict=True):
        assert f"gltf in {row['light']}: {row['psnr_srgb']:.1f} dB" in line


def test_a_mesh_serves_without_a_capture(tiny_run: Path, tmp_path: Path) -> None:
    maps = tiny_run / "captures" / CASE / "truth"
    mesh = tiny_run / "captures" / CASE / "mesh.obj"
    unshade("export", maps, "--mesh", mesh, "--format", "mitsuba", "-o", tmp_path / "face")
    (row, *_) = json.loads((tmp_path / "face/fidelity.json").read_text())["rows"]
    assert row["view"] == "front" and (row["psnr_srgb"] is None or row["psnr_srgb"] > 60)


def test_what_cannot_be_exported_is_one_line(tiny_run: Path, tmp_path: Path) -> None:
    maps = tiny_run / "maps" / CASE / "quick"
    nothing = unshade("export", maps, "--format", "gltf", "-o", tmp_path / "face", check=False)
    assert nothing.returncode == 2 and "--capture" in nothing.stderr
    capture = tiny_run / "captures" / CASE
    inside = unshade("export", maps, "--capture", capture, "--format", "png", "-o", maps, check=False)
    assert inside.returncode == 2 and "unshade: " in inside.stderr
    unknown = unshade("export", maps, "--capture", capture, "--format", "usdz", "-o", tmp_path / "face", check=False)
    assert unknown.returncode == 2 and "gltf" in unknown.stderr
