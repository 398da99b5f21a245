"""Reads OBJ and glTF files into triangle meshes with one uv per vertex."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from ..face.spec import FaceError
from .gltf_file import read_gltf
from .piece import Piece


def read_pieces(path: Path) -> list[Piece]:
    """All objects of a mesh file in order of their names; quads and polygons become triangles.

    Raises `FaceError` for files without a mesh.
    """
    try:
        pieces = _read_obj(path) if path.suffix.lower() == ".obj" else read_gltf(path)
    except FaceError:
        raise
    except Exception as error:  # whatever a broken file holds
        raise FaceError(f"{path}: cannot be read as a mesh: {_line(error)}; export it again") from error
    pieces = sorted((piece for piece in pieces if len(piece.triangles)), key=lambda piece: piece.name)
    if not pieces:
        raise FaceError(f"{path}: holds no faces; export the mesh with its polygons")
    for piece in pieces:
        if not np.isfinite(piece.vertices).all():
            bad = int((~np.isfinite(piece.vertices).all(axis=1)).sum())
            raise FaceError(f"{path}: {bad} vertices of {piece.name!r} are not finite; remove them")
    return pieces


def _read_obj(path: Path) -> list[Piece]:
    """By the reader that captures have, too."""
    from unshade import _native

    try:
        objects = _native.read_obj(path.read_bytes())
    except ValueError as error:
        raise FaceError(f"{path}: {error}") from error
    return [Piece(*(o[field.name] for field in dataclasses.fields(Piece))) for o in objects]


def _line(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text[:160] or type(error).__name__
