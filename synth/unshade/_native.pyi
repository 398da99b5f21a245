"""The compiled core; use it through :mod:`unshade`."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .maps import Maps

__all__ = [
    "Capture",
    "__version__",
    "adopt",
    "coverage_array",
    "judged_rows_json",
    "map_array",
    "picture_array",
    "read_maps",
    "subjects",
    "write_exr",
    "write_maps",
    "begin_folder",
    "check_worker",
    "command",
    "commit_folder",
    "depth_of",
    "examine_layout",
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
    "run_command_line",
    "run_remote_stage",
    "score_json",
    "shown",
    "shown_json",
    "skin_reflected",
    "solve",
    "sources",
    "write_colour",
    "write_scores",
]

_Path = str | os.PathLike[str]
_Float = NDArray[np.float32]
_Byte = NDArray[np.uint8]
_Progress = Callable[[int, int, str], object]

__version__: str
sources: dict[str, str]
subjects: list[str]

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
        """Return (height, width, 3) linear radiance of a view. That of a withheld view is its
        photograph, or part of the truth; raises ``errors.CaptureError`` where the capture comes without it."""
    def mask(self, name: str) -> _Byte:
        """Return (height, width) of any view, 255 where the mesh is the first surface."""
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
        """Return the true maps of a synthetic capture. Raises ``errors.MapsError`` without a truth."""
    def _repr_html_(self) -> str: ...

def solve(
    capture: Capture,
    config: str,
    is_text: bool,
    out: _Path | None = None,
    progress: Callable[[str, int, int, float], object] | None = None,
    backend: str = "auto",
    given: list[str] = ...,
) -> tuple[dict[str, NDArray[Any]], str | None]: ...
def read_maps(path: _Path) -> tuple[dict[str, NDArray[Any]], str | None]: ...
def write_maps(maps: dict[str, NDArray[Any]], path: _Path, light: ArrayLike | None = None) -> None: ...
def map_array(name: str, value: ArrayLike) -> _Float: ...
def coverage_array(value: ArrayLike) -> _Byte: ...
def picture_array(name: str, value: ArrayLike) -> _Float: ...
def write_exr(path: _Path, picture: _Float, names: list[str]) -> None: ...
def shown_json(capture: _Path, maps: _Path, relit: _Path | None = None, factor: float | None = None) -> str: ...
def judged_rows_json(capture: _Path, shown: str, metric: str, values: list[float | None]) -> str: ...
def command(request: str, progress: _Progress | None = None) -> str: ...
def run_command_line(arguments: list[str]) -> int: ...
def score_json(capture: _Path, maps: _Path, relit: _Path | None = None, lpips: str | None = None) -> str: ...
def read_scores(path: _Path) -> str: ...
def write_scores(text: str, path: _Path) -> None: ...
def run_remote_stage(
    suite: _Path,
    out: _Path,
    stage: str,
    contents: str,
    renderer: dict[str, str],
    key_only: bool,
    processors: list[int] | None,
) -> str: ...
def check_worker(suite: _Path, content: str, versions: str) -> dict[str, str]: ...
def adopt(run: _Path, key: str, stage: str, record: str) -> None: ...
def begin_folder(target: _Path, key: str) -> Path: ...
def commit_folder(target: _Path, key: str) -> None: ...
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
    parts: list[str]
    part_of: NDArray[np.int64]

def read_obj(data: bytes) -> list[_Object]:
    """The objects of an OBJ file; raises ValueError with the line."""

def examine_layout(
    vertices: NDArray[np.float64],
    uv: NDArray[np.float64],
    triangles: NDArray[np.int64],
    part_of: NDArray[np.int64],
    parts: Sequence[str],
) -> tuple[str | None, str | None, bool, int]:
    """Return the fault of a UV layout and a warning, each a text or None, whether the fault is that several of
    ``parts``, numbered by ``part_of`` (F,), lie over each other on one page, and the number of islands that hold most
    of the area (0 with a fault)."""

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
    """Lat-long pictures of 2 : 1, as linear Rec.709."""

def write_colour(path: _Path, picture: _Float) -> None:
    """Linear Rec.709 (height, width, 3) as a float EXR; equal pictures give equal bytes."""

def read_png(path: _Path) -> _Float:
    """Values from 0 to 1, (height, width, 1 or 3)."""

def read_gray(path: _Path) -> _Byte:
    """8-bit grey PNG, (height, width)."""

def read_ids(path: _Path) -> NDArray[np.uint16]:
    """Samples of a PNG of one channel as they are, (height, width)."""
