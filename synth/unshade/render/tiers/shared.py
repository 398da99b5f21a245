"""Bakes and media that several pictures share, kept as long as the head or light they belong to.

The irradiance depends on the head's albedo through interreflection, and so does the
medium: both are made anew after `HeadScene.set_diffuse_albedo`.
"""

from __future__ import annotations

import hashlib
import weakref

import mitsuba as mi
import numpy as np

from ...scene_file import Render
from ..scene import HeadScene, LitHead
from . import diffusion, volume
from .surface import SkinPoints

_baked: weakref.WeakKeyDictionary[LitHead, tuple[tuple, diffusion.BakedIrradiance]] = weakref.WeakKeyDictionary()
_points: weakref.WeakKeyDictionary[HeadScene, SkinPoints] = weakref.WeakKeyDictionary()
_flesh: weakref.WeakKeyDictionary[HeadScene, tuple[bytes, volume.Flesh]] = weakref.WeakKeyDictionary()


def baked(head: HeadScene, lit: LitHead, render: Render, seed: int, progress=None) -> diffusion.BakedIrradiance:
    """The latest bake in this light, if nothing it depends on has changed."""
    key = (_albedo_key(head), render.samples, render.depth, render.subsurface_mm, seed)
    kept = _baked.get(lit)
    if kept is None or kept[0] != key:
        if head not in _points:
            _points[head] = SkinPoints.of(head)
        kept = _baked[lit] = (key, diffusion.bake(head, lit, _points[head], render, seed, progress))
    return kept[1]


def flesh(head: HeadScene) -> volume.Flesh:
    """The head as a closed body with its albedo."""
    key = _albedo_key(head)
    kept = _flesh.get(head)
    if kept is None or kept[0] != key:
        kept = _flesh[head] = (key, volume.Flesh.of(head))
    return kept[1]


def _albedo_key(head: HeadScene) -> bytes:
    albedo = np.array(mi.traverse(head.skin)["diffuse.data"])
    return hashlib.blake2b(albedo.tobytes(), digest_size=16).digest()
