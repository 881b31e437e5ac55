# SPDX-License-Identifier: Apache-2.0
"""Files outside a folder are not opened, whoever names them."""
import json

import numpy as np
import pytest

import lamina


@pytest.fixture
def uploads(tmp_path):
    folder = tmp_path / "uploads"
    folder.mkdir()
    samples = np.arange(64, dtype=np.uint8).reshape(4, 4, 4)
    for place in (tmp_path, folder):
        lamina.Volume(samples).save(place / "own.nrrd")
        (place / "own.raw").write_bytes(samples.tobytes())
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: {}own.raw\n\n"
    (folder / "good.nhdr").write_text(header.format(""))
    (folder / "bad.nhdr").write_text(header.format("../"))
    return folder


def test_files_and_what_they_name(uploads):
    for good in (uploads / "own.nrrd", uploads / "good.nhdr"):
        assert lamina.read(good, only_below=uploads).array.shape == (4, 4, 4)
        assert lamina.render(good, size=(8, 6), context="cpu", only_below=uploads).array.shape == (6, 8, 4)
    for bad in (uploads / "bad.nhdr", uploads.parent / "own.nrrd"):
        lamina.read(bad)
        for call in (lamina.read, lamina.render, lamina.trace, lamina.Session):
            with pytest.raises(lamina.Error, match="not opened: it is not below"):
                call(bad, only_below=uploads)
    with pytest.raises(lamina.Error, match="not opened"):
        lamina.read(uploads / "bad.nhdr", only_below=uploads, channel=0)


def test_meshes(uploads):
    tet = lamina.Mesh(np.eye(4, 3), [[0, 1, 2, 3]], {"s": np.arange(4.0)})
    for place in (uploads, uploads.parent):
        tet.save(place / "tet.vtu")
    assert len(lamina.read(uploads / "tet.vtu", only_below=uploads).tets) == 1
    with pytest.raises(lamina.Error, match="not opened"):
        lamina.read(uploads.parent / "tet.vtu", only_below=uploads)


def test_scenes_cannot_lift_it(uploads):
    """Neither a scene nor one that is changed later."""
    scene = {"version": 1, "volume": str(uploads / "good.nhdr"), "image": {"width": 8, "height": 6}}
    (uploads / "scene.json").write_text(json.dumps({**scene, "volume": "bad.nhdr"}))
    with pytest.raises(lamina.Error, match="not opened"):
        lamina.render(uploads / "scene.json", context="cpu", only_below=uploads)
    session = lamina.Session(scene, context="cpu", only_below=uploads)
    before = session.draw().array
    (uploads.parent / "map.json").write_text(json.dumps([{"ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 9, 1, 1, 1]}]))
    mapped = {"colormap": str(uploads.parent / "map.json"), "points": [{"value": 0, "extinction": 1}]}
    with pytest.raises(lamina.Error, match="not opened"):
        session.set(transfer_function=mapped)
    assert np.array_equal(session.draw().array, before)
    lamina.Session(scene, mapped, context="cpu")


def test_the_folder_must_be_one(uploads):
    for wrong in ("", uploads / "absent", uploads / "own.raw"):
        with pytest.raises(lamina.Error, match="only_below"):
            lamina.read(uploads / "own.nrrd", only_below=wrong)
