"""Random numbers of one view's image formation."""

from __future__ import annotations

import hashlib

import numpy as np

from ..camera.camera import Camera
from ..scene_file import Scene


def generator(purpose: str, scene: Scene, camera: Camera) -> np.random.Generator:
    """Depends on the purpose, the scene's render seed and the camera's name alone."""
    text = f"{purpose}\0{scene.render.seed}\0{camera.name}"
    return np.random.default_rng(int.from_bytes(hashlib.blake2b(text.encode(), digest_size=8).digest(), "little"))
