"""The resolved scene file: one TOML text with all that a capture depends on."""

from .captured_mesh import CapturedMesh
from .face import AnyHead
from .formation import Formation
from .labels import LabelFaults
from .light import LIGHT_KINDS, Light
from .render import VARIANTS, Render, passes_for
from .rig import RIG_KINDS, Rig
from .scene import FORMAT, Scene, parse_scene, read_scene, read_table

__all__ = [
    "FORMAT", "LIGHT_KINDS", "RIG_KINDS", "VARIANTS", "AnyHead", "CapturedMesh", "Formation", "LabelFaults", "Light", "Render", "Rig",
    "Scene", "parse_scene", "passes_for", "read_scene", "read_table",
]  # fmt: skip
