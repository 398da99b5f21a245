"""The steps of the paper's optimisation in eager PyTorch, timed; called by `unshade bench`.

Written as one writes it in PyTorch: linear layers, grid_sample, autograd, torch.optim.Adam, single
precision.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
import torch
from torch.nn import functional


def main() -> None:
    given = json.loads(sys.argv[1])
    torch.set_num_threads(given["threads"])
    device = torch.device(given["device"])
    if device.type == "cuda":
        # As on the processor: single precision throughout.
        torch.backends.cuda.matmul.allow_tf32 = torch.backends.cudnn.allow_tf32 = False
    pixels, size = given["pixels"], given["size"]
    rest = torch.from_numpy(np.fromfile(given["file"], "<f4")).to(device)
    lengths = [3 * pixels, 3 * pixels, 3 * pixels, pixels, 3 * pixels, pixels, 2 * pixels, 1416, 3 * size**2, size**2]
    position, normal, view, fresnel, colour, weight, place, networks, diffuse, specular = rest.split(lengths)
    position, normal, view, colour = (part.reshape(pixels, 3) for part in (position, normal, view, colour))
    fresnel, weight = fresnel[:, None], weight[:, None]
    grid = (2 * (place.reshape(1, 1, pixels, 2) + 0.5) / size - 1).contiguous()
    state = {
        "networks": networks.clone(),
        "diffuse": diffuse.reshape(1, size, size, 3).permute(0, 3, 1, 2).contiguous(),
        "specular": specular.reshape(1, 1, size, size).clone(),
        "deviation": torch.zeros(1, 3, size, size, device=device),
    }

    def sampled(texture: torch.Tensor) -> torch.Tensor:
        return functional.grid_sample(texture, grid, mode="bilinear", padding_mode="border", align_corners=False)[
            0, :, 0
        ].T

    def network(number: int, values: torch.Tensor) -> torch.Tensor:
        rest = state["networks"].reshape(3, -1)[number]
        for layer, (inputs, outputs) in enumerate([(3, 16), (16, 16), (16, 8)]):
            matrix, bias, rest = rest.split([inputs * outputs, outputs, len(rest) - (inputs + 1) * outputs])
            values = functional.linear(
                functional.relu(values) if layer else values, matrix.reshape(outputs, inputs), bias
            )
        return values

    def shading(light: torch.Tensor, soft: torch.Tensor, sharp: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        reflected = 2 * (view * sharp).sum(-1, keepdim=True) * sharp - view
        diffuse = (light * functional.softplus(network(1, soft))).sum(-1, keepdim=True)
        specular = (light * functional.softplus(network(2, reflected))).sum(-1, keepdim=True)
        return diffuse, fresnel * specular

    def error(diffuse: torch.Tensor, specular: torch.Tensor) -> torch.Tensor:
        return (weight * (diffuse + specular - colour).abs()).mean()

    def prior() -> torch.Tensor:
        albedo = state["diffuse"]
        steps = albedo[..., 1:, :] - albedo[..., :-1, :], albedo[..., 1:] - albedo[..., :-1]
        return given["prior"] * sum(((1 + step.abs()).sqrt() - 1).sum() for step in steps) / albedo.numel()

    # A wide blur on a coarser texture, as the solver's.
    sigma = given["blur"] * size
    levels = 0
    while sigma >= 4 * 2**levels and size % 2 ** (levels + 1) == 0:
        levels += 1
    sigma = (sigma**2 - (4**levels - 1) / 2) ** 0.5 / 2**levels
    reach = int(np.ceil(3 * sigma))
    tap = torch.exp(-0.5 * (torch.arange(-reach, reach + 1, device=device) / sigma) ** 2)
    half = torch.tensor([0.25, 0.75, 0.75, 0.25], device=device)

    def separable(texture: torch.Tensor, weights: torch.Tensor, stride: int) -> torch.Tensor:
        channels, reach = texture.shape[1], (len(weights) - 1) // 2 if stride == 1 else 0
        across, down = weights.expand(channels, 1, 1, -1), weights[:, None].expand(channels, 1, -1, 1)
        texture = functional.conv2d(texture, across, stride=(1, stride), padding=(0, reach), groups=channels)
        return functional.conv2d(texture, down, stride=(stride, 1), padding=(reach, 0), groups=channels)

    def smooth(texture: torch.Tensor) -> torch.Tensor:
        for _ in range(levels):
            texture = separable(functional.pad(texture, (1, 1, 1, 1), mode="replicate"), half, 2)
        texture = separable(texture, tap, 1)
        for _ in range(levels):
            texture = functional.interpolate(texture, scale_factor=2, mode="bilinear", align_corners=False)
        return texture

    norm = smooth(torch.ones(1, 3, size, size, device=device))

    def warm_up() -> torch.Tensor:
        light = network(0, position).exp()
        diffuse, specular = shading(light, normal, normal)
        return error(sampled(state["diffuse"]) * diffuse, sampled(state["specular"]) * specular) + prior()

    def bent(light: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        deviation = given["range"] * torch.tanh(state["deviation"])
        sharp = functional.normalize(normal + sampled(deviation), dim=-1)
        soft = functional.normalize(normal + sampled(smooth(deviation) / norm), dim=-1)
        return shading(light, soft, sharp)

    with torch.no_grad():
        light = network(0, position).exp()
        albedo = sampled(state["diffuse"])
        frozen = bent(light)
        specular_layer = sampled(state["specular"]) * frozen[1]

    def normals() -> torch.Tensor:
        diffuse, specular = bent(light)
        return error(albedo * diffuse, sampled(state["specular"]) * specular)

    def diffuse_alone() -> torch.Tensor:
        return error(sampled(state["diffuse"]) * frozen[0], specular_layer)

    loss, moved = {
        "warm-up": (warm_up, ("networks", "diffuse", "specular")),
        "normals": (normals, ("specular", "deviation")),
        "diffuse": (diffuse_alone, ("diffuse",)),
    }[given["kind"]]
    for key in moved:
        state[key] = state[key].clone().requires_grad_()
    optimiser = torch.optim.Adam([state[key] for key in moved], lr=given["rate"])
    losses, times = [], []
    for _ in range(given["steps"]):
        begin = time.perf_counter()
        optimiser.zero_grad()
        value = loss()
        value.backward()
        optimiser.step()
        if device.type == "cuda":
            torch.cuda.synchronize()
        times.append(time.perf_counter() - begin)
        losses.append(value.item())
    if device.type == "cuda":
        peak = torch.cuda.max_memory_allocated()
    else:
        # Not getrusage's, which counts what the process before `exec` had.
        status = Path("/proc/self/status").read_text(encoding="ascii")
        peak = 1024 * int(status.split("VmHWM:")[1].split()[0])
    print(
        json.dumps(
            {"milliseconds": 1e3 * min(times), "losses": losses, "peak_memory": peak, "version": torch.__version__}
        )
    )


main()
