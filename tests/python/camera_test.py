# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import lamina


def test_look_at():
    camera = lamina.Camera.look_at((1, 2, 3), (0, 0, 0), fov_y=30)
    assert camera == lamina.Camera((1, 2, 3), (0, 0, 0), (0, 1, 0), 30)
    flat = lamina.Camera.look_at(np.array([1, 2, 3]), (0, 0, 0), (0, 0, 1), height=4)
    assert flat.projection == "orthographic" and flat.height == 4
    assert flat.to_scene() == {"eye": [1, 2, 3], "center": [0, 0, 0], "up": [0, 0, 1], "fov_y": 40, "height": 4,
                               "projection": "orthographic"}


def test_orbit_sees_the_box_from_its_sides(blob):
    lowest, highest = np.array(blob.bounds)
    camera = lamina.Camera.orbit(blob)
    away = np.subtract(camera.eye, camera.center)
    assert np.allclose(camera.center, (lowest + highest) / 2) and np.allclose(away[:2], 0) and away[2] > 0
    right = np.subtract(lamina.Camera.orbit(blob, 90).eye, camera.center)
    assert right[0] > 0 and np.allclose(right[1:], 0)
    above = np.subtract(lamina.Camera.orbit(blob, 0, 90).eye, camera.center)
    assert above[1] > 0 and np.allclose(above[[0, 2]], 0)


def test_fit_is_the_automatic_camera(blob, function):
    picture = lamina.render(blob, function, size=(64, 48))
    camera = lamina.Camera.fit(blob, function, size=(64, 48))
    assert camera.to_scene() == picture.scene["camera"]
    around = lamina.Camera.fit(blob, function, azimuth=40, size=(64, 48))
    shown = lamina.render(blob, function, camera=around, size=(64, 48)).array[:, :, 3] > 0
    # It touches two opposite edges up to a margin of 1/25.
    assert shown.any() and (shown[2:-2, 1].any() or not shown[:1].any())
    assert lamina.Camera.fit(blob).projection == "perspective"


def test_turned_goes_right_round():
    camera = lamina.Camera((3, 1, 2), (1, 1, 1), (0, 1, 0))
    assert np.allclose(camera.turned(360).eye, camera.eye, atol=1e-14)
    assert np.allclose(camera.turned(120).turned(240).eye, camera.eye, atol=1e-14)


@pytest.mark.parametrize("arguments, error", [
    (dict(eye=(0, 0), center=(0, 0, 0)), ValueError),
    (dict(eye=3, center=(0, 0, 0)), TypeError),
    (dict(eye=(0, 0, np.inf), center=(0, 0, 0)), ValueError),
    (dict(eye=(0, 0, 1), center=(0, 0, 0), projection="fisheye"), ValueError),
])
def test_other_cameras_are_refused(arguments, error):
    with pytest.raises(error):
        lamina.Camera(**arguments)


def test_a_camera_that_sees_nothing_is_an_error(blob):
    with pytest.raises(lamina.Error, match="camera"):
        lamina.render(blob, camera=lamina.Camera((0, 0, 1), (0, 0, 1)))


def test_angles_that_are_no_numbers_are_named(blob):
    with pytest.raises(TypeError, match="azimuth: found 'x', expected a number"):
        lamina.Camera.orbit(blob, azimuth="x")


def test_cameras_of_arrays_are_refused(blob):
    for make in (lamina.Camera.orbit, lamina.Camera.fit):
        with pytest.raises(TypeError, match="data: found ndarray, expected a lamina.Volume or a lamina.Mesh"):
            make(blob.array)
