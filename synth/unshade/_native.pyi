"""The compiled core; use it through :mod:`unshade`."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

_Path = str | os.PathLike[str]
_Float = NDArray[np.float32]
_Byte = NDArray[np.uint8]

__version__: str

class _Camera(TypedDict):
    width: int
    height: int
    focal: list[float]
    centre: list[float]
    camera_to_world: _Float

class _GBuffer(TypedDict):
    positions: _Float
    normals: _Float
    uvs: _Float

class _Mesh(TypedDict):
    vertices: _Float
    normals: _Float
    uvs: _Float
    triangles: NDArray[np.uint32]

class Capture:
    """A capture folder, opened and checked; raises ``errors.CaptureError``."""

    def __init__(self, path: _Path) -> None: ...
    @property
    def path(self) -> Path:
        """The folder."""
    @property
    def train(self) -> list[str]:
        """Names of the training views."""
    @property
    def withheld(self) -> list[str]:
        """Names of the withheld views; their pictures belong to the truth."""
    @property
    def mesh(self) -> _Mesh:
        """Vertices and normals (V, 3), uvs (V, 2), triangles (F, 3); metres, world space."""
    def image(self, name: str) -> _Float:
        """(height, width, 3) linear radiance of a training view."""
    def mask(self, name: str) -> _Byte:
        """(height, width), 255 where the mesh is the first surface."""
    def labels(self, name: str) -> _Byte | None:
        """(height, width) region ids."""
    def camera(self, name: str) -> _Camera:
        """Any view's camera: pixels, and camera to world with OpenGL axes (4, 4)."""
    def gbuffer(self, name: str) -> _GBuffer:
        """What any view sees of the mesh at its pixels' centres: positions and normals
        (height, width, 3), uvs (height, width, 2); NaN where it sees nothing of it."""
    def shading(
        self,
        light: _Float,
        *,
        texture_size: int = 128,
        nearness: float = 0.0,
        bounces: int = 2,
        bounce_albedo: float = 0.4,
    ) -> _Float:
        """The diffuse shading (N, N, 3) of the mesh in an environment (rows, 2 rows, 3), lat-long
        as ``truth/light.exr``, on a sphere of 1 / ``nearness`` metres, with the mesh's own shadows
        and bounces: 1 for radiance 1 from everywhere. A diffuse layer is albedo times shading."""
    def truth(self) -> Maps:
        """The true maps of a synthetic capture."""

class Maps:
    """Square reflectance maps; what a solver does not recover is None."""

    diffuse_albedo: _Float | None
    specular_albedo: _Float | None
    diffuse_normal: _Float | None
    specular_normal: _Float | None
    confidence: _Float | None
    coverage: _Byte | None
    def __init__(
        self,
        *,
        diffuse_albedo: _Float | None = None,
        specular_albedo: _Float | None = None,
        diffuse_normal: _Float | None = None,
        specular_normal: _Float | None = None,
        confidence: _Float | None = None,
        coverage: _Byte | None = None,
    ) -> None: ...
    @property
    def interrupted(self) -> str | None:
        """Where the solve was stopped; None if it came to its end."""
    @staticmethod
    def read(path: _Path) -> Maps:
        """Read whatever maps the folder has."""
    def write(self, path: _Path) -> None:
        """Write the folder, completely or not at all."""

def solve(
    capture: Capture,
    *,
    config: str = "unshade",
    out: _Path | None = None,
    progress: Callable[[str, int, int, float], object] | None = None,
    backend: str = "auto",
) -> Maps:
    """Recover maps; ``config`` is a preset's name or the text of a configuration.

    ``progress(stage, iteration, total, loss)`` hears how it goes. What it raises stops the solve
    and is raised here, as is Ctrl-C; returning ``False`` stops it and returns the maps so far,
    whose ``interrupted`` says where. With ``out`` the whole maps folder is written there, after a
    stop as well; the same call then goes on from there, to the same bytes. ``backend`` is ``auto``
    (a real GPU if there is one), ``cpu`` or ``gpu``.
    """

def run_command_line(arguments: list[str]) -> int: ...
def score_json(capture: _Path, maps: _Path, relit: _Path | None = None) -> str: ...
def synth(scene: _Path, out: _Path) -> None: ...
def relight(capture: _Path, maps: _Path, out: _Path) -> Path: ...
def run(suite: _Path, out: _Path) -> Path: ...
def compare(run: _Path, baseline: _Path, tolerances: _Path | None = None) -> bool: ...
def write_report(run: _Path, out: _Path) -> None: ...
def metric_definitions() -> list[tuple[str, str, str, str, str, str]]: ...
def measure(
    metric: str,
    prediction: _Float,
    truth: _Float,
    mask: NDArray[np.bool_] | None = None,
    *,
    erode: bool = False,
    scale: str = "none",
) -> float | None: ...

def exr_channels(path: _Path) -> list[str]:
    """Names of an EXR's channels, from its header; raises ``errors.PictureError``, as all readers here."""

def read_exr(path: _Path, names: list[str] | None = None, *, colour: bool = False, finite: bool = True) -> tuple[list[str], _Float]:
    """Channels (all without ``names``) and their names; (height, width, channels), in the display window."""

def read_colour(path: _Path) -> _Float:
    """EXR or Radiance as linear Rec.709, (height, width, 3)."""

def read_light(path: _Path) -> _Float:
    """As ``read_colour``, lat-long pictures of 2 : 1 alone."""

def read_png(path: _Path) -> _Float:
    """Values from 0 to 1, (height, width, 1 or 3)."""

def read_gray(path: _Path) -> _Byte:
    """8-bit grey PNG, (height, width)."""

def read_ids(path: _Path) -> NDArray[np.uint16]:
    """Samples of a PNG of one channel as they are, (height, width)."""
