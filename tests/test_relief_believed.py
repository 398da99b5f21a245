"""Relief that is there is found, and paint alone is not taken for it: one face with its relief and, as a head of one's
own, the same mesh and paint without."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import unshade

pytestmark = pytest.mark.heavy
PROGRAM = Path(sys.executable).with_name("unshade")
SCENE = """format = 1
name = "{name}"
light = "{lights}/studio.toml"
rig = {{ name = "half", kind = "phone", train = 6, test = 1, max_angle_degrees = 40, seed = 2 }}
face = {{ name = "{name}", {face} }}
[render]
width = 96
height = 96
samples = 64
depth = 4
"""


def capture(folder: Path, name: str, face: str) -> Path:
    lights = Path(__file__).parent.parent / "scenes" / "lights"
    file = folder / f"{name}.toml"
    file.write_text(SCENE.format(name=name, lights=lights, face=face))
    subprocess.run([PROGRAM, "synth", file, "-o", folder / name], check=True, capture_output=True)
    return folder / name


@pytest.fixture(scope="module")
def faces(tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("relief")
    real = capture(folder, "real", 'seed = 5, fitzpatrick = "II", detail = "natural", texture_size = 256')
    truth = real / "truth"
    painted = (
        f'mesh = "{real}/mesh.obj", units = "m", up = "+y", forward = "+z", texture_size = 256, '
        f'diffuse_albedo = "{truth}/diffuse_albedo.exr", diffuse_albedo_space = "linear", '
        f'specular_albedo = "{truth}/specular_albedo.exr", specular_albedo_space = "linear", labels = "{truth}/labels.png"'
    )
    return {"real": real, "painted": capture(folder, "painted", painted)}


def normals(folder: Path, config: str) -> tuple[float, float]:
    """Mean angle to the truth of the specular normals, and of the mesh's, degrees."""
    taken = unshade.Capture(folder)
    scores = unshade.score(taken, unshade.solve(taken, config=config))
    keys = {"metric": "normal_mean_deg", "region": "coverage-e5", "label": None}
    found, mesh = (scores.value(subject=subject, **keys) for subject in ("specular_normal", "mesh_specular_normal"))
    assert found is not None and mesh is not None
    return found, mesh


def test_relief_is_believed_where_other_views_show_it(faces):
    found, mesh = normals(faces["real"], "fast")
    assert mesh > 2.5 and found < 0.97 * mesh


def test_paint_is_no_relief(faces):
    believing, mesh = normals(faces["painted"], 'base = "fast"\n[relief]\nminimum_agreement = 0.0\n')
    assert mesh < 0.01 and believing > 0.3, "without the test paint is taken for relief"
    assert normals(faces["painted"], "fast")[0] < 0.3
