"""Plain pictures for any program: PNG of 8 or 16 bits, and the same numbers as float EXR."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..files.obj_text import obj_text
from ..files.pictures import write_exr, write_text
from ..surface import Surface
from . import lobe
from .tangents import mikktspace_normals, with_tangents
from .texture_files import encoded_normals, srgb, write_png

SPECULAR_RANGE = 0.05
"""Specular albedo of a white texel."""


def write_pictures(surface: Surface, folder: Path, bits: int, green_up: bool) -> dict[str, Any]:
    """Writes the set; returns the asset's description."""
    mesh = with_tangents(surface.mesh)
    single = lobe.fit(surface.roughness)
    inside = surface.texels.inside
    normals = {
        name: mikktspace_normals(surface, mesh, values)
        for name, values in (("diffuse_normal", surface.diffuse_normal), ("specular_normal", surface.specular_normal))
    }
    if not green_up:
        normals = {name: values * np.float32([1, -1, 1]) for name, values in normals.items()}
    linear: dict[str, np.ndarray] = {
        "diffuse_albedo": surface.maps.diffuse_albedo,
        "specular_albedo": surface.specular_albedo,
        "roughness": np.sqrt(single.alpha),
        **normals,
    }
    codes = {
        "diffuse_albedo": srgb(linear["diffuse_albedo"]),
        "specular_albedo": linear["specular_albedo"] / SPECULAR_RANGE,
        "roughness": linear["roughness"],
        **{name: encoded_normals(values) for name, values in normals.items()},
    }
    for name, values in linear.items():
        write_png(folder / f"{name}.png", codes[name], bits)
        write_exr(folder / f"{name}.exr", {"Y" if values.ndim == 2 else "": values})
    write_text(folder / "face.obj", obj_text(surface.mesh))
    green = "+Y: green points up the picture" if green_up else "-Y: green points down the picture"
    return {
        "file": "face.obj",
        "bits": bits,
        "diffuse_albedo": "PNG: sRGB codes; EXR: linear Rec.709",
        "specular_albedo": f"PNG: reflectance at normal incidence / {SPECULAR_RANGE}, linear; EXR: reflectance",
        "roughness": "perceptual: the root of the GGX alpha of one lobe in place of two",
        "diffuse_normal, specular_normal": f"tangent space (MikkTSpace) of face.obj, {green}; PNG: n/2 + 1/2; EXR: n",
        "clipped_base_colours": int((surface.maps.diffuse_albedo[inside] > 1).sum()),
        "lobe_energy_misplaced_mean": float(single.misplaced[inside].mean()),
        "lobe_energy_misplaced_largest": float(single.misplaced[inside].max()),
        "left_out": ["second lobe"],
    }
