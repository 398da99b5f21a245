"""MaterialX: a document that MaterialX itself finds valid."""

import export_toy
import MaterialX as mx
import numpy as np
import pytest

from unshade import _native
from unshade.files.pictures import read_exr


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return export_toy.captured_once(tmp_path_factory)


@pytest.fixture(scope="module")
def made(capture, tmp_path_factory):
    out = tmp_path_factory.mktemp("materialx") / "asset"
    export_toy.exported(capture, out, "materialx")
    return out


def read(path):
    document = mx.createDocument()
    mx.readFromXmlFile(document, str(path))
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document.importLibrary(library)
    return document


def test_the_library_validates_it(made):
    valid, message = read(made / "face.mtlx").validate()
    assert valid, message


def test_a_broken_document_is_found(made, tmp_path):
    text = (made / "face.mtlx").read_text().replace('nodename="specular_weight"', 'nodename="nothing"')
    (tmp_path / "face.mtlx").write_text(text)
    assert not read(tmp_path / "face.mtlx").validate()[0]


def test_every_input_is_one_of_openpbr(made):
    document = read(made / "face.mtlx")
    shader = document.getNode("skin")
    definition = shader.getNodeDef()
    assert definition is not None and definition.getNodeString() == "open_pbr_surface"
    for given in shader.getInputs():
        assert definition.getActiveInput(given.getName()).getType() == given.getType()


def test_its_textures_hold_what_it_says(made, capture):
    document = read(made / "face.mtlx")
    for node in document.getNodeGraph("face_maps").getNodes("image"):
        assert (made / node.getInputValue("file")).is_file()
    albedo = read_exr(capture / "truth/specular_albedo.exr")["Y"]
    weight = _native.read_png(made / "textures/specular_weight.png")[..., 0] * 1.25
    # Reflectance at normal incidence is the weight times 0.04.
    np.testing.assert_allclose(weight * 0.04, albedo, atol=1e-6)
