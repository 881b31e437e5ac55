# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import lamina

SLOPE = np.array([1.5, -2, 0.25])
# Numbers below 64, and some 30 roundings.
TOLERANCE = 30 * 64 * np.finfo(float).eps


def test_volumes_match_a_linear_field():
    z, y, x = np.mgrid[0:5, 0:4, 0:6].astype(np.float32)
    spacing, origin = np.array([0.5, 1, 2]), np.array([1, -2, 3])
    places = origin + spacing * np.stack([x, y, z], axis=-1)
    values = (3 + places @ SLOPE).astype(np.float32)      # exact: multiples of 1/8 below 2^6
    sampler = lamina.Sampler(lamina.Volume(values, spacing=spacing, origin=origin))
    points = origin + spacing * np.random.default_rng(1).random((7, 9, 3)) * (5, 3, 4)
    found, gradients = sampler.at(points)
    assert found.shape == (7, 9) and gradients.shape == (7, 9, 3)
    assert np.abs(found - (3 + points @ SLOPE)).max() < TOLERANCE
    assert np.abs(gradients - SLOPE).max() < TOLERANCE


def test_meshes_match_a_linear_field():
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    mesh = lamina.Mesh(points, [(0, 1, 2, 3)], {"other": np.zeros(4), "field": 3 + points @ SLOPE})
    inside = np.random.default_rng(2).dirichlet((1, 1, 1, 1), 50) @ points
    found, gradients = lamina.Sampler(mesh, "field").at(inside)
    assert np.abs(found - (3 + inside @ SLOPE)).max() < TOLERANCE
    assert np.abs(gradients - SLOPE).max() < TOLERANCE
    assert (lamina.Sampler(mesh).at(inside)[0] == 0).all()
    mesh = lamina.Mesh(points, [(0, 1, 2, 3)], {"heat": np.array([7.])})
    with pytest.warns(lamina.PictureWarning, match='"heat" is cell data: averaged to points'):
        assert (lamina.Sampler(mesh).at(inside)[0] == 7).all()


def test_outside_is_nan():
    values, gradients = lamina.Sampler(np.ones((3, 3, 3), np.uint8)).at([(1, 1, 1), (2.1, 1, 1), (np.nan, 1, 1)])
    assert values[0] == 1 and np.isnan(values[1:]).all() and np.isnan(gradients[1:]).all()


def test_what_makes_no_sense_is_refused():
    sampler = lamina.Sampler(np.ones((3, 3, 3), np.uint8))
    with pytest.raises(ValueError, match=r"points: found the shape \(2, 2\), expected \(..., 3\)"):
        sampler.at(np.zeros((2, 2)))
    with pytest.raises(TypeError, match="scalar"):
        lamina.Sampler(np.ones((3, 3, 3), np.uint8), "heat")
    mesh = lamina.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)], [0, 1, 2, 3])
    with pytest.raises(lamina.Error, match="heat"):
        lamina.Sampler(mesh, "heat")
