# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import lamina

POINTS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)], np.float32)
TETS = [(0, 1, 2, 3), (1, 2, 3, 4)]


def test_what_goes_in_comes_out():
    mesh = lamina.Mesh(POINTS, np.array(TETS, np.uint64), {"a": np.arange(5, dtype=np.int8), "b": [1, 2]})
    assert np.array_equal(mesh.points, POINTS) and np.array_equal(mesh.tets, TETS)
    assert mesh.points.dtype == np.float64 and mesh.tets.dtype == np.int32
    assert {name: list(values) for name, values in mesh.scalars.items()} == {"a": [0, 1, 2, 3, 4], "b": [1, 2]}
    assert mesh.bounds == ((0, 0, 0), (1, 1, 1))
    with pytest.raises(ValueError):
        mesh.points[0, 0] = 1


def test_one_tet_in_closed_form():
    """Along its height h a tet of a constant value has the opacity 1 - exp(-extinction * length)."""
    mesh = lamina.Mesh([(-1, -1, 0), (2, -1, 0), (-1, 2, 0), (0, 0, 3)], [(0, 1, 2, 3)], [1, 1, 1, 1])
    function = lamina.TransferFunction([(1, "white", 0.7)])
    camera = lamina.Camera.look_at((0, 0, 5), (0, 0, 0), height=1e-6)
    for picture in (lamina.trace(mesh, function, camera=camera, size=(1, 1)),
                    lamina.render(mesh, function, camera=camera, size=(1, 1))):
        # The ray is at (0, 0) up to a millionth; float32 of the renderer: 2^-24 of 1 at some 10 steps.
        assert abs(picture.array[0, 0, 3] - -np.expm1(-0.7 * 3)) < 1e-5


def test_values_of_tets_are_averaged_to_points():
    function = lamina.TransferFunction([(0, "white", 0), (2, "white", 4)])
    mesh = lamina.Mesh(POINTS, TETS, [1, 1])
    at_points = lamina.Mesh(POINTS, TETS, [1] * 5)
    a, b = (lamina.trace(each, function, size=(16, 12)).array for each in (mesh, at_points))
    assert a.max() > 0 and np.allclose(a, b, atol=1e-12)


def test_the_scalar_is_named():
    mesh = lamina.Mesh(POINTS, TETS, {"zero": np.zeros(5), "one": np.ones(5)})
    function = lamina.TransferFunction([(0, "white", 0), (1, "white", 4)])
    camera = lamina.Camera.orbit(mesh)
    assert lamina.trace(mesh, function, camera=camera, size=(8, 6)).array.max() == 0
    assert lamina.trace(mesh, function, camera=camera, size=(8, 6), scalar="one").array.max() > 0
    with pytest.raises(lamina.Error, match="scalar: found \"two\""):
        lamina.render(mesh, function, scalar="two")


@pytest.mark.parametrize("arguments, error, message", [
    ((POINTS[:, :2], TETS, [0] * 5), ValueError, r"points: found the shape \(5, 2\), expected \(N, 3\)"),
    ((POINTS, [(0, 1, 2)], [0] * 5), ValueError, r"tets: found the shape \(1, 3\), expected \(M, 4\)"),
    ((POINTS, [(0, 1, 2, 5)], [0] * 5), ValueError, "tets: found the corner 5, expected 0 to 4"),
    ((POINTS, [(0, 1, 2, -1)], [0] * 5), ValueError, "tets: found the corner -1"),
    ((POINTS, np.array(TETS) / 1.0, [0] * 5), TypeError, "tets: found the type float64, expected whole numbers"),
    ((POINTS, TETS, [0] * 3), ValueError, r"scalar: found the shape \(3,\), expected \(5,\), one a point, or \(2,\)"),
    ((POINTS, TETS, {"a": ["x"] * 5}), TypeError, "a: found the type <U1"),
    ((POINTS, TETS, {}), ValueError, "values: found none"),
    ((POINTS * np.nan, TETS, [0] * 5), ValueError, "points: found a coordinate that is not finite"),
    ((POINTS[:0], TETS, []), ValueError, "points: found the shape"),
])
def test_other_meshes_are_refused(arguments, error, message):
    with pytest.raises(error, match=message):
        lamina.Mesh(*arguments)


def test_a_mesh_of_a_volume(blob, function):
    kuhn = lamina.mesh(blob, kuhn=True)
    assert len(kuhn.tets) == 6 * 23 * 19 * 15 == kuhn.report["kuhn_tets"]
    assert kuhn.bounds == blob.bounds
    coarse = lamina.mesh(blob, 0.05, transfer_function=function)
    assert coarse.report["within_tolerance"] and len(coarse.tets) < len(kuhn.tets)
    values_at = {tuple(point): value for point, value in zip(kuhn.points, kuhn.values)}
    assert values_at[blob.bounds[1]] == blob.array[-1, -1, -1]
    with pytest.raises(ValueError, match="tolerance"):
        lamina.mesh(blob, 0)
    with pytest.raises(lamina.Error, match="tets"):
        lamina.mesh(blob, kuhn=True, max_tets=100)
    with pytest.warns(lamina.PictureWarning, match=r"the mesh stopped at \d+ tets \(max_tets\): it differs"):
        lamina.mesh(blob, max_tets=10)


def test_meshes_are_made_of_files(blob, tmp_path):
    blob.save(tmp_path / "blob.nrrd")
    made = lamina.mesh(tmp_path / "blob.nrrd", 0.2)
    assert np.array_equal(made.points, lamina.mesh(blob, 0.2).points)
    made.save(tmp_path / "a.vtu")
    for mesh in (made, tmp_path / "a.vtu"):
        with pytest.raises(TypeError, match="volume: found a mesh"):
            lamina.mesh(mesh)
    with pytest.raises(TypeError, match="array: found 'a.nrrd', expected numbers; lamina.read reads files"):
        lamina.Volume("a.nrrd")


def test_meshes_come_back_from_files(blob, tmp_path):
    made = lamina.mesh(blob, 0.1)
    made.save(tmp_path / "a.vtu")
    again = lamina.read(tmp_path / "a.vtu")
    assert np.array_equal(again.points, made.points) and np.array_equal(again.tets, made.tets)
    assert np.array_equal(again.values, made.values) and again.file == tmp_path / "a.vtu"


def test_a_scene_makes_its_mesh_from_a_volume_in_memory(blob, function):
    picture = lamina.render(blob, function, method="project", mesh={"tolerance": 0.05}, size=(32, 24))
    truth = lamina.trace(blob, function, camera=picture.scene["camera"], size=(32, 24), mesh={"tolerance": 0.05},
                         trace={"of": "mesh"})
    # Tets are drawn in float32 from the same mesh; max_error's default is 1/255.
    assert picture.compare(truth).linf < 1 and picture.array.max() > 0
