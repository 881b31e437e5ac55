# SPDX-License-Identifier: Apache-2.0
"""Words for what people change of a picture, as keywords."""
import json
import subprocess
import sys
import types
import warnings

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


def extinction(picture, value):
    """The extinction at a value, as a share of the largest."""
    points = picture.scene["transfer_function"]["points"]
    at = [point["extinction"] for point in points]
    return np.interp(value, [point["value"] for point in points], at) / max(at)


def test_opacity_can_be_numbers(blob):
    spread = drawn(blob, opacity=[0, 0.25, 1], clim=(0.2, 0.8))
    for value, share in ((0.2, 0), (0.35, 0.125), (0.5, 0.25), (0.65, 0.625), (0.8, 1)):
        assert extinction(spread, value) == pytest.approx(share, abs=1e-6)
    assert np.array_equal(drawn(blob, opacity=np.array([0, 0.25, 1]), clim=(0.2, 0.8)).array, spread.array)
    assert np.array_equal(drawn(blob, opacity="0,.25,1", clim=(0.2, 0.8)).array, spread.array)
    # Pairs have values of their own, and are constant outside.
    pairs = drawn(blob, opacity=[(0.3, 0), (0.4, 0.5), (0.9, 0.2)])
    for value, share in ((0.3, 0), (0.35, 0.5), (0.4, 1), (0.65, 0.7), (0.9, 0.4), (0.95, 0.4)):
        assert extinction(pairs, value) == pytest.approx(share, abs=1e-6)


class Map:
    """Stands for one of matplotlib's colour maps: has what lamina asks of them."""

    def __init__(self, colors):
        self.colors, self.N = np.asarray(colors, float), len(colors)

    def __call__(self, index):
        return np.column_stack([self.colors[index], np.ones(len(index))])


def color(picture, value):
    points = picture.scene["transfer_function"]["points"]
    linear = [np.interp(value, [point["value"] for point in points], [point["color"][c] for point in points]) for c in range(3)]
    return [12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in linear]


def test_a_map_can_be_matplotlibs(blob, monkeypatch):
    many = Map([(i / 255, 0.5, 1 - i / 255) for i in range(256)])
    picture = drawn(blob, cmap=many, clim=(0.2, 0.8))
    # Points of lines in sRGB: colours are within 1/255.
    for value in (0.2, 0.3, 0.5, 0.8):
        share = (value - 0.2) / 0.6
        assert color(picture, value) == pytest.approx([share, 0.5, 1 - share], abs=1 / 255)
    few = drawn(blob, cmap=Map([(1, 0, 0), (0, 1, 0), (0, 0, 1)]), clim=(0, 1))
    for value, expected in ((0.1, [1, 0, 0]), (0.3, [1, 0, 0]), (0.36, [0, 1, 0]), (0.64, [0, 1, 0]), (0.9, [0, 0, 1])):
        assert color(few, value) == pytest.approx(expected, abs=1e-6)
    # A name that lamina has not is looked up there, and only then.
    monkeypatch.setitem(sys.modules, "matplotlib", types.SimpleNamespace(colormaps={"strange": many, "viridis": None}))
    assert np.array_equal(drawn(blob, cmap="strange", clim=(0.2, 0.8)).array, picture.array)
    drawn(blob, cmap="viridis")
    monkeypatch.setitem(sys.modules, "matplotlib", None)  # importing it is an ImportError
    with pytest.raises(lamina.Error, match="cmap: found 'strange', expected cividis, .*, a file, or a name of matplotlib, which is not installed"):
        drawn(blob, cmap="strange")
    monkeypatch.setitem(sys.modules, "matplotlib", types.SimpleNamespace(colormaps={}))
    with pytest.raises(lamina.Error, match="colormap strange: no such file, and no colour map has that name"):
        drawn(blob, cmap="strange")


def test_a_map_that_gives_nonsense_is_named(blob):
    class Broken(Map):
        def __init__(self, result):
            self.N, self.result = 40, result

        def __repr__(self):
            return "<broken>"

        def __call__(self, index):
            return self.result(len(index))

    def above_one(count):
        return np.linspace(0, 1.5, count * 4).reshape(count, 4)

    for result, kind, message in ((lambda n: np.zeros((3, 4)), TypeError, r"an array of shape \(3, 4\), expected \(40, 4\)"),
                                  (lambda n: np.zeros(n), TypeError, r"an array of shape \(40,\)"),
                                  (lambda n: [["red"] * 4] * n, TypeError, "<broken> gives no colours: could not convert"),
                                  (lambda n: 1 / 0, TypeError, "<broken> gives no colours: division by zero"),
                                  (lambda n: None, TypeError, "<broken> gives an array of shape"),
                                  (lambda n: np.full((n, 4), np.nan), ValueError, "gives nan in a colour, expected numbers"),
                                  (above_one, ValueError, "gives 1.0.* in a colour")):
        with pytest.raises(kind, match=message):
            drawn(blob, cmap=Broken(result))


def test_a_scenes_map_in_hu_on_other_data_is_warned_of(blob):
    bone = {"colormap": "ct-bone"}
    with pytest.warns(lamina.PictureWarning, match="transfer_function.colormap: found values from .* expected HU for ct-bone"):
        drawn(blob, transfer_function=bone)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*HU.*")
        drawn(blob, transfer_function={**bone, "colormap_range": [0, 1]})
        drawn(blob, transfer_function=bone, cmap="greys")
        drawn(lamina.Volume(blob.array * 2000 - 1000, spacing=(0.1, 0.1, 0.2)), transfer_function=bone)


def test_mistakes_are_named(blob):
    for words, message in (({"up": "z"}, "up z: expected"), ({"view": "north"}, "view north: expected"),
                           ({"preset": "bone"}, "preset bone: expected one of ct-bone"), ({"clip": "x"}, "clip x: expected"),
                           ({"preset": "ct-bone"}, "expected HU for ct-bone"), ({"clim": (2, 1)}, "range 2.0,1.0: expected"),
                           ({"opacity": [0, 2]}, "opacity 0.0,2.0: expected numbers from 0 to 1, found 2.0"), ({"opacity": [0, 0]}, "a number above 0"),
                           ({"opacity": [(1, 0), (0, 1)]}, "rising values, found 0 after 1")):
        with pytest.raises(lamina.Error, match=message):
            drawn(blob, **words)
    for words, message in (({"clim": 3}, "clim: found 3, expected two numbers"), ({"up": 3}, "up: found 3, expected a word"),
                           ({"zoom": "big"}, "zoom: found 'big', expected a number"),
                           ({"crop": (1, 2)}, "crop: found"), ({"opacity": [1]}, "opacity: found"),
                           ({"opacity": [(1, 2, 3), (1, 2, 3)]}, "opacity: found"), ({"cmap": 3}, "cmap: found 3"),
                           ({"light": False}, "light: found False, expected a word; lighting=False draws without light"),
                           ({"camera": 3}, "camera: found 3, expected a lamina.Camera, a dictionary"),
                           ({"transfer_function": "viridis"}, "found 'viridis', expected a lamina.TransferFunction"),
                           ({"transfer_function": [(0, "black", 0)]}, "expected a lamina.TransferFunction")):
        with pytest.raises(TypeError, match=message):
            drawn(blob, **words)
    for word in ("view", "opacity", "crop", "cmap"):
        with pytest.raises(ValueError, match=f"{word}: found '', expected a word"):
            drawn(blob, **{word: ""})


def test_a_turntable_keeps_the_height_of_its_eye(blob):
    camera = lamina.Camera.orbit(blob, 20, 35)
    middle = blob.bounds[0][1] + (blob.bounds[1][1] - blob.bounds[0][1]) / 2
    for degrees in (90, 180, 270):
        turned = camera.turned(degrees)
        assert turned.eye[1] == pytest.approx(camera.eye[1])
        assert turned.up == (0, 1, 0) and turned.center[1] == pytest.approx(middle)
