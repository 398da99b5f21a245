"""The training of the paper in PyTorch, recorded for the solver's tests.

    python solver/tests/pytorch/record.py solver/tests/pytorch/recorded.safetensors

Needs numpy and PyTorch, of which the project itself needs only the first; the values in the
repository are those of PyTorch 1.13 (Debian's package) on x86-64. Written from the paper's
sections 4 and 5, so that it shares neither code nor mistakes with the solver: layers, textures,
gradients and optimiser are the framework's own. What the paper leaves open (the scale of the depth
derivative, the borders of the blur) is as the solver documents it.

The scene is small and rendered here: three views of a bumpy ball in coloured light, which the
model cannot explain fully. Everything is computed in double precision from inputs of single
precision. Every stage starts from the recorded state, so that rounding does not add up. Texels
start as noise: on plateaus the prior's slope would be the sign of a rounding error.
"""

from __future__ import annotations

import argparse
import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import nn
from torch.nn import functional

PICTURE, WARM_SIZE, FINE_SIZE = 22, 16, 24
WARM_STEPS, FINE_STEPS = 50, 25
F0, PRIOR, RATE = 0.04, 0.3, 1e-3
DEVIATION_RANGE, DEVIATION_BLUR = 0.5, 0.05
"""The blur's standard deviation is a share of the texture's side; wider than the solver's default,
for these few texels to feel it."""
WEIGHT_BLUR, EDGE_SLOPE = 2.0, 10.0

Arrays = dict[str, np.ndarray]
State = dict[str, torch.Tensor]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    torch.manual_seed(4)
    arrays = scene()
    double, single = (Training(arrays, kind) for kind in (torch.float64, torch.float32))
    state = initial_state()
    stages = []
    keep(arrays, 0, state)
    plan = [("warm_up", WARM_STEPS)] + 2 * [("relief", FINE_STEPS), ("diffuse", FINE_STEPS)]
    for number, (kind, steps) in enumerate(plan):
        run = getattr(Training, kind)
        if number == 1:
            # Before the fine-tuning, the textures grow.
            state = {key: resized(value) for key, value in state.items()}
            keep(arrays, 1, state)
        after, losses = run(double, state, steps)
        _, rough = run(single, state, steps)
        difference = max(abs(a / b - 1) for a, b in zip(rough, losses))
        print(f"{kind}: {losses[0]:.6f} to {losses[-1]:.6f}; in single precision within {difference:.1e}")
        state = after
        last = "warm" if kind == "warm_up" else number + 1
        keep(arrays, last, state)
        stages.append({"kind": kind, "from": number, "to": last, "losses": losses})
    notes = {"stages": stages, "torch": torch.__version__, "deviation_blur": DEVIATION_BLUR, "prior": PRIOR}
    write(out, arrays, notes)


def keep(arrays: Arrays, number: int | str, state: State) -> None:
    """Adds a state; the networks only where they are new."""
    for key, value in state.items():
        if key != "networks" or number in (0, "warm"):
            arrays[f"{number}.{key}"] = value.numpy()


def scene() -> Arrays:
    """Positions, normals, views, UV, depths and colours of three pictures of a ball."""
    pictures: dict[str, list[np.ndarray]] = {}
    focal = 2.6 * PICTURE / 2
    for number, eye in enumerate([(-0.9, 0.3, 2.6), (0.1, -0.2, 3.0), (1.1, 0.4, 2.5)]):
        eye = np.array(eye)
        back = eye / np.linalg.norm(eye)
        right = np.cross([0, 1, 0], back)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back], 1)
        row, column = np.mgrid[:PICTURE, :PICTURE] + 0.5
        local = np.stack([(column - PICTURE / 2) / focal, (PICTURE / 2 - row) / focal, -np.ones_like(row)], -1)
        rays = local @ axes.T
        length = np.linalg.norm(rays, axis=-1)
        unit = rays / length[..., None]
        along = -(unit @ eye)
        root = along**2 - eye @ eye + 1
        distance = along - np.sqrt(np.maximum(root, 0))
        position = eye + distance[..., None] * unit
        hit = (root > 0) & (position[..., 2] > 0.15)
        bumps = 0.15 * np.sin(7 * position + [0, 1, 2])
        normal = position + bumps
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        light = np.maximum(normal @ [0.5, 0.5, 0.7], 0)[..., None] * [1.0, 0.9, 0.8] + 0.2 * (1 + normal[..., 1:2]) * [
            0.5,
            0.6,
            0.9,
        ]
        half = unit * -1 + [0.5, 0.5, 0.7]
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        shine = 0.4 * np.maximum((normal * half).sum(-1), 0) ** 40
        tone = np.where(np.sin(9 * position[..., :1]) > 0, [0.6, 0.4, 0.3], [0.3, 0.2, 0.15])
        colour = tone * light + shine[..., None]
        parts = {
            "pixel": np.flatnonzero(hit).astype(np.float32), "position": position[hit], "normal": normal[hit], "view": -unit[hit],
            "uv": 0.5 + 0.45 * position[hit][:, :2], "depth": (distance / length)[hit], "colour": colour[hit],
            "number": np.full(hit.sum(), number),
        }  # fmt: skip
        for key, value in parts.items():
            pictures.setdefault(key, []).append(value)
    return {key: np.concatenate(parts).astype(np.float32) for key, parts in pictures.items()}


def initial_state() -> State:
    """Weights as the framework's layers have them at first, textures as noise; single precision."""
    layers = [layer for _ in range(3) for layer in (nn.Linear(3, 16), nn.Linear(16, 16), nn.Linear(16, 8))]
    return {
        "networks": torch.cat([p.detach().reshape(-1) for layer in layers for p in (layer.weight, layer.bias)]),
        "diffuse": 0.2 + 0.3 * torch.rand(WARM_SIZE, WARM_SIZE, 3),
        "specular": 0.01 + 0.04 * torch.rand(WARM_SIZE, WARM_SIZE, 1),
        "deviation": torch.zeros(WARM_SIZE, WARM_SIZE, 3),
    }


def resized(texture: torch.Tensor) -> torch.Tensor:
    if texture.dim() < 3:
        return texture
    image = texture.double().permute(2, 0, 1)[None]
    size = (FINE_SIZE, FINE_SIZE)
    return (
        functional.interpolate(image, size, mode="bilinear", align_corners=False)[0]
        .permute(1, 2, 0)
        .float()
        .contiguous()
    )


def view_weights(arrays: Arrays) -> np.ndarray:
    """Cosine times the inverse blurred depth derivative (section 5.3); mean 1."""
    reach = int(np.ceil(3 * WEIGHT_BLUR))
    tap = np.exp(-0.5 * (np.arange(-reach, reach + 1) / WEIGHT_BLUR) ** 2)

    def blurred(plane: np.ndarray) -> np.ndarray:
        smooth = lambda line: np.convolve(line, tap)[reach:-reach]
        return np.apply_along_axis(smooth, 0, np.apply_along_axis(smooth, 1, plane))

    weights = []
    for number in np.unique(arrays["number"]):
        chosen = arrays["number"] == number
        at = np.unravel_index(arrays["pixel"][chosen].astype(int), (PICTURE, PICTURE))
        depth = np.full((PICTURE + 2, PICTURE + 2), np.nan)
        depth[at[0] + 1, at[1] + 1] = arrays["depth"][chosen]
        across, down = (depth[1:-1, 2:] - depth[1:-1, :-2]) / 2, (depth[2:, 1:-1] - depth[:-2, 1:-1]) / 2
        slope = np.hypot(across, down) * (2.6 * PICTURE / 2) / depth[1:-1, 1:-1]
        slope = np.minimum(np.where(np.isnan(slope), EDGE_SLOPE, slope), EDGE_SLOPE)
        covered = ~np.isnan(depth[1:-1, 1:-1])
        mean = blurred(np.where(covered, slope, 0)) / np.maximum(blurred(covered.astype(float)), 1e-12)
        cosine = (arrays["normal"][chosen].astype(float) * arrays["view"][chosen]).sum(-1).clip(0, 1)
        weights.append(cosine / (1 + mean[at]))
    joined = np.concatenate(weights)
    return joined / joined[joined > 0].mean()


class Training:
    """The stages of the optimisation on one scene, in one precision."""

    def __init__(self, arrays: Arrays, kind: torch.dtype) -> None:
        tensor = lambda values: torch.tensor(np.asarray(values, np.float64)).to(kind)
        weight = view_weights(arrays)
        used = weight > 0
        low, high = arrays["position"].min(0).astype(float), arrays["position"].max(0).astype(float)
        self.kind = kind
        self.position = tensor((arrays["position"] - (low + high) / 2) / (0.5 * (high - low).max()))[used]
        self.normal, self.view, self.colour = (tensor(arrays[key])[used] for key in ("normal", "view", "colour"))
        self.weight = tensor(weight)[used, None]
        u, v = tensor(arrays["uv"])[used].T
        self.grid = torch.stack([2 * u - 1, 1 - 2 * v], -1)[None, None]
        cosine = (self.normal * self.view).sum(-1, keepdim=True).clamp(0, 1)
        self.fresnel = F0 + (1 - F0) * (1 - cosine) ** 5

    def warm_up(self, state: State, steps: int) -> tuple[State, list[float]]:
        """Networks and both albedos together (section 4.3.1)."""

        def loss(s: State) -> torch.Tensor:
            directions = self.normal, reflected(self.view, self.normal)
            light = self.network(s, 0, self.position).exp()
            return self.error(s, *self.shading(s, light, *directions)) + prior(s["diffuse"])

        return self.adam(state, ("networks", "diffuse", "specular"), loss, steps)

    def relief(self, state: State, steps: int) -> tuple[State, list[float]]:
        """Specular albedo and deviation, all else frozen (section 4.3.2)."""
        light = self.network(self.cast(state), 0, self.position).exp()
        return self.adam(state, ("specular", "deviation"), lambda s: self.error(s, *self.bent_shading(s, light)), steps)

    def diffuse(self, state: State, steps: int) -> tuple[State, list[float]]:
        """The diffuse albedo, under frozen shading."""
        frozen = self.cast(state)
        shading = self.bent_shading(frozen, self.network(frozen, 0, self.position).exp())
        return self.adam(state, ("diffuse",), lambda s: self.error(s, *shading), steps)

    def cast(self, state: State) -> State:
        return {key: value.to(self.kind) for key, value in state.items()}

    def adam(
        self, state: State, moved: tuple[str, ...], loss: Callable[[State], torch.Tensor], steps: int
    ) -> tuple[State, list[float]]:
        """The state afterwards, in single precision, and the loss before every step."""
        work = self.cast(state)
        leaves = [work[key].clone().requires_grad_() for key in moved]
        work |= dict(zip(moved, leaves))
        optimiser = torch.optim.Adam(leaves, lr=RATE)
        losses = []
        for _ in range(steps):
            optimiser.zero_grad()
            value = loss(work)
            value.backward()
            optimiser.step()
            losses.append(value.item())
        return {key: value.detach().float() for key, value in work.items()}, losses

    def network(self, state: State, number: int, values: torch.Tensor) -> torch.Tensor:
        """3-16-16-8 with ReLU between the layers, before the last activation."""
        rest = state["networks"].reshape(3, -1)[number]
        for layer, (inputs, outputs) in enumerate([(3, 16), (16, 16), (16, 8)]):
            weight, bias, rest = rest.split([inputs * outputs, outputs, len(rest) - (inputs + 1) * outputs])
            values = functional.linear(
                functional.relu(values) if layer else values, weight.reshape(outputs, inputs), bias
            )
        return values

    def shading(
        self, state: State, light: torch.Tensor, normal: torch.Tensor, reflection: torch.Tensor
    ) -> tuple[torch.Tensor, ...]:
        """S_d, and F A_s S_s."""
        diffuse = (light * functional.softplus(self.network(state, 1, normal))).sum(-1, keepdim=True)
        specular = (light * functional.softplus(self.network(state, 2, reflection))).sum(-1, keepdim=True)
        return diffuse, self.fresnel * self.sampled(state["specular"]) * specular

    def bent_shading(self, state: State, light: torch.Tensor) -> tuple[torch.Tensor, ...]:
        """The same with the deviation texture added to the mesh normal, blurred for the diffuse one."""
        deviation = DEVIATION_RANGE * torch.tanh(state["deviation"])
        sharp = functional.normalize(self.normal + self.sampled(deviation), dim=-1)
        soft = functional.normalize(self.normal + self.sampled(blurred(deviation)), dim=-1)
        return self.shading(state, light, soft, reflected(self.view, sharp))

    def error(self, state: State, diffuse: torch.Tensor, specular: torch.Tensor) -> torch.Tensor:
        """Weighted L1."""
        return (self.weight * (self.sampled(state["diffuse"]) * diffuse + specular - self.colour).abs()).mean()

    def sampled(self, texture: torch.Tensor) -> torch.Tensor:
        image = texture.permute(2, 0, 1)[None]
        return functional.grid_sample(image, self.grid, mode="bilinear", padding_mode="border", align_corners=False)[
            0, :, 0
        ].T


def reflected(view: torch.Tensor, normal: torch.Tensor) -> torch.Tensor:
    return 2 * (view * normal).sum(-1, keepdim=True) * normal - view


def prior(albedo: torch.Tensor) -> torch.Tensor:
    """Equation (2), averaged over texels and channels."""
    steps = albedo[1:] - albedo[:-1], albedo[:, 1:] - albedo[:, :-1]
    return PRIOR * sum(((1 + step.abs()).sqrt() - 1).sum() for step in steps) / albedo.numel()


def blurred(texture: torch.Tensor) -> torch.Tensor:
    """Gaussian, over three standard deviations, of what lies inside the texture."""
    sigma = DEVIATION_BLUR * texture.shape[0]
    reach = int(np.ceil(3 * sigma))
    tap = torch.exp(-0.5 * (torch.arange(-reach, reach + 1, dtype=texture.dtype) / sigma) ** 2)
    kernel = (tap[:, None] * tap).expand(3, 1, -1, -1)
    image = texture.permute(2, 0, 1)[None]
    smooth = lambda values: functional.conv2d(values, kernel, padding=reach, groups=3)
    return (smooth(image) / smooth(torch.ones_like(image)))[0].permute(1, 2, 0)


def write(path: Path, arrays: Arrays, notes: dict) -> None:
    """A safetensors file: length of the header, the header as JSON, the values as float32."""
    header: dict[str, dict] = {"__metadata__": {key: json.dumps(value) for key, value in notes.items()}}
    content = b""
    for name, array in arrays.items():
        data = np.ascontiguousarray(array, "<f4").tobytes()
        header[name] = {
            "dtype": "F32",
            "shape": list(array.shape),
            "data_offsets": [len(content), len(content) + len(data)],
        }
        content += data
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    path.write_bytes(struct.pack("<Q", len(text)) + text + content)


if __name__ == "__main__":
    main()
