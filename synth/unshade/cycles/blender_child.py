"""Runs inside Blender: ``python blender_child.py JOB.json``; builds a scene, saves it, renders it.

The job is what `description` writes. World here is Z up: ours (x, y, z) is (x, -z, y). One JSON line on standard
output for every picture that is done. Ends when the process that started it does.
"""

import ctypes
import importlib
import json
import os
import sys
from pathlib import Path


def end_with_parent():
    """From now on this process ends with the one that started it (Linux), which may have ended already."""
    if sys.platform == "linux":
        set_death_signal, kill = 1, 9
        ctypes.CDLL(None).prctl(set_death_signal, kill, 0, 0, 0)
    if os.environ.get("UNSHADE_PARENT", str(os.getppid())) != str(os.getppid()):
        sys.exit(3)


# First of all: loading Blender takes seconds.
end_with_parent()

import numpy as np  # noqa: E402

bpy = importlib.import_module("bpy")
matrix_of = importlib.import_module("mathutils").Matrix

UP = matrix_of(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
F0 = 0.04
PASSES = ("diffuse_direct", "diffuse_indirect", "diffuse_color", "glossy_direct", "glossy_indirect", "glossy_color")


def main(path):
    job = json.loads(Path(path).read_text())
    if job.get("open"):
        bpy.ops.wm.open_mainfile(filepath=job["open"])
    else:
        bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    settings(scene, job)
    for mesh in job["meshes"]:
        add_mesh(scene, mesh, skin(mesh["name"], mesh["material"]))
    if job.get("open"):
        # Light and camera are the file's own.
        return pictures(scene, job, job["lights"][0]["name"], job["views"][0])
    for light in job["lights"]:
        group = add_light(scene, light)
        for view in job["views"]:
            camera(scene, view)
            if job.get("save"):
                return save(job["save"])
            pictures(scene, job, light["name"], view)
        for thing in group:
            bpy.data.objects.remove(thing)


def pictures(scene, job, light, view):
    """One picture for every seed of the view in this light."""
    for number, seed in enumerate(view["seeds"].get(light, [])):
        scene.cycles.seed = seed
        scene.render.filepath = str(Path(job["out"]) / light / f"{view['name']}-{number}.exr")
        bpy.ops.render.render(write_still=True)
        print(
            json.dumps(
                {"done": f"view {view['name']} in {light}", "light": light, "view": view["name"], "number": number}
            ),
            flush=True,
        )


def save(path):
    """A file with its pictures inside, as a window would show it."""
    bpy.ops.file.pack_all()
    bpy.context.scene.render.filepath = "//face"
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)
    print(json.dumps({"done": path}), flush=True)


def settings(scene, job):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["samples"]
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    bounces = job["depth"] - 2
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces"):
        setattr(cycles, name, bounces)
    cycles.transmission_bounces = cycles.volume_bounces = 0
    cycles.caustics_reflective = True
    cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    scene.render.film_transparent = True
    scene.render.use_persistent_data = True
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth = "32"
    layer = bpy.context.view_layer
    for name in PASSES:
        setattr(layer, f"use_pass_{name}", True)


def add_mesh(scene, given, material):
    """A mesh of an .npz: vertices, triangles, and if they are there normals, uv (per vertex) and colours."""
    data = np.load(given["file"])
    vertices, triangles = data["vertices"].astype(np.float32), data["triangles"].astype(np.int32)
    mesh = bpy.data.meshes.new(given["name"])
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.polygons.foreach_set("use_smooth", np.full(len(triangles), "normals" in data, dtype=bool))
    if "uv" in data:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.uv.foreach_set("vector", data["uv"].astype(np.float32)[triangles.ravel()].ravel())
    for name in ("diffuse", "specular"):
        if name in data:
            values = data[name].reshape(len(vertices), -1)
            rgb = np.broadcast_to(values, (len(vertices), 3))
            colours = np.concatenate([rgb, np.ones((len(vertices), 1))], 1).astype(np.float32)
            attribute = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
            attribute.data.foreach_set("color", colours.ravel())
    if "normals" in data:
        # Blender 4.5 and newer: normals as they are; older ones round them.
        normals = data["normals"].astype(np.float32)
        try:
            attribute = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT")
            attribute.data.foreach_set("vector", normals.ravel())
        except (RuntimeError, TypeError):
            mesh.normals_split_custom_set_from_vertices(normals)
    mesh.materials.append(material)
    thing = bpy.data.objects.new(given["name"], mesh)
    thing.matrix_world = UP
    for name in (
        "shadow_terminator_geometry_offset",
        "shadow_terminator_shading_offset",
        "shadow_terminator_normal_offset",
    ):
        if hasattr(thing, name):
            setattr(thing, name, 0.0)
    scene.collection.objects.link(thing)
    return thing


class Graph:
    """Nodes of a material, joined by calls."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def node(self, kind, properties=None, **inputs):
        node = self.tree.nodes.new(kind)
        for name, value in (properties or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            self.put(node.inputs[int(name[1:])] if name[0] == "_" else node.inputs[name.replace("_", " ")], value)
        return node

    def put(self, socket, value):
        if hasattr(value, "is_output"):
            self.tree.links.new(value, socket)
        elif value is not None:
            socket.default_value = value

    def math(self, operation, a, b=0.0):
        return self.node("ShaderNodeMath", {"operation": operation}, _0=a, _1=b).outputs[0]

    def image(self, path):
        image = bpy.data.images.load(path)
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "NONE"
        return self.node(
            "ShaderNodeTexImage", {"image": image, "interpolation": "Linear", "extension": "EXTEND"}
        ).outputs["Color"]

    def parts(self, colour):
        return self.node("ShaderNodeSeparateColor", Color=colour).outputs


def value_of(graph, given):
    """A socket or a number for ``{"file": ...}``, ``{"attribute": ...}`` or a number."""
    if isinstance(given, dict) and "file" in given:
        return graph.image(given["file"])
    if isinstance(given, dict):
        return graph.node("ShaderNodeAttribute", {"attribute_name": given["attribute"]}).outputs["Color"]
    return given


def normal_of(graph, given):
    """A normal of object space as the world has it; None for the mesh's own."""
    if given is None:
        return None
    settings = {"vector_type": "NORMAL", "convert_from": "OBJECT", "convert_to": "WORLD"}
    in_world = graph.node("ShaderNodeVectorTransform", settings, Vector=value_of(graph, given)).outputs[0]
    return graph.node("ShaderNodeVectorMath", {"operation": "NORMALIZE"}, _0=in_world).outputs[0]


def skin(name, given):
    """Lambert plus two GGX lobes with Schlick's Fresnel term, added as our skin adds them.

    A Metallic BSDF of base colour 0.04 and white edge is Schlick's term with F0 = 0.04; the specular albedo over
    0.04 times the lobe's share is its weight.
    """
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    graph = Graph(material.node_tree)
    diffuse = value_of(graph, given["diffuse"])
    specular = value_of(graph, given["specular"])
    if hasattr(specular, "is_output"):
        specular = graph.parts(specular)[0]
    if isinstance(given["roughness"], dict):
        alpha1, alpha2, weight = graph.parts(value_of(graph, given["roughness"]))
    else:
        alpha1, alpha2, weight = given["roughness"]
    n_d, n_s = normal_of(graph, given.get("diffuse_normal")), normal_of(graph, given.get("specular_normal"))
    surface = graph.node("ShaderNodeBsdfDiffuse", Color=diffuse, Roughness=0.0, Normal=n_d).outputs[0]
    for alpha, part in ((alpha1, weight), (alpha2, graph.math("SUBTRACT", 1.0, weight))):
        lobe = graph.node(
            "ShaderNodeBsdfMetallic",
            {"distribution": "GGX", "fresnel_type": "F82"},
            Base_Color=(F0, F0, F0, 1.0), Edge_Tint=(1.0, 1.0, 1.0, 1.0),
            Roughness=graph.math("SQRT", alpha), Normal=n_s,
        ).outputs[0]  # fmt: skip
        # A mix takes weights up to 1, and a specular albedo of 0.05 asks for 1.25: two halves.
        half = graph.math("MULTIPLY", graph.math("MULTIPLY", specular, 0.5 / F0), part)
        for _ in range(2):
            weighted = graph.node("ShaderNodeMixShader", _0=half, _2=lobe).outputs[0]
            surface = graph.node("ShaderNodeAddShader", _0=surface, _1=weighted).outputs[0]
    # Our skin has a front only.
    behind = graph.node("ShaderNodeNewGeometry").outputs["Backfacing"]
    front = graph.node("ShaderNodeMixShader", _0=behind, _1=surface).outputs[0]
    graph.node("ShaderNodeOutputMaterial", Surface=front)
    return material


def add_light(scene, light):
    """The world's background and shining meshes that cameras look through; returns the meshes' objects."""
    world = bpy.data.worlds.new(light["name"])
    scene.world = world
    world.use_nodes = True
    graph = Graph(world.node_tree)
    sky = light.get("background")
    if sky and "file" in sky:
        image = bpy.data.images.load(sky["file"])
        image.colorspace_settings.name = "Non-Color"
        colour = graph.node("ShaderNodeTexEnvironment", {"image": image, "interpolation": "Linear"}).outputs["Color"]
        background = graph.node("ShaderNodeBackground", Color=colour, Strength=1.0)
    else:
        radiance = sky["radiance"] if sky else [0.0] * 3
        background = graph.node("ShaderNodeBackground", Color=(*radiance, 1.0), Strength=1.0)
    graph.node("ShaderNodeOutputWorld", Surface=background.outputs[0])
    group = []
    for lamp in light["lamps"]:
        material = bpy.data.materials.new(lamp["name"])
        material.use_nodes = True
        graph = Graph(material.node_tree)
        strength = max(lamp["radiance"]) or 1.0
        colour = (*(v / strength for v in lamp["radiance"]), 1.0)
        shine = graph.node("ShaderNodeEmission", Color=colour, Strength=strength)
        graph.node("ShaderNodeOutputMaterial", Surface=shine.outputs[0])
        thing = add_mesh(scene, lamp, material)
        thing.visible_camera = False
        group.append(thing)
    return group


def camera(scene, view):
    for thing in [thing for thing in scene.objects if thing.type == "CAMERA"]:
        bpy.data.objects.remove(thing)
    lens = bpy.data.cameras.new(view["name"])
    lens.sensor_fit = "HORIZONTAL"
    lens.sensor_width = 36.0
    lens.lens = 36.0 * view["focal"] / view["width"]
    lens.clip_start, lens.clip_end = 0.01, 2000.0
    thing = bpy.data.objects.new(view["name"], lens)
    thing.matrix_world = UP @ matrix_of(view["matrix"])
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = view["width"], view["height"]


if __name__ == "__main__":
    main(sys.argv[-1])
