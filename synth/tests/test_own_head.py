"""Files of your own head: read, placed and painted where its files say, or refused by name."""

import json

import mitsuba as mi
import numpy as np
import own_head_files as files
import pytest
from PIL import Image

from unshade.face import FaceError
from unshade.files.pictures import write_exr
from unshade.heads import build_head
from unshade.own_head import HeadFiles
from unshade.own_head.keep import keep, kept
from unshade.own_head.spec import NOMINAL_ROUGHNESS
from unshade.render import lights
from unshade.render.passes import render_layers
from unshade.render.probes import TexelVisibility, nearest_texels, view_through_centres
from unshade.render.rigs import cameras
from unshade.render.scene import ChartMaps, HeadScene
from unshade.render.skin_bsdf import LOBE_ALPHAS, LOBE_WEIGHTS
from unshade.scene_file import Rig
from unshade.scene_file.face import parse_face
from unshade.vectors import unit

GRID = files.polygons()[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("scan")
    files.write_obj(path / "scan.obj")
    files.write_glb(path / "scan.glb")
    files.write_albedo(path / "albedo.png")
    return path


def table(**changes):
    given = files.TABLE | {"mesh": "scan.obj", "diffuse_albedo": "albedo.png", "diffuse_albedo_space": "srgb"} | changes
    return {key: value for key, value in given.items() if value is not None}


def built(folder, **changes):
    return build_head(parse_face(table(**changes), "[face]", folder))


def surface(chart):
    """Triangles as sorted rows of positions (0.1 mm) and uv (1e-4): the same for equal meshes."""
    corners = np.concatenate([chart.vertices * 1e4, chart.uv * 1e4], 1)[chart.triangles]
    return sorted(tuple(sorted(map(tuple, np.round(corner).astype(int)))) for corner in corners)


def test_obj_and_glb_are_the_same_head(folder):
    obj, glb = built(folder), built(folder, mesh="scan.glb")
    assert len(obj.chart.triangles) == 2 * files.STEPS**2
    assert surface(obj.chart) == surface(glb.chart)
    camera = cameras(Rig("p", "phone", seed=2), 48, 48)[3]
    seen = [view_through_centres(HeadScene(f.chart, f.parts, ChartMaps.truth(f)), camera) for f in (obj, glb)]
    assert seen[0].mask.mean() > 0.1 and (seen[0].mask == seen[1].mask).all()
    np.testing.assert_allclose(seen[0].uv, seen[1].uv, atol=1e-5)
    for field in ("diffuse_albedo", "specular_normal", "labels"):
        np.testing.assert_allclose(getattr(obj.maps, field), getattr(glb.maps, field), atol=1e-3)


def test_indices_from_the_end_of_an_obj_are_read(folder):
    """As in the OBJ of Digital Emily 2: all vertices first, then faces that count backwards."""
    places, uvs = len(GRID), 3 * len(GRID)

    def backwards(text):
        head = text.split("o collar")[0]
        lines = head.splitlines()
        corner = lambda pair: "/".join(str(int(i) - n - 1) for i, n in zip(pair.split("/"), (places, uvs)))
        return "\r\n".join(
            "f " + " ".join(map(corner, line.split()[1:])) if line[:2] == "f " else line for line in lines
        )

    files.write_obj(folder / "backwards.obj", backwards)
    assert "f -625/-1875 " in (folder / "backwards.obj").read_text()
    assert surface(built(folder, mesh="backwards.obj").chart) == surface(built(folder).chart)


def test_a_file_that_gives_normals_keeps_them(folder):
    """One normal for all, which no computation would find."""
    tilted = np.array([0.6, -0.8, 0.0])  # in the file's axes
    files.write_obj(folder / "normals.obj", lambda text: "\n".join(
        "f " + " ".join(f"{corner}/1" for corner in line.split()[1:]) if line.startswith("f ") and "/" in line else line
        for line in text.replace("o head", "o head\nvn 0.6 -0.8 0").splitlines()))  # fmt: skip
    chart = built(folder, mesh="normals.obj").chart
    np.testing.assert_allclose(
        chart.normals, np.broadcast_to([tilted[0], tilted[2], -tilted[1]], chart.normals.shape), atol=1e-6
    )


def test_the_head_stands_where_its_file_says(folder):
    """Vertices lie on the formula's surface in metres, +Y up, looking along +Z."""
    for mesh in ("scan.obj", "scan.glb"):
        chart = built(folder, mesh=mesh).chart
        grid, _ = files.polygons()
        expected = files.place(*grid.T)
        nearest = np.linalg.norm(chart.vertices[:, None] - expected, axis=2).min(1)
        assert nearest.max() < 1e-6
        # Seams are split, so that every vertex has one uv, and the normals do not show it.
        places, number, counts = np.unique(
            np.round(chart.vertices * 1e6), axis=0, return_inverse=True, return_counts=True
        )
        assert len(places) == len(grid) and (counts == 2).sum() > files.STEPS
        for place in np.flatnonzero(counts > 1):
            twins = number.ravel() == place
            assert len(np.unique(np.round(chart.uv[twins], 5), axis=0)) == counts[place]
            assert np.ptp(chart.normals[twins], axis=0).max() < 1e-6
        s, t = np.array([0.125, 0.25, 0.75, 0.875]), np.array([0.25, 0.75, 0.75, 0.25])
        step = 1e-5
        across, upwards = (
            files.place(s + step, t) - files.place(s - step, t),
            files.place(s, t + step) - files.place(s, t - step),
        )
        for place, normal in zip(files.place(s, t), unit(np.cross(across, upwards))):
            here = np.linalg.norm(chart.vertices - place, axis=1) < 1e-6
            assert here.any() and (chart.normals[here] @ normal > np.cos(np.radians(2))).all()


@pytest.mark.parametrize("mesh", ["scan.obj", "scan.glb"])
def test_marked_texels_are_seen_where_the_marks_are(folder, mesh):
    """A mark's colour is found, in the picture, at the projection of the mark's place."""
    face = built(folder, mesh=mesh)
    head = HeadScene(face.chart, face.parts, ChartMaps(face.maps.diffuse_albedo))
    camera = cameras(Rig("p", "phone", train=1, test=0, max_angle_degrees=1), 96, 96)[0]
    picture = render_layers(head.lit(lights.Dome()), camera.sensor(16), samples=16, depth=2, seed=1).total
    view = view_through_centres(head, camera)
    for (s, t), srgb in files.MARKS.items():
        column, row = np.floor(camera.project(files.place(s, t)[None])[0]).astype(int)
        uv = view.uv[row, column]
        assert np.abs(uv - files.uv_of(files.island_of(s, t), s, t)).max() < 0.012
        code = np.array(srgb) / 255
        colour = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
        np.testing.assert_allclose(nearest_texels(face.maps.diffuse_albedo, uv), colour, atol=0.01)
        seen = picture[row, column]
        np.testing.assert_allclose(seen / seen.sum(), colour / colour.sum(), atol=0.03)


def test_no_background_bleeds_into_the_chart(folder):
    """The glaring magenta around the islands is nowhere, at the file's resolution and below."""
    for size in (64, 256):
        maps = built(folder, texture_size=size).maps
        grey = ((120 / 255 + 0.055) / 1.055) ** 2.4
        marked = np.ptp(maps.diffuse_albedo, axis=-1) > 0.02
        assert marked.mean() < 0.1
        np.testing.assert_allclose(maps.diffuse_albedo[~marked], grey, atol=0.02)
        outside = maps.diffuse_albedo[~maps.inside]
        assert len(outside) > 100 and not ((outside[:, 0] > 0.9) & (outside[:, 2] > 0.9)).any()


def test_every_view_sees_texels_of_all_islands(folder):
    face = built(folder)
    head = HeadScene(face.chart, face.parts, ChartMaps.truth(face))
    camera = cameras(Rig("p", "phone", train=1, test=0, max_angle_degrees=1), 96, 96)[0]
    mask = view_through_centres(head, camera).mask
    with np.errstate(all="raise"):
        seen = TexelVisibility(head, face.chart, 128).seen_by(camera, mask)
    for s, t in files.MARKS:
        assert nearest_texels(seen, files.uv_of(files.island_of(s, t), s, t))


def test_object_and_tangent_normals_are_the_same_directions(folder):
    """One field of world normals, encoded in the file's axes (EXR) and in tangent space by
    finite differences of the surface (PNG), comes back as itself on all islands."""
    size = 128
    object_space, tangent_space = np.zeros((size, size, 3), np.float32), np.zeros((size, size, 3), np.float32)
    world, mesh_normal = np.zeros((size, size, 3)), np.zeros((size, size, 3))
    line = np.linspace(0, 1, 5 * size)
    s, t = (a.ravel() for a in np.meshgrid(line, line))
    for island in range(3):
        here = (s <= 0.5) if island == 0 else (s >= 0.5) & ((t >= 0.5) if island == 1 else (t <= 0.5))
        a, b, step = s[here], t[here], 1e-4
        ds = files.place(a + step, b) - files.place(a - step, b)
        dt = files.place(a, b + step) - files.place(a, b - step)
        # dP/du and dP/dv through the inverse of the island's affine map.
        origin = files.uv_of(island, 0, 0)
        jacobian = np.linalg.inv(np.stack([files.uv_of(island, 1, 0) - origin, files.uv_of(island, 0, 1) - origin], 1))
        du = jacobian[0, 0] * ds + jacobian[1, 0] * dt
        dv = jacobian[0, 1] * ds + jacobian[1, 1] * dt
        smooth = unit(np.cross(ds, dt))
        wanted = unit(smooth + 0.2 * np.stack([np.sin(9 * a), np.cos(7 * b), 0 * a], -1))
        tangent = unit(du - smooth * (smooth * du).sum(-1, keepdims=True))
        bitangent = np.cross(smooth, tangent)
        bitangent *= np.sign((bitangent * dv).sum(-1, keepdims=True))
        texel = files._texel(files.uv_of(island, a, b), size)
        world[texel], mesh_normal[texel] = wanted, smooth
        object_space[texel] = np.stack([wanted[:, 0], -wanted[:, 2], wanted[:, 1]], -1)
        tangent_space[texel] = np.stack([(wanted * axis).sum(-1) for axis in (tangent, bitangent, smooth)], -1)
    write_exr(folder / "object.exr", {"": object_space})
    Image.fromarray(np.round((tangent_space + 1) * 127.5).astype(np.uint8)).save(folder / "tangent.png")
    maps = built(
        folder, texture_size=size, diffuse_normal="tangent.png", diffuse_normal_space="tangent",
        specular_normal="object.exr", specular_normal_space="object",
    ).maps  # fmt: skip
    inside = maps.inside & (np.linalg.norm(world, axis=-1) > 0.5)
    assert inside.sum() > 0.5 * size**2

    def degrees(found, wanted):
        return np.degrees(np.arccos((found * wanted).sum(-1)[inside].clip(-1, 1)))

    assert degrees(maps.specular_normal, world).max() < 1
    # In tangent space, what the coarse mesh's own normals are off is off by as much, and eight bits come on top.
    floor = degrees(built(folder, texture_size=size).maps.diffuse_normal, mesh_normal)
    off = degrees(maps.diffuse_normal, world)
    assert off.mean() < 1.3 and (off < 1.5 * floor + 1).mean() > 0.99


def test_other_maps_and_constants(folder):
    rough = np.zeros((32, 64, 3), np.float32)
    rough[..., 0] = np.linspace(0.2, 0.6, 64)
    write_exr(folder / "rough.exr", {"Y": rough[..., 0]})
    Image.fromarray(np.full((64, 64), 51, np.uint8)).save(folder / "specular.png")
    Image.fromarray(np.repeat(np.arange(8, dtype=np.uint8), 8)[None].repeat(64, 0)).save(folder / "labels.png")
    maps = built(
        folder, specular_albedo="specular.png", specular_albedo_space="linear", specular_albedo_scale=0.15,
        roughness="rough.exr", roughness_space="perceptual", labels="labels.png", diffuse_albedo=[0.4, 0.3, 0.2], diffuse_albedo_space=None,
    ).maps  # fmt: skip
    np.testing.assert_allclose(maps.specular_albedo, 0.2 * 0.15, rtol=1e-5)
    np.testing.assert_allclose(
        maps.diffuse_albedo, np.broadcast_to([0.4, 0.3, 0.2], maps.diffuse_albedo.shape), rtol=1e-6
    )
    u = (np.arange(128) + 0.5) / 128
    expected = np.interp(u * 64 - 0.5, np.arange(64), np.linspace(0.2, 0.6, 64)) ** 2
    inner = np.where(maps.inside[64])[0][2:-2]
    np.testing.assert_allclose(maps.roughness[64, inner, 0], expected[inner], rtol=0.02)
    np.testing.assert_array_equal(maps.roughness[..., 0], maps.roughness[..., 1])
    assert (maps.labels[maps.inside] == np.broadcast_to(np.repeat(np.arange(8), 16), (128, 128))[maps.inside]).all()
    plain = built(folder).maps
    np.testing.assert_allclose(plain.roughness, np.broadcast_to(NOMINAL_ROUGHNESS, plain.roughness.shape))
    assert NOMINAL_ROUGHNESS == (*LOBE_ALPHAS, LOBE_WEIGHTS[0])


def test_deep_pngs_keep_their_depth(folder):
    deep = np.full((64, 64, 3), 30001, np.uint16)
    mi.Bitmap(deep).write(str(folder / "deep.png"))
    maps = built(folder, diffuse_albedo="deep.png", diffuse_albedo_space="linear").maps
    np.testing.assert_allclose(maps.diffuse_albedo, 30001 / 65535, rtol=1e-6)


def test_a_table_survives_writing_and_reading(folder):
    head = parse_face(table(specular_albedo=0.03, roughness=[0.2, 0.4, 0.6]), "[face]", folder)
    assert isinstance(head, HeadFiles)
    again = json.loads(json.dumps(head.to_table()))
    assert parse_face(again, "[face]", folder.parent / "elsewhere") == head
    assert set(head.files()) == {"mesh", "diffuse_albedo"}


def test_kept_files_give_the_same_head(folder, tmp_path):
    head = parse_face(table(mesh="scan.glb"), "[face]", folder)
    keep(head, tmp_path / "head")
    copy = kept(head, tmp_path / "head")
    assert copy.mesh == str(tmp_path / "head" / "mesh.glb") and copy.diffuse_albedo.endswith("diffuse_albedo.png")
    one, other = build_head(head), build_head(copy)
    assert one.chart.vertices.tobytes() == other.chart.vertices.tobytes()
    assert one.maps.diffuse_albedo.tobytes() == other.maps.diffuse_albedo.tobytes()


def test_gltf_with_loose_buffers_is_refused(folder):
    text = {"asset": {"version": "2.0"}, "buffers": [{"uri": "scan.bin", "byteLength": 4}]}
    (folder / "loose.gltf").write_text(json.dumps(text))
    with pytest.raises(FaceError, match="loose.gltf: keeps its data in other files; export it as one .glb"):
        built(folder, mesh="loose.gltf")


def overlapping(text):
    """The lower island laid upon the upper one."""
    lines = text.splitlines()
    count = (files.STEPS + 1) ** 2
    uv = [i for i, line in enumerate(lines) if line.startswith("vt ")]
    for k, (s, t) in enumerate(GRID):
        lines[uv[2 * count + k]] = "vt %.9g %.9g" % tuple(files.uv_of(1, s, t + 0.5))
    return "\n".join(lines)


FAULTS = {
    "has no UV": ({"chart": ["head", "collar"]}, None),
    '"head" overlaps in UV: two triangles claim 30.8 %': ({}, overlapping),
    "vertices of 'head' are not finite": ({}, lambda text: text.replace("\nv ", "\nv nan nan nan\nv ", 1)),
    "state other units": ({"units": "m"}, None),
    "move all islands into the unit square": ({}, lambda text: text.replace("\nvt 0", "\nvt 1")),
    "there is no object 'face' for chart; there are 'collar', 'head'": ({"chart": ["face"]}, None),
    "names vertex 99999, but there are 629": ({}, lambda text: text.replace("f 1/", "f 99999/")),
    "put origin inside the head": ({"origin": [4.0, -130.0, 150.0]}, None),
}  # fmt: skip


@pytest.mark.parametrize("message", FAULTS)
def test_meshes_that_cannot_be_used_are_named(message, folder):
    changes, edit = FAULTS[message]
    if edit:
        files.write_obj(folder / "broken.obj", edit)
        changes = changes | {"mesh": "broken.obj"}
    with pytest.raises(FaceError) as caught:
        built(folder, **changes)
    assert message in str(caught.value) and "\n" not in str(caught.value)


TABLE_FAULTS = {
    "mesh in [face]: there is no file": {"mesh": "none.obj"},
    "use a file that ends with .obj or .glb or .gltf": {"mesh": "albedo.png"},
    "diffuse_albedo in [face]: there is no file": {"diffuse_albedo": "none.png"},
    "diffuse_albedo in [face] is missing": {"diffuse_albedo": None, "diffuse_albedo_space": None},
    "diffuse_albedo_space in [face] is missing; state what": {"diffuse_albedo_space": None},
    "diffuse_albedo_space in [face] is 'gamma'; use linear or srgb": {"diffuse_albedo_space": "gamma"},
    "roughness_space in [face] is without a file": {"roughness_space": "lobes"},
    "units in [face] is 'feet'; use one of m": {"units": "feet"},
    "which lie in one line": {"forward": "-z"},
    "unknown key 'tall' in [face]; did you mean": {"tall": 1},
    "specular_albedo in [face] is 0.5; use a number from 0 to 0.05": {"specular_albedo": 0.5},
    "use three numbers from 0 to 1": {"diffuse_albedo": [0.5, 2, 0], "diffuse_albedo_space": None},
}


@pytest.mark.parametrize("message", TABLE_FAULTS)
def test_unusable_tables_are_named(message, folder):
    with pytest.raises(FaceError) as caught:
        parse_face(table(**TABLE_FAULTS[message]), "[face]", folder)
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_maps_out_of_range_are_named(folder):
    write_exr(folder / "bright.exr", {"": np.full((8, 8, 3), 1.5, np.float32)})
    with pytest.raises(FaceError, match="bright.exr: diffuse_albedo reaches from 1.5 to 1.5"):
        built(folder, diffuse_albedo="bright.exr", diffuse_albedo_space="linear")
    with pytest.raises(FaceError, match="specular_albedo_scale"):
        built(folder, specular_albedo="albedo.png", specular_albedo_space="linear")
