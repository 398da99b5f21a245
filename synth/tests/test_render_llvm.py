"""Which LLVM is taken, and what happens where none works."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from unshade.errors import VariantError
from unshade.render import cuda, llvm
from unshade.render.llvm import Candidate, Probe
from unshade.render.physics import child as children
from unshade.render.physics.variants import check_variants


@pytest.fixture
def system(tmp_path):
    """A root folder with system libraries of several ages."""
    for name in (
        "usr/lib/x86_64-linux-gnu/libLLVM-15.so.1", "usr/lib/x86_64-linux-gnu/libLLVM.so.19.1",
        "usr/lib/llvm-22/lib/libLLVM.so.22.1", "usr/lib/x86_64-linux-gnu/libLLVM-14.so",
    ):  # fmt: skip
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path


def test_the_order_is_named_then_packaged_then_newest_of_the_system(system, monkeypatch):
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "/mine/libLLVM.so")
    found = list(llvm.candidates(system))
    assert found[0] == Candidate(Path("/mine/libLLVM.so"), "DRJIT_LIBLLVM_PATH")
    assert found[1].origin == llvm.PACKAGE and found[1].path.is_file()
    # 14 and 15, which abort the process, are never tried by themselves.
    assert [c.path.name for c in found[2:]] == ["libLLVM.so.22.1", "libLLVM.so.19.1"]
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH")
    assert next(llvm.candidates(system)).origin == llvm.PACKAGE


def pretend(monkeypatch, *probes):
    results = {probe.path: probe for probe in probes}
    monkeypatch.setattr(llvm, "candidates", lambda: [Candidate(Path(p.path), p.origin) for p in probes])
    monkeypatch.setattr(llvm, "probe", lambda candidate: results[str(candidate.path)])


BAD = Probe("/bad.so", "DRJIT_LIBLLVM_PATH", None, "exit status -6: Cannot select: fminimum")
GOOD = Probe("/good.so", "system", "19.1.0")


def test_a_library_that_fails_is_passed_over_aloud(monkeypatch):
    pretend(monkeypatch, BAD, GOOD)
    choice = llvm.choose()
    assert choice.variant == "llvm_ad_rgb" and choice.llvm == GOOD
    assert "/bad.so" in choice.warning and "fminimum" in choice.warning


def test_without_a_library_the_fallback_is_announced_with_the_fix(monkeypatch):
    pretend(monkeypatch, BAD)
    choice = llvm.choose()
    assert choice.variant == "scalar_rgb" and choice.llvm is None
    assert "fminimum" in choice.warning and llvm.FIX in choice.warning


@pytest.mark.parametrize(
    ("gpu", "requested", "variant", "warning"),
    [
        (cuda.Gpu(True), "auto", "cuda_ad_rgb", None),
        (cuda.Gpu(True), "cpu", "llvm_ad_rgb", None),
        (cuda.Gpu(True), "llvm_ad_rgb", "llvm_ad_rgb", None),
        (cuda.Gpu(False, "no device"), "auto", "llvm_ad_rgb", None),
        (
            cuda.Gpu(True, "OptiX is missing"),
            "auto",
            "llvm_ad_rgb",
            "traces nothing.*OptiX is missing; install an NVIDIA",
        ),
    ],
)
def test_auto_takes_a_gpu_that_traces(monkeypatch, gpu, requested, variant, warning):
    pretend(monkeypatch, GOOD)
    monkeypatch.setattr(cuda, "probe", lambda: gpu)
    choice = llvm.choose(requested)
    assert choice.variant == variant and (choice.llvm is None) == (variant == "cuda_ad_rgb")
    assert re.search(warning, choice.warning) if warning else choice.warning is None


def test_a_gpu_that_is_demanded_is_not_replaced(monkeypatch):
    pretend(monkeypatch, GOOD)
    monkeypatch.setattr(cuda, "driver", lambda: None)
    with pytest.raises(VariantError, match="cuda_ad_rgb cannot trace here: no NVIDIA device.*leave variant out"):
        llvm.choose("cuda_ad_rgb")


def test_a_gpu_renders_what_the_processors_do():
    """Both draw the same samples; single precision rounds them differently, and few paths take another way."""
    if not cuda.probe().ok:
        pytest.skip(f"cuda_ad_rgb: {cuda.probe().reason}")
    both = (
        children.render_in_child(children.Setting(variant=variant, samples=100))
        for variant in ("cuda_ad_rgb", "llvm_ad_rgb")
    )
    verdict = check_variants(children.Setting(samples=100), render=lambda setting: tuple(both))
    assert verdict.ok, verdict


def test_a_variant_that_is_demanded_is_not_replaced(monkeypatch):
    pretend(monkeypatch)
    with pytest.raises(VariantError, match="none was found.*install karellen-llvm-core"):
        llvm.choose("llvm_ad_rgb")
    assert llvm.choose("scalar_rgb") == llvm.Choice("scalar_rgb", None)


def test_a_broken_library_is_found_out_in_a_child(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    broken = tmp_path / "libLLVM.so.99"
    broken.write_bytes(b"no library")
    result = llvm.probe(Candidate(broken, "test"))
    assert not result.ok and result.reason.startswith("exit status")
    assert not llvm.probe(Candidate(tmp_path / "none.so", "test")).ok


def test_a_probe_that_succeeded_is_remembered(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    packaged = next(c for c in llvm.candidates() if c.origin == llvm.PACKAGE)
    first = llvm.probe(packaged)
    assert first.ok
    (known,) = json.loads((tmp_path / "unshade/llvm-probes.json").read_text()).values()
    assert known == first.version
    monkeypatch.setattr(llvm, "_try", lambda candidate: pytest.fail("tried again"))
    assert llvm.probe(packaged) == first


def run(code):
    environment = {k: v for k, v in os.environ.items() if k != "DRJIT_LIBLLVM_PATH"}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


def test_a_process_keeps_its_variant():
    child = run(
        "from unshade.render import llvm\n"
        "llvm.activate(llvm.choose('scalar_rgb'))\n"
        "try: llvm.activate(llvm.Choice('llvm_ad_rgb', None))\n"
        "except llvm.VariantError as error: print(error)\n"
    )
    assert "already renders with scalar_rgb" in child.stdout


MASK = """
import sys; sys.path.insert(0, {tests!r})
from unshade.render import llvm
llvm.activate(llvm.choose({variant!r}))
llvm.activate = lambda choice: None
import render_toy, hashlib, numpy as np
from unshade.camera.camera import Camera, look_at
from unshade.render.scene import ChartMaps, HeadScene
from unshade.render.probes import view_through_centres
face = render_toy.toy_face()
head = HeadScene(face.chart, face.parts, ChartMaps.truth(face))
camera = Camera("000", 16, 16, 32.0, look_at(np.array([0.2, 0.1, 0.45]), np.zeros(3)), True)
mask = view_through_centres(head, camera).mask
print(mask.sum(), hashlib.sha256(mask.tobytes()).hexdigest())
"""


def test_the_fallback_sees_the_same_mask():
    """That it renders the same picture is the check `physics.variants`."""
    masks = []
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        child = run(MASK.format(tests=str(Path(__file__).parent), variant=variant))
        assert child.returncode == 0, child.stderr
        masks.append(child.stdout.split())
    assert int(masks[0][0]) > 20 and masks[0] == masks[1]
