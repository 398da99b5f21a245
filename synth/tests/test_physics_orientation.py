"""The coordinate probe passes, and names the mistake that is put into the pipeline."""

import numpy as np
import pytest

from unshade.render.physics.orientation import PROBES, Pipeline, check_orientation


def test_everything_lies_where_the_conventions_say():
    verdict = check_orientation()
    assert verdict.ok, verdict.found
    assert all(probe in verdict.found for probe in PROBES)


FAULTS = {
    "flipped rows": (Pipeline(picture=lambda p: p[::-1]), "as with flipped rows"),
    "flipped columns": (Pipeline(picture=lambda p: p[:, ::-1]), "as with flipped columns"),
    "flipped v": (Pipeline(texture=lambda t: t[::-1]), "as with flipped v"),
    "flipped u": (Pipeline(texture=lambda t: t[:, ::-1]), "as with flipped u"),
    "u and v exchanged": (Pipeline(texture=lambda t: t.swapaxes(0, 1)), "as with u and v exchanged"),
    "camera x and y exchanged": (Pipeline(camera=lambda m: m[:, [1, 0, 2, 3]]), "as with camera x and y exchanged"),
    "camera looks along +z": (Pipeline(camera=lambda m: m @ np.diag([1.0, -1, -1, 1])), "nowhere in the picture"),
    "environment rows": (Pipeline(environment=lambda e: e[::-1]), "as with environment's rows flipped"),
    "environment columns": (Pipeline(environment=lambda e: e[:, ::-1]), "as with environment's columns flipped"),
    "environment turned": (Pipeline(environment=lambda e: np.roll(e, 64, 1)), "environment: off by"),
    "environment one texel off": (Pipeline(environment=lambda e: np.roll(e, 1, 1)), "environment: off by 2."),
    "normal x reversed": (Pipeline(normals=lambda n: n * np.float32([-1, 1, 1])), "as with normal map's x reversed"),
    "normal y and z exchanged": (Pipeline(normals=lambda n: n[..., [0, 2, 1]]), "normal map: off by"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_mistake_is_found_and_named(name):
    pipeline, words = FAULTS[name]
    probe = next((probe for probe in PROBES if probe.split()[0] in name.split()), PROBES[0])
    verdict = check_orientation(pipeline, [probe])
    assert not verdict.ok and words in verdict.found, verdict.found
    assert "fix" in verdict.entry()
