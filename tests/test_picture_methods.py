"""Methods that give pictures alone: projected into maps, or scored as they relit; what they do not give stays empty."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

import unshade
from conftest import CASE, HERE, rows
from conftest import unshade as command

SUITE = f"""
format = 1
name = "pictures"
scene = "{HERE / "scenes" / "tiny-scene.toml"}"

[[method]]
name = "relighter"
command = ["{sys.executable}", "relighter.py", "{{capture}}", "{{maps}}", "{{lights}}"]
gives = "pictures"

[[method]]
name = "decomposer"
command = ["{sys.executable}", "decomposer.py", "{{capture}}", "{{maps}}"]
gives = "pictures"

[[method]]
name = "incomplete"
command = ["{sys.executable}", "incomplete.py", "{{capture}}", "{{maps}}"]
gives = "pictures"

[[method]]
name = "thief"
command = ["{sys.executable}", "thief.py", "{{capture}}", "{{maps}}", "{{lights}}"]
gives = "pictures"

[[method]]
name = "mean_texture"
"""

# A grey face in every light that is handed over: albedo times the shading of the mesh.
RELIGHTER = """
import sys
from pathlib import Path
import numpy as np
import unshade
from unshade.files.pictures import read_rgb, write_exr

capture, maps, lights = unshade.Capture(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3])
print("lights:", *sorted(path.name for path in lights.iterdir()))
for path in lights.iterdir():
    picture = read_rgb(path)
    rows = 16
    step = len(picture) // rows
    small = picture[: step * rows, : 2 * step * rows].reshape(rows, step, 2 * rows, step, 3).mean((1, 3))
    shading = capture.shading(small, texture_size=64)
    for name in capture.withheld:
        uv = capture.gbuffer(name)["uvs"]
        seen = np.isfinite(uv[..., 0])
        column, row = (np.nan_to_num(p * 64).clip(0, 63).astype(int) for p in (uv[..., 0], 1 - uv[..., 1]))
        write_exr(maps / "relit" / path.stem / f"{name}.exr", {"": np.where(seen[..., None], 0.2 * shading[row, column], 0)})
"""

# The photographs for the albedo, as PNG; the mesh's normals.
DECOMPOSER = """
import sys
from pathlib import Path
import numpy as np
from PIL import Image
import unshade
from unshade.files.pictures import write_exr

capture, maps = unshade.Capture(sys.argv[1]), Path(sys.argv[2])
(maps / "pictures" / "albedo").mkdir(parents=True)
for name in capture.train:
    x = capture.image(name).clip(0, 1)
    x = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)
    Image.fromarray(np.rint(255 * x).astype(np.uint8)).save(maps / "pictures" / "albedo" / f"{name}.png")
    normals = capture.gbuffer(name)["normals"]
    write_exr(maps / "pictures" / "normals" / f"{name}.exr", {"": np.nan_to_num(normals)})
"""

INCOMPLETE = """
import sys
from pathlib import Path
import numpy as np
from unshade.files.pictures import write_exr

write_exr(Path(sys.argv[2]) / "relit" / "moon" / "000.exr", {"": np.zeros((96, 96, 3))})
"""

# A link to what it cannot read itself.
THIEF = """
import os
import sys
from pathlib import Path

folder = Path(sys.argv[2]) / "relit" / "uniform"
folder.mkdir(parents=True)
os.symlink(Path("run/captures/tiny-studio/truth/relit/uniform/004.exr").absolute(), folder / "004.exr")
"""


@pytest.fixture(scope="session")
def run(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pictures")
    # The same scene: its capture is kept, and what the baseline made of it.
    shutil.copytree(tiny_run, folder / "run")
    (folder / "suite.toml").write_text(SUITE)
    for name, text in (
        ("relighter", RELIGHTER),
        ("decomposer", DECOMPOSER),
        ("incomplete", INCOMPLETE),
        ("thief", THIEF),
    ):
        (folder / f"{name}.py").write_text(text)
    done = command("run", folder / "suite.toml", "-o", folder / "run", check=False)
    assert done.returncode == 1, done.stderr  # two of them fail
    return folder / "run"


def test_relit_views_get_picture_rows_of_the_given_lights_only(run: Path) -> None:
    # The capture's own light is not handed over: an albedo would be found by it.
    assert (run / "logs" / CASE / "relighter.txt").read_text().strip() == "lights: uniform.exr"
    found = rows(run, "relighter")
    # What is said of the mesh and of a constant is no row of the method.
    of_method = [row for row in found.values() if not row.subject.startswith(("mesh_", "constant_", "usual_"))]
    assert {(row.subject, row.light) for row in of_method} == {("relit", "uniform"), ("relit_silhouette", "uniform")}
    none, scaled = (found[f"relit/uniform/psnr_srgb@mask-e5:{scale}"] for scale in ("none", "global"))
    assert 10 < none.value and scaled.value < 40
    assert none.floor is None
    document = json.loads((run / "scores" / CASE / "relighter.json").read_text())
    assert document["protocol"]["id"] == "unshade-1 own" and document.get("findings", []) == []


def test_global_factor_is_least_squares(run: Path) -> None:
    """By numpy, from the files: k = <p,g> / <p,p> inside the eroded masks."""
    from scipy.ndimage import binary_erosion

    from unshade.files.pictures import read_gray, read_rgb

    capture = run / "captures" / CASE
    across = square = 0.0
    for path in sorted((run / "maps" / CASE / "relighter" / "relit" / "uniform").iterdir()):
        mask = binary_erosion(read_gray(capture / "masks" / f"{path.stem}.png") > 127, np.ones((5, 5)))
        p, g = (read_rgb(f)[mask].astype(float) for f in (path, capture / "truth" / "relit" / "uniform" / path.name))
        across, square = across + (p * g).sum(), square + (p * p).sum()
    said = json.loads((run / "relit" / CASE / "relighter" / "relit.json").read_text())
    assert said["renderer"] == "own"
    np.testing.assert_allclose(said["scales"]["global"], across / square, rtol=1e-5)


def test_albedo_and_normals_by_view_become_maps(run: Path) -> None:
    ours, baseline = rows(run, "decomposer"), rows(run, "mean_texture")
    # The same pictures through 8-bit codes, and the mesh's own normals: the baseline's numbers.
    for name in ("diffuse_albedo/psnr_srgb@coverage-e5:global", "relit/uniform/psnr_srgb@mask-e5:global"):
        assert abs(ours[name].value - baseline[name].value) < 0.05
    name = "specular_normal/normal_mean_deg@coverage-e5:none"
    assert abs(ours[name].value - baseline[name].value) < 0.5  # pixels are coarser than texels
    assert not any(row.subject == "specular_albedo" for row in ours.values())
    maps = unshade.Maps.read(run / "maps" / CASE / "decomposer")
    assert maps.size == 512 and maps.specular_albedo is None


def test_unknown_light_fails_its_method_alone(run: Path) -> None:
    failed = {
        solver["id"]: solver.get("failed", "")
        for solver in json.loads((run / "run.json").read_text())["cases"][0]["solvers"]
    }
    assert "moon: is not a light of the capture; there are studio, uniform" in failed["incomplete"]
    assert "uniform/004.exr: is missing" in failed["thief"]
    assert [name for name, reason in failed.items() if reason] == ["incomplete", "thief"]
    page = (run / "report" / "index.html").read_text()
    assert "relighter" in page and "relit by own" in page


def test_missing_pictures_and_unsupported_keys_are_refused(tmp_path: Path, tiny_run: Path) -> None:
    suite = tmp_path / "suite.toml"
    head = f'format = 1\nname = "x"\nscene = "{HERE / "scenes" / "tiny-scene.toml"}"\n[[method]]\nname = "x"\n'
    words = f'command = ["{sys.executable}", "x.py", "{{capture}}", "{{maps}}"'

    def refused(text: str, reason: str) -> None:
        suite.write_text(head + text)
        done = command("run", suite, "-o", tmp_path / "run", check=False)
        assert done.returncode == 2 and reason in done.stderr and done.stderr.count("\n") == 1, done.stderr

    (tmp_path / "x.py").write_text("")
    refused(f'{words}, "{{lights}}"]\n', "add gives, or remove {lights}")
    refused('python = "x:y"\ngives = "pictures"\n', "write a command")
    refused('config = "fast"\ngives = "pictures"\n', "does not support gives")
    refused(f"{words}]\ntexture_size = 64\n", "does not support texture_size")
    # A program that leaves nothing: its captures are those of another run, so that nothing is rendered.
    shutil.copytree(tiny_run, tmp_path / "run")
    suite.write_text(f'{head}{words}]\ngives = "pictures"\n'.replace('name = "x"\nscene', 'name = "tiny"\nscene'))
    done = command("run", suite, "-o", tmp_path / "run", check=False)
    assert done.returncode == 1 and "left no pictures in pictures/albedo, pictures/normals" in done.stderr, done.stderr
