"""The renderer as a child process: what it says on its standard output, and how it ends."""

import json
import os
import subprocess
import sys
from pathlib import Path

import render_toy

from unshade.render.scene_text import scene_text
from unshade.scene_file import parse_scene


def toy(**render):
    return parse_scene(render_toy.toy_table(**render), "toy", Path())


def stage(name, **arguments):
    """A child with its request, whose standard input stays open."""
    command = [sys.executable, "-m", "unshade.stage"]
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    child = subprocess.Popen(command, **pipes, text=True)
    child.stdin.write(json.dumps({"stage": name, **arguments}, default=str) + "\n")
    child.stdin.flush()
    return child


def events(output):
    return [json.loads(line) for line in output.splitlines()]


def test_the_child_process_says_what_is_wrong(tmp_path):
    (tmp_path / "scene.toml").write_text(scene_text(toy()).replace("samples", "sampels"))
    child = stage("synth", scene=tmp_path / "scene.toml", out=tmp_path / "capture")
    (error,) = events(wait(child))
    assert child.returncode == 2
    assert error["event"] == "error" and error["kind"] == "SceneError"
    assert "unknown key 'sampels' in [render]" in error["message"] and "'samples'" in error["message"]
    assert os.listdir(tmp_path) == ["scene.toml"]


def test_the_child_process_examines_the_machine():
    child = stage("doctor")
    (result,) = events(wait(child))
    checks = {check["name"]: check for check in result["checks"]}
    assert child.returncode == 0 and checks["llvm"]["ok"] and checks["variant"]["found"] == "llvm_ad_rgb"
    assert all("fix" in check for check in checks.values() if not check["ok"])


def test_the_child_process_leaves_with_its_parent_and_goes_on_later(tmp_path):
    """The whole way with the painted head: killed in the middle, then finished."""
    (tmp_path / "scene.toml").write_text(scene_text(toy(width=16, height=16, samples=4)))
    arguments = {"scene": tmp_path / "scene.toml", "out": tmp_path / "capture"}
    child = stage("synth", **arguments)
    for line in child.stdout:
        if json.loads(line)["what"].startswith("view 001"):
            break
    child.communicate()
    assert child.returncode == 3
    assert (tmp_path / "capture.partial/images/000.exr").exists() and not (tmp_path / "capture").exists()
    child = stage("synth", **arguments)
    output = wait(child)
    said = events(output)
    assert child.returncode == 0 and said[-1]["event"] == "result" and said[-1]["variant"] == "llvm_ad_rgb"
    assert (tmp_path / "capture/truth/scene.toml").exists() and not (tmp_path / "capture.partial").exists()


def wait(child):
    """Reads a child whose standard input stays open."""
    output = child.stdout.read()
    child.wait()
    child.stdin.close()
    return output
