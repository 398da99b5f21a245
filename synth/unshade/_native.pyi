"""The compiled core; use it through :mod:`unshade`."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import ClassVar, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Capture",
    "Maps",
    "__version__",
    "adopt",
    "begin_folder",
    "check_json",
    "check_worker",
    "commit_folder",
    "compare",
    "depth_of",
    "export",
    "exr_channels",
    "measure",
    "metric_definitions",
    "mikktspace",
    "outward_turns",
    "read_colour",
    "read_exr",
    "read_gray",
    "read_ids",
    "read_light",
    "read_obj",
    "read_png",
    "read_scores",
    "reader_sources",
    "relight",
    "report",
    "run",
    "run_command_line",
    "budget",
    "run_part",
    "score_json",
    "shown",
    "study_json",
    "skin_reflected",
    "solve",
    "synth",
    "write_colour",
    "write_scores",
]

_Path = str | os.PathLike[str]
_Float = NDArray[np.float32]
_Byte = NDArray[np.uint8]
_Progress = Callable[[int, int, str], object]

__version__: str
reader_sources: str

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

@final
class Capture:
    """A capture folder, opened and checked; raises ``errors.CaptureError``. A pickle holds the path."""

    def __new__(cls, path: _Path) -> Capture: ...
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
        """The mesh at the pixel centres of any view: positions (metres) and unit normals
        (height, width, 3), uvs (height, width, 2); NaN where it sees nothing of it."""
    def shading(
        self,
        light: ArrayLike,
        *,
        texture_size: int = 128,
        nearness: float = 0.0,
        bounces: int = 2,
        bounce_albedo: float = 0.4,
    ) -> _Float:
        """The diffuse shading (N, N, 3) of the mesh in an environment (rows, 2 rows, 3), lat-long
        as ``truth/light.exr``, on a sphere of 1 / ``nearness`` metres, with the mesh's own shadows
        and bounces: 1 for radiance 1 from everywhere. A diffuse layer is albedo times shading."""
    def project(self, pictures: dict[str, ArrayLike], size: int) -> tuple[_Float, _Byte]:
        """Pictures (height, width, 3) of training views by name as a texture (size, size, 3): the mean of
        what they show at a texel, weighted by the cosine, and 255 where one of them shows it."""
    def truth(self) -> Maps:
        """The true maps of a synthetic capture."""

@final
class Maps:
    """Square reflectance maps of one size; what a solver does not recover is None.

    A map may be given as anything numpy makes a float array of; it is kept as float32. Reading one
    gives a view that cannot be written to, without a copy; assign a new array to change a map. A
    map of another size than the others, with other channels, or with NaN where there is coverage
    (anywhere without one) raises ``errors.MapsError``, which names it. Maps with equal values are
    equal, wherever a solve was stopped.
    """

    def __new__(
        cls,
        *,
        diffuse_albedo: ArrayLike | None = None,
        specular_albedo: ArrayLike | None = None,
        diffuse_normal: ArrayLike | None = None,
        specular_normal: ArrayLike | None = None,
        confidence: ArrayLike | None = None,
        roughness: ArrayLike | None = None,
        coverage: ArrayLike | None = None,
    ) -> Maps: ...
    @property
    def diffuse_albedo(self) -> _Float | None:
        """(size, size, 3) linear Rec.709 reflectance."""
    @diffuse_albedo.setter
    def diffuse_albedo(self, array: ArrayLike | None) -> None: ...
    @property
    def specular_albedo(self) -> _Float | None:
        """(size, size) reflectance at normal incidence, 0 to 0.05."""
    @specular_albedo.setter
    def specular_albedo(self, array: ArrayLike | None) -> None: ...
    @property
    def diffuse_normal(self) -> _Float | None:
        """(size, size, 3) unit vectors in object space."""
    @diffuse_normal.setter
    def diffuse_normal(self, array: ArrayLike | None) -> None: ...
    @property
    def specular_normal(self) -> _Float | None:
        """(size, size, 3) unit vectors in object space."""
    @specular_normal.setter
    def specular_normal(self, array: ArrayLike | None) -> None: ...
    @property
    def confidence(self) -> _Float | None:
        """(size, size) 0 to 1: the solver's own trust in the diffuse albedo."""
    @confidence.setter
    def confidence(self, array: ArrayLike | None) -> None: ...
    @property
    def roughness(self) -> _Float | None:
        """(size, size, 3) GGX alphas of the two lobes, and the share of the first."""
    @roughness.setter
    def roughness(self, array: ArrayLike | None) -> None: ...
    @property
    def coverage(self) -> _Byte | None:
        """(size, size) 255 where a map had data; booleans become 0 and 255."""
    @coverage.setter
    def coverage(self, array: ArrayLike | None) -> None: ...
    @property
    def size(self) -> int | None:
        """Texels along a side; None without any map."""
    def __eq__(self, value: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]
    @property
    def interrupted(self) -> str | None:
        """Where the solve was stopped; None if it came to its end."""
    @staticmethod
    def read(path: _Path) -> Maps:
        """Read whatever maps the folder has."""
    def write(self, path: _Path, *, light: ArrayLike | None = None) -> None:
        """Write the folder, completely or not at all. Texels without coverage that hold no number
        are written as 0. ``light``, if the method recovers one, is written as ``light.exr``: radiance
        (rows, 2 rows, 3) of an environment at infinity, lat-long as ``truth/light.exr``, in the exposure in
        which the maps reproduce the photographs; the maps are then relit in it too."""

def solve(
    capture: Capture | _Path,
    *,
    config: str = "unshade",
    out: _Path | None = None,
    progress: Callable[[str, int, int, float], object] | None = None,
    backend: str = "auto",
) -> Maps:
    """Recover maps from a capture or its folder; ``config`` is a preset's name or the text of a configuration.

    ``progress(stage, iteration, total, loss)`` hears how it goes. What it raises stops the solve
    and is raised here, as is Ctrl-C; returning ``False`` stops it and returns the maps so far,
    whose ``interrupted`` says where. With ``out`` the whole maps folder is written there, after a
    stop as well; the same call then goes on from there, to the same bytes. ``backend`` is ``auto``
    (a real GPU if there is one), ``cpu`` or ``gpu``.
    """

def run_command_line(arguments: list[str]) -> int: ...
def study_json(runs: list[_Path], out: _Path | None = None) -> tuple[str, str]: ...
def budget(
    capture: _Path,
    maps: _Path,
    out: _Path,
    light: str | None = None,
    view: str | None = None,
    progress: _Progress | None = None,
) -> str: ...
def score_json(capture: _Path, maps: _Path, relit: _Path | None = None, lpips: str | None = None) -> str: ...
def read_scores(path: _Path) -> str: ...
def write_scores(text: str, path: _Path) -> None: ...
def synth(scene: _Path, out: _Path, progress: _Progress | None = None) -> None: ...
def relight(
    capture: _Path, maps: _Path, out: _Path, progress: _Progress | None = None, renderer: str = "mitsuba"
) -> Path: ...
def export(
    maps: _Path,
    out: _Path,
    options: list[str],
    capture: _Path | None = None,
    mesh: _Path | None = None,
    progress: _Progress | None = None,
) -> str: ...
def run(suite: _Path, out: _Path, redo: list[str] = ..., progress: _Progress | None = None, jobs: int = 1) -> Path: ...
def run_part(
    suite: _Path,
    out: _Path,
    stage: str,
    contents: dict[str, str],
    renderer: str,
    key_only: bool,
    processors: list[int] | None,
) -> str: ...
def check_worker(suite: _Path, content: str, versions: str) -> str: ...
def adopt(run: _Path, key: str, stage: str, content: str) -> None: ...
def begin_folder(target: _Path, key: str) -> Path: ...
def commit_folder(target: _Path, key: str) -> None: ...
def report(run: _Path, out: _Path, progress: _Progress | None = None) -> None: ...
def check_json(maps: _Path, capture: _Path | None = None) -> str: ...
def compare(run: _Path, baseline: _Path, tolerances: _Path | None = None) -> bool: ...
def metric_definitions() -> list[tuple[str, str, str, str, str, str, str]]: ...
def measure(
    metrics: list[str],
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: str = "none",
    beside: dict[str, ArrayLike] | None = None,
) -> list[float | None]: ...
def shown(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: str = "none",
) -> list[_Float]: ...
def mikktspace(
    vertices: NDArray[np.float32],
    normals: NDArray[np.float32],
    uv: NDArray[np.float32],
    triangles: NDArray[np.int64],
) -> NDArray[np.float32]:
    """Tangents (F, 3, 4) of a mesh: xyz unit, and the sign of the bitangent; raises ValueError."""

def skin_reflected(
    normals: NDArray[np.float32], views: NDArray[np.float32], lights: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The solver's specular BRDF of skin times the cosine (N,), 1/sr; unit vectors (N, 3); raises ValueError."""

class _Object(TypedDict):
    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    uv: NDArray[np.float64] | None
    normals: NDArray[np.float64] | None
    line_without_uv: int | None

def read_obj(data: bytes) -> list[_Object]:
    """The objects of an OBJ file; raises ValueError with the line."""

def outward_turns(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], normals: NDArray[np.float64] | None = None
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], int]:
    """Triangles and normals to turn so that all face away from the origin, and triangles on one-sided surfaces."""

def depth_of(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    size: tuple[int, int],
    focal: Sequence[float],
    centre: Sequence[float],
    camera_to_world: Sequence[Sequence[float]],
) -> _Float:
    """Depth at every pixel's centre (height, width) for a pinhole of ``size`` (width, height); infinite beside the mesh."""

def exr_channels(path: _Path) -> list[str]:
    """Names of an EXR's channels, from its header; raises ``errors.PictureError``, as all readers here."""

def read_exr(
    path: _Path, names: list[str] | None = None, *, colour: bool = False, finite: bool = True
) -> tuple[list[str], _Float]:
    """Channels (all without ``names``) and their names; (height, width, channels), in the display window."""

def read_colour(path: _Path) -> _Float:
    """EXR or Radiance as linear Rec.709, (height, width, 3)."""

def read_light(path: _Path) -> _Float:
    """As ``read_colour``, lat-long pictures of 2 : 1 alone."""

def write_colour(path: _Path, picture: _Float) -> None:
    """Linear Rec.709 (height, width, 3) as a float EXR; equal pictures give equal bytes."""

def read_png(path: _Path) -> _Float:
    """Values from 0 to 1, (height, width, 1 or 3)."""

def read_gray(path: _Path) -> _Byte:
    """8-bit grey PNG, (height, width)."""

def read_ids(path: _Path) -> NDArray[np.uint16]:
    """Samples of a PNG of one channel as they are, (height, width)."""
