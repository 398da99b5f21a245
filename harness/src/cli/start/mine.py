"""Lambert's law under one grey light of nine spherical harmonics, divided out of the mean colour of each texel."""

import numpy as np
from numpy.typing import NDArray

import unshade

Array = NDArray[np.float64]


def harmonics(normal: Array) -> Array:
    """Returns the nine harmonics of order 0 to 2, (n, 9), without their constants, which the light absorbs."""
    x, y, z = normal.T
    return np.stack([np.ones_like(x), x, y, z, x * y, y * z, z * x, x * x - y * y, 3 * z * z - 1], -1)


def recover(capture: unshade.Capture, size: int = 128) -> unshade.Maps:
    """Returns maps of `size` x `size` texels, few enough that most of them are seen by a pixel."""
    colour, normal, weight = np.zeros((size * size, 3)), np.zeros((size * size, 3)), np.zeros(size * size)
    for name in capture.train:
        mesh = capture.gbuffer(name)  # the mesh at each pixel's centre; NaN outside it
        inside = (capture.mask(name) > 127) & np.isfinite(mesh["uvs"]).all(-1)
        eye = capture.camera(name)["camera_to_world"][:3, 3]
        to_eye = eye - mesh["positions"][inside]
        to_eye /= np.linalg.norm(to_eye, axis=-1, keepdims=True)
        cosine = np.clip((to_eye * mesh["normals"][inside]).sum(-1), 0, 1)
        u, v = np.clip(mesh["uvs"][inside].T, 0, 0.9999)
        texel = (size - 1 - (v * size).astype(int)) * size + (u * size).astype(int)  # row 0 lies at v = 1
        np.add.at(colour, texel, cosine[:, None] * capture.image(name)[inside])
        np.add.at(normal, texel, cosine[:, None] * mesh["normals"][inside])
        np.add.at(weight, texel, cosine)

    seen = weight > 0
    colour[seen] /= weight[seen, None]
    normal[seen] /= np.linalg.norm(normal[seen], axis=-1, keepdims=True)
    grey = colour[seen].mean(-1)
    light: Array = np.linalg.pinv(harmonics(normal[seen])) @ grey  # least squares, as if skin had one albedo
    shading = np.maximum(harmonics(normal[seen]) @ light, 0.3 * grey.mean())
    # Lights are scaled so that the largest shading of the face's front is 1.
    albedo = np.zeros_like(colour)
    albedo[seen] = np.clip(colour[seen] / (shading / np.percentile(shading, 99))[:, None], 0, 1)

    # Texels are scored at the truth's size: those without data are filled from their neighbours.
    maps, known = [layer.reshape(size, size, 3) for layer in (albedo, normal)], seen.reshape(size, size).copy()
    while not known.all():
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            new = np.roll(known, step, axis) & ~known
            for layer in maps:
                layer[new] = np.roll(layer, step, axis)[new]
            known |= new
    return unshade.Maps(diffuse_albedo=maps[0], diffuse_normal=maps[1], coverage=seen.reshape(size, size))
