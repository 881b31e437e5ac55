# SPDX-License-Identifier: Apache-2.0
"""Words for what people change of a picture, as keywords."""
import json
import subprocess

import numpy as np
import pytest

import lamina

SIZE = (40, 30)


def drawn(blob, **words):
    return lamina.render(blob, size=SIZE, context="cpu", **words)


def test_words_are_those_of_the_command_line(blob, program, tmp_path):
    blob.save(tmp_path / "v.nrrd")
    options = ["--view", "left", "--up", "+z", "--elevation", "12", "--light", "two", "--clip", "x<2", "--opacity", "sigmoid_4",
               "--colormap", "inferno", "--range", "0.1,0.9", "--density", "2", "--zoom", "1.5"]
    written = subprocess.run([program, "scene", tmp_path / "v.nrrd", "-o", "-", "--size", "40x30", "--quiet", *options],
                             check=True, capture_output=True, text=True).stdout
    picture = drawn(str(tmp_path / "v.nrrd"), view="left", up="+z", elevation=12, light="two", clip="x<2", opacity="sigmoid_4",
                    cmap="inferno", clim=(0.1, 0.9), density=2, zoom=1.5)
    scene, expected = picture.scene, json.loads(written)
    for key in ("camera", "transfer_function", "lighting", "clip"):
        assert scene[key] == expected[key], key
    assert np.array_equal(picture.array, drawn(lamina.Scene(expected)).array)


def test_a_crop_is_a_box_or_planes(blob):
    box = drawn(blob, crop=((0.5, 1.5), (0.2, 1.2), (0, 2))).scene["clip"]
    assert box == {"box": {"min": [0.5, 0.2, 0], "max": [1.5, 1.2, 2]}}
    planes = drawn(blob, crop=((0.5, None), (None, None), (None, 2))).scene["clip"]["planes"]
    assert planes == [{"point": [0.5, 0, 0], "normal": [1, 0, 0]}, {"point": [0, 0, 2], "normal": [0, 0, -1]}]
    assert drawn(blob, crop="0.5:1.5,0.2:1.2,0:2").scene["clip"] == box


def test_a_session_takes_words_at_any_time(blob, function):
    session = lamina.Session(blob, function, size=SIZE, context="cpu")
    first = session.draw()
    session.set(view="top", light=True)
    assert session.scene["lighting"]["lights"] == [{"direction": "headlight", "color": [1, 1, 1]}]
    assert session.draw().compare(first).linf > 1
    fresh = lamina.render(blob, function, size=SIZE, context="cpu", view="top", light=True)
    assert np.array_equal(session.draw().array, fresh.array)
    camera = session.camera
    session.set(lighting=False)
    assert "lighting" not in session.resolved_scene and session.camera == camera


def test_a_traced_picture_has_its_words(blob, function):
    truth = lamina.trace(blob, function, size=(16, 12), up="+z", clip=["x<1.5"])
    picture = lamina.render(blob, function, size=(16, 12), up="+z", clip=["x<1.5"], context="cpu")
    assert picture.compare(truth).linf < 1


def test_mistakes_are_named(blob):
    for words, message in (({"up": "z"}, "up z: expected"), ({"view": "north"}, "view north: expected"),
                           ({"preset": "bone"}, "preset bone: expected one of ct-bone"), ({"clip": "x"}, "clip x: expected"),
                           ({"preset": "ct-bone"}, "expected HU for ct-bone"), ({"clim": (2, 1)}, "range 2.0,1.0: expected")):
        with pytest.raises(lamina.Error, match=message):
            drawn(blob, **words)
    for words, message in (({"clim": 3}, "clim: found 3, expected two numbers"), ({"up": 3}, "up: found 3, expected a word"),
                           ({"zoom": "big"}, "zoom: found 'big', expected a number"),
                           ({"crop": (1, 2)}, "crop: found")):
        with pytest.raises(TypeError, match=message):
            drawn(blob, **words)


def test_a_turntable_keeps_the_height_of_its_eye(blob):
    camera = lamina.Camera.orbit(blob, 20, 35)
    middle = blob.bounds[0][1] + (blob.bounds[1][1] - blob.bounds[0][1]) / 2
    for degrees in (90, 180, 270):
        turned = camera.turned(degrees)
        assert turned.eye[1] == pytest.approx(camera.eye[1])
        assert turned.up == (0, 1, 0) and turned.center[1] == pytest.approx(middle)
