"""Your own meshes as other programs write them: read by their meaning, turned outwards, or refused by name."""

import json
import warnings

import numpy as np
import own_head_files as files
import pytest

from unshade.face import FaceError
from unshade.files import glb
from unshade.own_head import HeadFiles, build, placement
from unshade.own_head.mesh_file import read_pieces
from unshade.own_head.outward import MeshWarning, oriented_outwards
from unshade.scene_file.face import parse_face


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh")
    files.write_obj(path / "scan.obj")
    files.write_glb(path / "scan.glb")
    return path


def joined(folder, mesh):
    """The chart's mesh, before any map is read."""
    table = files.TABLE | {"mesh": mesh, "diffuse_albedo": [0.5, 0.4, 0.3]}
    head = parse_face(table, "[face]", folder)
    assert isinstance(head, HeadFiles)
    inside, _ = build._divide(read_pieces(folder / mesh), head)
    mesh = build._joined(inside, head)
    return mesh | {"points": mesh["points"] - placement.origin(mesh["points"], head)}


def corners(mesh):
    """Triangles as rows of positions, uvs and normals, in no order."""
    rows = np.concatenate([mesh["points"], mesh["uv"], mesh["normals"]], 1)[mesh["triangles"]]
    first = np.lexsort(np.moveaxis(np.round(rows, 6), 2, 0)[::-1], axis=1)[:, 0]
    rows = rows[np.arange(len(rows))[:, None], (first[:, None] + np.arange(3)) % 3].reshape(len(rows), -1)
    return rows[np.lexsort(np.round(rows, 5).T[::-1])]


def with_normals(text):
    """The file with a normal per vertex, which is the direction from a point within."""
    lines, places = text.splitlines(), []
    for line in lines:
        if line.startswith("v "):
            place = np.array(line.split()[1:], float) - files.OFFSET
            places.append(place / np.linalg.norm(place))
    normals = ["vn %.6f %.6f %.6f" % tuple(n) for n in places]
    faces = [
        "f " + " ".join(f"{c}/{c.split('/')[0]}" if "/" in c else c for c in line.split()[1:])
        if line.startswith("f ")
        else line
        for line in lines
    ]
    return "\n".join([faces[0], *normals, *faces[1:]])


def negated(text, which):
    return "\n".join(
        "vn " + " ".join("%.6f" % -float(x) for x in line.split()[1:])
        if line.startswith("vn ") and which(line)
        else line
        for line in text.splitlines()
    )


def reversed_faces(text, which):
    faces = iter(range(10**6))
    return "\n".join(
        "f " + " ".join(line.split()[:0:-1]) if line.startswith("f ") and which(next(faces)) else line
        for line in text.splitlines()
    )


left = lambda line: float(line.split()[1]) < 0.1
INWARD = {
    "all normals": (with_normals, lambda t: negated(t, lambda _: True), "normals"),
    "half of the normals": (with_normals, lambda t: negated(t, left), "normals"),
    "all triangles": (lambda t: t, lambda t: reversed_faces(t, lambda _: True), "triangles"),
    "half of the triangles": (lambda t: t, lambda t: reversed_faces(t, lambda k: k < 260), "triangles"),
    "some of both": (with_normals, lambda t: negated(reversed_faces(t, lambda k: k % 3 == 0), left), "triangles and"),
}


@pytest.mark.parametrize("name", INWARD)
def test_inward_normals_and_triangles_are_flipped_with_a_warning(name, folder):
    sound, change, messages = INWARD[name]
    files.write_obj(folder / "sound.obj", sound)
    files.write_obj(folder / "turned.obj", lambda text: change(sound(text)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        expected = joined(folder, "sound.obj")
    with pytest.warns(MeshWarning, match=f"turned.obj: .* of .* {messages}.* point inwards; flipped them outwards"):
        found = joined(folder, "turned.obj")
    # Polygons are cut elsewhere when they run the other way, so the surface is compared by its vertices.
    rows = lambda mesh: np.unique(np.round(np.concatenate([mesh["points"], mesh["uv"]], 1), 6), axis=0)
    np.testing.assert_array_equal(rows(found), rows(expected))
    assert ((found["normals"] * found["points"]).sum(1) > 0).all()
    corner = found["points"][found["triangles"]]
    outward = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    assert ((outward * found["normals"][found["triangles"]].sum(1)).sum(1) > 0).all()


def test_a_twisted_strip_is_named():
    turn = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    along = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1) * 0.1
    across = along * 0.3 * np.cos(turn / 2)[:, None] + np.array([0, 0, 0.03]) * np.sin(turn / 2)[:, None]
    points = np.concatenate([along - across, along + across])
    low, high = np.arange(20), np.arange(20) + 20
    after_low, after_high = np.append(low[1:], high[0]), np.append(high[1:], low[0])
    triangles = np.concatenate([np.stack([low, after_low, after_high], 1), np.stack([low, after_high, high], 1)])
    with pytest.warns(MeshWarning, match="40 of 40 triangles are on one-sided"):
        oriented_outwards(points, triangles, None, type("Head", (), {"mesh": "strip.obj"}))


def test_one_obj_however_it_is_written(folder):
    expected = corners(joined(folder, "scan.obj"))
    plain = (folder / "scan.obj").read_text()
    for text in (
        plain.replace(" ", "\t"),
        plain.replace("\n", "\n   "),
        plain.replace("f ", "usemtl\nl 1 2\np 1\nf "),
        plain.replace("\n", "\r\n"),
    ):
        (folder / "other.obj").write_bytes(b"# f\xfcr sp\xe4ter\n" + text.encode())
        np.testing.assert_array_equal(corners(joined(folder, "other.obj")), expected)


def test_points_in_line_and_concave_polygons_keep_the_area(folder):
    """Two rows of the grid as one polygon each: a strip with points in line in the chart, and a U."""

    def area(mesh):
        a, b, c = np.moveaxis(mesh["uv"][mesh["triangles"]], 1, 0)
        return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])

    n = files.STEPS + 1
    corner = lambda i, j: j * n + i + 1
    strip = [corner(i, 1) for i in range(9)] + [corner(i, 2) for i in range(8, -1, -1)]
    u = [corner(i, j) for i, j in ((0, 8), (3, 8), (3, 10), (2, 10), (2, 9), (1, 9), (1, 10), (0, 10))]
    for polygon, cells in ((strip, 8), (u, 5)):
        face = "f " + " ".join(f"{k}/{k}" for k in polygon)
        grid = (folder / "scan.obj").read_text().splitlines()
        lines = [line for line in grid if line.startswith(("v ", "vt "))]
        (folder / "polygon.obj").write_text("\n".join(["o head", *lines, face]))
        (piece,) = read_pieces(folder / "polygon.obj")
        areas = area({"uv": piece.uv, "triangles": piece.triangles})
        assert (areas > 1e-5).all() and len(areas) == len(polygon) - 2
        assert areas.sum() == pytest.approx(cells * 0.8 * 0.9 / files.STEPS**2, rel=1e-4)


# glTF


def textured(packed, **textures):
    """A material with textures, each with its KHR_texture_transform (and set of coordinates)."""
    infos = {}
    for name, moved in textures.items():
        infos[name] = {"index": 0} | ({"extensions": {"KHR_texture_transform": moved}} if moved else {})
    packed.document["materials"] = [
        {"name": "skin", "pbrMetallicRoughness": {"baseColorTexture": infos.pop("base")}, **infos}
    ]
    packed.document["extensionsUsed"] = ["KHR_texture_transform"]
    packed.head["material"] = 0


def scaled_uv(packed):
    """As gltfpack does it: 16-bit coordinates that the material's transform takes to the texture."""
    low, high = packed.values(1).min(0), packed.values(1).max(0)
    codes = np.zeros((len(packed.values(1)), 2), "<u2")
    codes[:] = np.round((packed.values(1) - low) / (high - low) * 4095)
    moved = {"offset": low.tolist(), "scale": ((high - low) / 4095).tolist()}
    textured(packed, base=moved, normalTexture=moved)
    packed.head["attributes"]["TEXCOORD_0"] = packed.add(codes, 5123)
    packed.document["extensionsRequired"] = ["KHR_mesh_quantization", "KHR_texture_transform"]


def turned_uv(packed):
    """A quarter turn as in the extension's example (u' = v, v' = 1 - u), of the second set of coordinates."""
    u, v = packed.values(1).T
    textured(packed, base={"offset": [0, 1], "rotation": np.pi / 2, "texCoord": 1})
    packed.document["materials"][0]["occlusionTexture"] = {"index": 1}
    attributes = packed.head["attributes"]
    attributes["TEXCOORD_1"] = packed.add(np.stack([1 - v, u], 1), 5126)
    attributes["TEXCOORD_0"] = packed.add(np.zeros((len(u), 2), "<f4"), 5126)


def skinned(packed):
    """Bound in centimetres with z up to two joints, of which one is moved away; the node stands somewhere else."""
    places, count = packed.values(0), len(packed.values(0))
    bind = np.eye(4)
    bind[:3, :3] = 0.01 * np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    away = np.eye(4)
    away[:3, 3] = [0, 0.04, 0]
    document, attributes = packed.document, packed.head["attributes"]
    inverse = np.stack([np.linalg.inv(away) @ bind, bind]).astype("<f4").transpose(0, 2, 1).reshape(2, 16).copy()
    local = np.c_[places, np.ones(count)] @ np.linalg.inv(bind).T
    attributes["POSITION"] = packed.add(local[:, :3].astype("<f4"), 5126)
    attributes["JOINTS_0"] = packed.add(np.tile(np.array([[0, 1, 0, 0]], "<u1"), (count, 1)), 5121)
    weights = np.tile(np.array([[51, 204, 0, 0]], "<u1"), (count, 1))
    attributes["WEIGHTS_0"] = packed.add(weights, 5121, normalized=True)
    document["skins"] = [{"joints": [3, 4], "inverseBindMatrices": packed.add(inverse, 5126)}]
    document["nodes"][0]["children"] += [3]
    document["nodes"] += [{"translation": [0, 0.04, 0]}, {}]
    document["nodes"][3]["children"] = [4]
    document["nodes"][4]["translation"] = [0, -0.04, 0]
    document["nodes"][1] |= {"skin": 0, "translation": [5, 5, 5], "scale": [3, 3, 3]}


def quantised(packed):
    """As gltfpack does it: padded 16-bit positions under a node's scale."""
    codes = np.zeros((len(packed.values(0)), 4), "<i2")
    codes[:, :3] = np.round(packed.values(0) / 0.3 * 32767)
    number = packed.add(codes[:, :3].copy(), 5122, normalized=True)
    packed.document["accessors"][number]["bufferView"] = packed.view(codes, byteStride=8)
    packed.head["attributes"]["POSITION"] = number
    packed.document["nodes"][1]["scale"] = [0.3] * 3
    packed.document["extensionsRequired"] = ["KHR_mesh_quantization"]


def sparse(packed):
    """Everything moved away, and back by sparse values."""
    places = packed.values(0).copy()
    wrong = places.copy()
    wrong[5:50] += 1
    number = packed.add(wrong, 5126)
    indices = packed.view(np.arange(5, 50, dtype="<u2"))
    values = packed.view(places[5:50])
    packed.document["accessors"][number]["sparse"] = {
        "count": 45,
        "indices": {"bufferView": indices, "componentType": 5123},
        "values": {"bufferView": values},
    }
    packed.head["attributes"]["POSITION"] = number


def morphed(packed):
    places = packed.values(0)
    shift = np.full_like(places, 0.02)
    packed.head["attributes"]["POSITION"] = packed.add(places - 0.5 * shift, 5126)
    packed.head["targets"] = [{"POSITION": packed.add(shift * 9, 5126)}, {"POSITION": packed.add(shift, 5126)}]
    packed.document["meshes"][0]["weights"] = [0, 0.5]


def strips(packed):
    """Two primitives: one as strips of one triangle each would be, the other as before."""
    triangles = packed.values(2).reshape(-1, 3)
    first = packed.add(triangles[:1].reshape(-1, 1).copy(), 5125)
    rest = packed.add(triangles[1:].reshape(-1, 1).copy(), 5125)
    attributes = packed.head["attributes"]
    packed.document["meshes"][0]["primitives"] = [
        {"attributes": attributes, "indices": first, "mode": 5},
        {"attributes": attributes, "indices": rest},
        {"attributes": attributes, "mode": 0},
    ]


@pytest.mark.filterwarnings("ignore:.*points and lines")
@pytest.mark.parametrize("change", [scaled_uv, turned_uv, quantised, sparse, morphed, skinned, strips])
def test_a_glb_however_it_is_packed(change, folder):
    packed = files.Packed.read(folder / "scan.glb")
    change(packed)
    packed.write(folder / "packed.glb")
    expected, found = (joined(folder, name) for name in ("scan.glb", "packed.glb"))
    expected, found = (
        corners({**mesh, "normals": 0 * mesh["normals"], "uv": np.round(mesh["uv"], 3)}) for mesh in (expected, found)
    )
    near = np.abs(found[:, None, :3] - expected[None, :, :3]).max(2).min(1)
    assert len(found) == len(expected) and near.max() < 2e-5
    np.testing.assert_allclose(found.mean(0), expected.mean(0), atol=1e-3)


def requires(name):
    return lambda packed: packed.document.update(extensionsRequired=["KHR_materials_unlit", name])


def loose(packed):
    skinned(packed)
    weights = np.tile(np.array([[1.0, 0, 0, 0]], "<f4"), (len(packed.values(0)), 1))
    weights[:7] = 0
    packed.head["attributes"]["WEIGHTS_0"] = packed.add(weights, 5126)


REFUSED = {
    "KHR_draco_mesh_compression, which is not read; export it without compression": requires("KHR_draco_mesh_compression"),
    "gltfpack without -c": requires("EXT_meshopt_compression"),
    "requires the extension KHR_mesh_variants, which is not read; export it without": requires("KHR_mesh_variants"),
    "'head' is drawn by EXT_mesh_gpu_instancing": lambda packed: packed.document["nodes"][1].update(
        extensions={"EXT_mesh_gpu_instancing": {}}
    ),
    "material 'skin': baseColorTexture and normalTexture lie on the mesh differently": lambda packed: textured(
        packed, base={"scale": [2, 2]}, normalTexture={}
    ),
    "'head' lie on TEXCOORD_2, which it lacks": lambda packed: textured(packed, base={"texCoord": 2}),
    "no joint holds 7 of": loose,
}  # fmt: skip


@pytest.mark.parametrize("message", REFUSED)
def test_unread_extensions_that_change_the_mesh_are_named(message, folder):
    packed = files.Packed.read(folder / "scan.glb")
    REFUSED[message](packed)
    packed.write(folder / "packed.glb")
    with pytest.raises(FaceError) as caught:
        read_pieces(folder / "packed.glb")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_parts_of_a_glb_that_are_left_out_are_named(folder):
    packed = files.Packed.read(folder / "scan.glb")
    strips(packed)
    packed.document["extensionsUsed"] = ["VRM", "KHR_materials_ior"]
    packed.write(folder / "packed.glb")
    with pytest.warns(MeshWarning) as messages:
        read_pieces(folder / "packed.glb")
    assert [str(warning.message).partition("packed.glb: ")[2] for warning in messages] == [
        "uses the extension VRM, which is not read; the mesh is taken without it",
        "points and lines of object 'head' are left out",
    ]


def test_damaged_files_are_read_or_refused_in_one_line(folder):
    """Bytes and numbers of a document changed at random: a mesh, or a `FaceError` of one line."""
    random = np.random.default_rng(3)
    document, blob = glb.unpacked((folder / "scan.glb").read_bytes())
    text = json.dumps(document)
    refused = 0
    for turn in range(300):
        path = folder / "damaged.glb"
        if turn % 2:
            numbers = [i for i, c in enumerate(text) if c.isdigit()]
            at = random.choice(numbers)
            changed = text[:at] + str(random.choice([0, 7, 99, 10**12, -1, 0.5])) + text[at + 1 :]
            try:
                path.write_bytes(glb.packed(json.loads(changed), blob))
            except json.JSONDecodeError:
                continue
        else:
            path.write_bytes(glb.packed(document, blob))
            data = bytearray(path.read_bytes())
            for _ in range(3):
                data[random.integers(0, 400)] = random.integers(0, 256)
            path.write_bytes(data[: random.integers(0, len(data))] if turn % 4 else data)
        try:
            read_pieces(path)
        except FaceError as error:
            refused += 1
            assert "\n" not in str(error) and str(error).startswith(str(path))
    assert refused > 100
