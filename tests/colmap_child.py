"""COLMAP itself (pycolmap), in a process of its own: its libraries and Pillow's do not go together in one.

    echo REQUEST | python tests/colmap_child.py

A request is JSON with ``do``: ``write`` a model, ``project`` points, or ``directions`` of pixels.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np


def ask(**request: Any) -> Any:
    """What the child answers."""
    done = subprocess.run([sys.executable, __file__], input=json.dumps(request), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def _write(folder: str, views: list[dict[str, Any]], binary: bool, rig: bool = False) -> None:
    """``views`` have name, model, width, height, parameters, and world_to_camera (3, 4) with OpenCV's axes."""
    import pycolmap

    model = pycolmap.Reconstruction()
    cameras = [
        pycolmap.Camera(camera_id=n, model=v["model"], width=v["width"], height=v["height"], params=v["parameters"])
        for n, v in enumerate(views, 1)
    ]
    poses = [pycolmap.Rigid3d(np.array(view["world_to_camera"])) for view in views]
    images = [pycolmap.Image(name=view["name"], camera_id=n, image_id=n) for n, view in enumerate(views, 1)]
    if not rig:
        for camera, pose, image in zip(cameras, poses, images):
            model.add_camera_with_trivial_rig(camera)
            model.add_image_with_trivial_frame(image, pose)
    else:
        sensors, shot = pycolmap.Rig(rig_id=1), pycolmap.Frame()
        shot.frame_id, shot.rig_id = 1, 1
        for number, (camera, pose) in enumerate(zip(cameras, poses), 1):
            model.add_camera(camera)
            if number == 1:
                sensors.add_ref_sensor(camera.sensor_id)
            else:
                sensors.add_sensor(camera.sensor_id, pose * poses[0].inverse())
            shot.add_data_id(pycolmap.data_t(camera.sensor_id, number))
        model.add_rig(sensors)
        shot.rig_from_world = poses[0]
        model.add_frame(shot)
        for image in images:
            image.frame_id = 1
            model.add_image(image)
        model.register_frame(1)
    Path(folder).mkdir(parents=True)
    (model.write_binary if binary else model.write_text)(folder)


def _project(folder: str, points: list[list[float]]) -> dict[str, list[list[float]]]:
    """Where each picture of a model shows points of the world, pixels."""
    import pycolmap

    model = pycolmap.Reconstruction(folder)
    return {image.name: [image.project_point(np.array(p)).tolist() for p in points] for image in model.images.values()}


def _directions(model: str, parameters: list[float], size: list[int], pixels: list[list[float]]) -> list[list[float]]:
    """What a camera sees at pixels: x and y over z, OpenCV's axes."""
    import pycolmap

    camera = pycolmap.Camera(camera_id=1, model=model, width=size[0], height=size[1], params=parameters)
    return camera.cam_from_img(np.array(pixels)).tolist()


if __name__ == "__main__":
    asked = json.load(sys.stdin)
    verbs = {"write": _write, "project": _project, "directions": _directions}
    print(json.dumps(verbs[asked.pop("do")](**asked)))
