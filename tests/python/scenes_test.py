# SPDX-License-Identifier: Apache-2.0
import json
import subprocess

import numpy as np
import pytest

import lamina

SCENE = {"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}, "image": {"width": 20, "height": 15}}


def test_dictionaries_files_and_scenes_are_one(tmp_path):
    (tmp_path / "a.json").write_text(json.dumps(SCENE))
    forms = [SCENE, lamina.Scene(SCENE), str(tmp_path / "a.json"), tmp_path / "a.json",
             lamina.Scene.load(tmp_path / "a.json")]
    pictures = [lamina.render(form, context="cpu").array for form in forms]
    assert all(np.array_equal(pictures[0], other) for other in pictures[1:])


def test_keywords_are_the_keys_of_files():
    session = lamina.Session(SCENE, size=(9, 7), background="red", color_space="display", method="slice", target="fixed8",
                             max_error=3, slice={"samples": 5, "classification": "post"}, nan="transparent",
                             camera={"eye": [2, 2, 2], "center": [0.5, 0.5, 0.5]}, width=11,
                             emulate={"bits": 6}, trace={"tolerance": 1e-4}, clip={"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
                             set={"image.height": 8, "render.slice.order": "front_to_back", "camera.eye.0": 3})
    scene = session.resolved_scene
    assert scene["image"] == {"width": 11, "height": 8, "color_space": "display", "background": [1, 0, 0],
                              "transparent": False, "png_bits": 8}
    assert scene["render"]["target"] == "fixed8" and scene["render"]["max_error"] == 3
    assert scene["render"]["slice"]["samples"] == 5 and scene["render"]["slice"]["order"] == "front_to_back"
    assert scene["render"]["emulate"]["bits"] == 6 and scene["render"]["trace"]["tolerance"] == 1e-4
    assert scene["camera"]["eye"] == [3, 2, 2] and scene["nan"] == "transparent"
    assert SCENE["image"] == {"width": 20, "height": 15}  # the caller's is left alone


def test_lighting(blob, function):
    light = lamina.Lighting(ambient=0.2, lights=[lamina.Light((1, 1, 1), "#ffeedd"), lamina.Light()])
    lit = lamina.render(blob, function, lighting=light, size=(32, 24), context="cpu")
    keys = lit.scene["lighting"]
    assert keys["ambient"] == 0.2 and keys["lights"][0]["direction"] == [1, 1, 1]
    unlit = lamina.render(blob, function, camera=lit.scene["camera"], size=(32, 24), context="cpu")
    assert lit.compare(unlit).linf > 5
    # Opacity stays what it is: each is within max_error, 1/255, of the truth.
    assert np.abs(lit.array[:, :, 3] - unlit.array[:, :, 3]).max() < 2 / 255
    assert lit.compare(lamina.trace(lit.scene)).linf < 1
    with pytest.raises(lamina.Error, match="lighting.power"):
        lamina.render(blob, function, lighting=lamina.Lighting(power=0.5), context="cpu")


@pytest.mark.parametrize("scene, keywords, error, message", [
    (SCENE, {"title": "a"}, TypeError, "unexpected keyword 'title', which annotations"),
    (SCENE, {"legend": True}, TypeError, "unexpected keyword 'legend', expected annotations"),
    (SCENE, {"lookup": "nearest"}, TypeError, "unexpected keyword 'lookup', which lamina.Volume takes"),
    (SCENE, {"set": {"mesh.scalar": "p"}}, ValueError, "mesh.scalar: expected 'scalar'"),
    (SCENE, {"cmaera": 1}, TypeError, "unexpected keyword 'cmaera', did you mean 'camera'"),
    (SCENE, {"range": (0, 1)}, TypeError, r"unexpected keyword 'range', expected clim=\(LO, HI\)"),
    (SCENE, {"vmin": 0}, TypeError, r"unexpected keyword 'vmin', expected clim=\(LO, HI\)"),
    (SCENE, {"color": "red"}, TypeError, "unexpected keyword 'color', expected cmap"),
    (SCENE, {"alpha": 1}, TypeError, "unexpected keyword 'alpha', expected opacity"),
    (SCENE, {"turntable": 24}, TypeError, r"unexpected keyword 'turntable': lamina.Session\(data\).turntable"),
    (SCENE, {"output": "a.png"}, TypeError, r"unexpected keyword 'output': lamina.render\(data\).save"),
    (SCENE, {"method": "splat"}, lamina.Error, "scene: render.method: found \"splat\", expected one of \"slice\""),
    (SCENE, {"slice": {"smaples": 3}}, lamina.Error, "render.slice.smaples.*samples"),
    (SCENE, {"size": "800x600"}, TypeError, "size: found '800x600', expected \\(width, height\\)"),
    (SCENE, {"size": (0, 1)}, lamina.Error, "image.width"),
    (SCENE, {"set": 3}, TypeError, "set: found 3, expected a dictionary, as in .*render.slice.samples"),
    (SCENE, {"set": {"image.width.x": 3}}, ValueError, "'x' is not inside an object"),
    (SCENE, {"camera": object()}, TypeError, "camera: found object"),
    (SCENE, {"max_error": float("nan")}, ValueError, "max_error: found nan, expected a finite number"),
    ({"version": 2}, {}, lamina.Error, "version"),
    ({"version": 1}, {}, lamina.Error, "volume"),
    ({"version": 1, "volume": "nowhere.nrrd"}, {}, lamina.Error, "nowhere.nrrd"),
    ("nowhere.json", {}, lamina.Error, "nowhere.json"),
    ([1, 2], {}, TypeError, "found list, expected a Volume"),
])
def test_bad_scenes(scene, keywords, error, message):
    with pytest.raises(error, match=message):
        lamina.render(scene, **keywords)


def test_bad_files(tmp_path):
    file = tmp_path / "a.json"
    for text, message in [("{", "a.json: found no JSON"), ("[]", "found no object"),
                          ('{"version": 1, "version": 1}', "stands twice")]:
        file.write_text(text)
        with pytest.raises(lamina.Error, match=message):
            lamina.render(file)
    file.write_text(json.dumps(SCENE))
    with pytest.raises(lamina.Error, match="holds a scene"):
        lamina.read(file)
    with pytest.raises(lamina.Error, match="nowhere: no such file"):
        lamina.read(tmp_path / "nowhere")
    assert not (tmp_path / "b.json").exists()


def test_relative_paths_start_at_the_scene(blob, function, tmp_path):
    blob.save(tmp_path / "blob.nrrd")
    scene = {"version": 1, "volume": "blob.nrrd", "image": {"width": 20, "height": 15},
             "transfer_function": function.to_scene()}
    (tmp_path / "a.json").write_text(json.dumps(scene))
    expected = lamina.render(blob, function, size=(20, 15), context="cpu").array
    for form in (tmp_path / "a.json", lamina.Scene(scene, folder=tmp_path)):
        assert np.array_equal(lamina.render(form, context="cpu").array, expected)
    lamina.Scene.load(tmp_path / "a.json").save(tmp_path / "b.json")
    assert np.array_equal(lamina.render(tmp_path / "b.json", context="cpu").array, expected)


@pytest.mark.parametrize("method", ["slice", "project", "trace"])
def test_the_command_line_repeats_a_picture(blob, function, method, program, tmp_path):
    keywords = {"mesh": {"tolerance": 0.1}, "method": method} if method == "project" else {"method": method}
    picture = lamina.render(blob, function, size=(40, 30), context="cpu", **keywords)
    picture.scene.save(tmp_path / "scene.json")
    assert (tmp_path / "scene.nrrd").exists()
    subprocess.run([program, "render", tmp_path / "scene.json", "-o", tmp_path / "a.exr", "--context", "cpu", "--quiet"],
                   check=True)
    assert picture.compare(tmp_path / "a.exr").linf == 0


def test_nothing_half_is_left(blob, tmp_path):
    with pytest.raises(lamina.Error, match="nowhere.*cannot write"):
        lamina.Scene(SCENE).save(tmp_path / "nowhere" / "a.json")
    (tmp_path / "folder").mkdir()
    with pytest.raises(lamina.Error, match="folder: cannot write"):
        lamina.Scene(SCENE).save(tmp_path / "folder")
    with pytest.raises(lamina.Error, match=r's\.png: found the suffix "\.png", expected a name as s\.json'):
        lamina.Scene(SCENE).save(tmp_path / "s.png")
    assert not (tmp_path / "s.png").exists()
    assert [file.name for file in tmp_path.iterdir()] == ["folder"]


def test_a_mesh_in_memory_is_kept_beside_its_scene(blob, function, program, tmp_path):
    mesh = lamina.mesh(blob, 0.1)
    picture = lamina.render(mesh, function, size=(40, 30), context="cpu")
    picture.scene.save(tmp_path / "scene.json")
    subprocess.run([program, "render", tmp_path / "scene.json", "-o", tmp_path / "a.exr", "--context", "cpu", "--quiet"],
                   check=True)
    assert picture.compare(tmp_path / "a.exr").linf == 0


def test_data_files_are_drawn_as_the_command_line_draws_them(blob, program, tmp_path):
    blob.save(tmp_path / "blob.nrrd")
    picture = lamina.render(tmp_path / "blob.nrrd", size=(40, 30), context="cpu")
    subprocess.run([program, "render", tmp_path / "blob.nrrd", "-o", tmp_path / "a.exr", "--context", "cpu", "--quiet",
                    "--size", "40x30"], check=True)
    assert picture.compare(tmp_path / "a.exr").linf == 0
    assert picture.scene["volume"] == str(tmp_path / "blob.nrrd")
    assert lamina.render(lamina.read(tmp_path / "blob.nrrd"), size=(8, 6)).scene["volume"] == str(tmp_path / "blob.nrrd")
