# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest

import lamina


def opacity_through(function, value, length):
    """Opacity of a homogeneous box of this value and thickness, seen straight on."""
    box = lamina.Volume(np.full((2, 2, 2), value, np.float32), spacing=(length, length, length))
    camera = lamina.Camera.look_at((length / 2, length / 2, 2 * length), (length / 2,) * 3, height=length / 2)
    return lamina.trace(box, function, camera=camera, size=(1, 1)).array[0, 0, 3]


def test_extinction():
    function = lamina.TransferFunction([(0, "white", 0), (1, "white", 2)])
    assert abs(opacity_through(function, 0.5, 1.5) - -np.expm1(-1.5)) < 1e-12


def test_opacity_is_that_of_its_unit_length():
    function = lamina.TransferFunction.from_opacity([(0, "white", 0.3), (1, "white", 0.3)], unit_length=0.5)
    assert abs(opacity_through(function, 0.5, 1.5) - (1 - 0.7 ** 3)) < 1e-12


def test_colors_of_all_forms(blob):
    values = {"#ff8019": (1, 0.2158605, 0.009721217), "tomato": (1, 0.12477182, 0.06301002),
              (0.25, 0.5, 1): (0.25, 0.5, 1)}
    for color, linear in values.items():
        function = lamina.TransferFunction([(0, color, 1), (1, color, 1)])
        r, g, b, a = lamina.trace(blob, function, size=(9, 9)).array[4, 4]
        # 1e-7: the linear values above have 8 digits.
        assert np.allclose((r / a, g / a, b / a), linear, atol=1e-7)
    srgb = lamina.TransferFunction([(0, {"srgb": [1, 128 / 255, 25 / 255]}, 1)])
    r, g, b, a = lamina.trace(blob, srgb, size=(9, 9)).array[4, 4]
    assert np.allclose((r / a, g / a, b / a), values["#ff8019"], atol=1e-7)


def test_colormaps(blob):
    for name in lamina.colormaps:
        own = {} if name.startswith("ct-") else {"extinction": [(0, 0), (1, 3)]}
        function = lamina.TransferFunction.colormap(name, **own)
        assert lamina.render(blob, function, size=(8, 6)).array.shape == (6, 8, 4)
    # Without a range it is stretched over the data's.
    free = lamina.TransferFunction.colormap("viridis", extinction=[(0, 1)])
    range_ = (float(blob.array.min()), float(blob.array.max()))
    given = lamina.TransferFunction.colormap("viridis", range=range_, extinction=[(0, 1)])
    pictures = [lamina.render(blob, function, size=(8, 6), context="cpu") for function in (free, given)]
    assert np.array_equal(pictures[0].array, pictures[1].array) and pictures[0].array.max() > 0


def test_paraview_preset(blob, tmp_path):
    preset = tmp_path / "preset.json"
    preset.write_text(json.dumps([{"Name": "mine", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 0.5, 0.25],
                                   "Points": [0, 0, 0.5, 0, 1, 0.5, 0.5, 0]}]))
    function = lamina.TransferFunction.from_paraview(preset, range=(0, 1))
    same = lamina.TransferFunction.from_opacity([(0, "black", 0), (1, {"srgb": [1, 0.5, 0.25]}, 0.5)])
    a, b = (lamina.trace(blob, each, size=(8, 6), color_space="display").array for each in (function, same))
    assert np.allclose(a, b, atol=1e-9) and a.max() > 0
    with pytest.raises(lamina.Error, match="nowhere.json"):
        lamina.render(blob, lamina.TransferFunction.from_paraview("nowhere.json"))


@pytest.mark.parametrize("points, error, message", [
    ([], ValueError, "points: found none"),
    ([(0, "red")], TypeError, r"points.0: found \(0, 'red'\), expected \(value, color, extinction\)"),
    ([(0, "red", 1), 5], TypeError, "points.1: found 5"),
    ([("a", "red", 1)], TypeError, "points.0.value: found 'a', expected a number"),
    ([(0, "red", float("nan"))], ValueError, "points.0.extinction: found nan, expected a finite number"),
    ([(0, "red", None)], TypeError, "points.0.extinction: found None"),
])
def test_other_points_are_refused(points, error, message):
    with pytest.raises(error, match=message):
        lamina.TransferFunction(points)


@pytest.mark.parametrize("points, message", [
    ([(1, "red", 0), (0, "red", 1)], "points.1.value"),
    ([(0, "red", -1)], "points.0.extinction"),
    ([(0, "no colour", 1)], "points.0.color"),
    ([(0, (1, 2), 1)], "points.0.color"),
])
def test_what_no_scene_could_have_is_an_error(blob, points, message):
    with pytest.raises(lamina.Error, match=message):
        lamina.render(blob, lamina.TransferFunction(points))


def test_numbers_of_numpy_are_numbers(blob, function):
    points = [(np.float32(point["value"]), np.array([0.5, 0.25, 0.125]), np.int64(2)) for point in function.points]
    assert json.loads(json.dumps(lamina.TransferFunction(points).to_scene()))["points"][0]["color"] == [0.5, 0.25, 0.125]
