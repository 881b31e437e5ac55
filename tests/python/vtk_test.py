# SPDX-License-Identifier: Apache-2.0
"""lamina.vtk against VTK 9 (python3-vtk9) on a display of its own (xvfb)."""
import math
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import lamina

vtk = pytest.importorskip("vtk", reason="python3-vtk9 is not installed")
from vtk.util import numpy_support  # noqa: E402

import lamina.vtk  # noqa: E402
from vtk_scenes import (WARM, ball, from_inside_the_margin, functions, image_mapper, parallel, perspective,  # noqa: E402
                        place_of, rolled_with_a_horizontal_angle, scene_of, tet_mapper)


@pytest.fixture(scope="module", autouse=True)
def display():
    if os.environ.get("DISPLAY"):
        yield
        return
    if not shutil.which("Xvfb"):
        pytest.skip("no display, and xvfb is not installed")
    # It ends itself when its last client does: VTK's windows live as long as this process, and must not outlive it.
    server = subprocess.Popen(["Xvfb", "-terminate", "-displayfd", "1", "-screen", "0", "640x480x24"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    os.environ["DISPLAY"] = ":" + server.stdout.readline().strip()
    os.environ["LP_NUM_THREADS"] = str(len(os.sched_getaffinity(0)))
    first = vtk.vtkRenderWindow()  # stays connected from the first test to the last
    first.SetOffScreenRendering(1)
    first.Render()
    yield
    if server.poll() is not None:
        pytest.fail(f"Xvfb ended with {server.returncode}")


@pytest.fixture
def renderer():
    return scene_of(image_mapper(ball(), (1, 1, 1.5), (3, -2, 1)), *functions(WARM, [(0.1, 0), (1, 0.4)]), unit=2)


@pytest.mark.parametrize("camera", [perspective, parallel, rolled_with_a_horizontal_angle, from_inside_the_margin])
def test_cameras_agree_to_a_hundredth_of_a_pixel(camera):
    """One bright voxel at known places. The picture of its tent of +-1 voxel is symmetric where it is thin; VTK's steps
    of .05 voxels move its centre by less than a thousandth of the tent's size, some 20 pixels."""
    for voxel in [(4, 4, 4), (2, 3, 6), (5, 6, 2), (3, 5, 3), (6, 2, 5)]:
        values = np.zeros((9, 9, 9), np.float32)
        values[voxel] = 1
        renderer, volume = scene_of(image_mapper(values, step=0.05), *functions([(0, (1, 1, 1))], [(0, 0), (1, 0.2)]))
        camera(renderer)
        renderer.ResetCameraClippingRange()
        held = lamina.vtk.hold(renderer)
        assert held.shown.max() > 0.05
        assert np.abs(place_of(held.vtk) - place_of(held.shown)).max() < 0.01, voxel


def test_a_volume(renderer):
    renderer, _ = renderer
    renderer.SetBackground(0.1, 0.2, 0.3)
    perspective(renderer)
    held = lamina.vtk.hold(renderer)
    # VTK draws with steps of a fifth of a voxel and tables of 8 bits or more: a code or so.
    assert held.l2 < 0.5 and held.linf < 3 and held.picture.plan.method == "trace"
    assert np.allclose(held.difference, 255 * (held.vtk - held.shown))
    assert held.norms == (held.linf, held.l1, held.l2)
    assert np.allclose(held.shown[0, 0], (0.1, 0.2, 0.3), atol=1e-12)
    assert held._repr_png_().startswith(b"\x89PNG")
    # Windows show codes: the background, the volume's picture and their sum are rounded, half a code each.
    codes = lamina.vtk.hold(renderer, precise=False)
    assert np.allclose(codes.vtk * 255, np.round(codes.vtk * 255), atol=1e-9)
    assert codes.l2 < held.l2 + 1 and np.abs(codes.vtk - held.vtk).max() < 1.51 / 255
    quick = lamina.vtk.hold(renderer, method="slice", max_error=0.5)
    assert quick.picture.plan.method == "slice" and abs(quick.l2 - held.l2) < 0.5


def opaque_red():
    """A volume that VTK draws in the codes 0 and 255 alone, as every ray ends at its first sample."""
    renderer, volume = scene_of(image_mapper(ball((6, 6, 6))), *functions([(0, (1, 0, 0))], [(0, 1)]))
    perspective(renderer)
    return renderer, volume


def test_a_float_picture_may_hold_codes_alone():
    from lamina._vtk_window import pixels_of
    renderer, volume = opaque_red()
    pixels = pixels_of(renderer, precise=True)
    assert set(np.unique(pixels)) == {0, 1} and pixels[:, :, 1:].max() == 0
    assert volume.GetVisibility() and renderer.GetBackground() == (0, 0, 0)
    window, shown = renderer.GetRenderWindow(), vtk.vtkUnsignedCharArray()
    width, height = window.GetSize()
    window.GetPixelData(0, 0, width - 1, height - 1, 1, shown, 0)  # 1: of the buffer that is seen
    assert set(np.unique(numpy_support.vtk_to_numpy(shown))) == {0, 255}


@pytest.mark.parametrize("is_red", [False, True])
def test_a_picture_in_8_bits_is_refused(renderer, monkeypatch, is_red):
    from lamina import _vtk_window
    monkeypatch.setattr(_vtk_window, "GL_RGBA32F", 0x8058)  # GL_RGBA8
    with pytest.raises(lamina.Error, match="VTK's picture came in 8 bits"):
        _vtk_window.pixels_of((opaque_red() if is_red else renderer)[0], precise=True)


def test_what_is_taken_over(renderer):
    renderer, volume = renderer
    perspective(renderer)
    scene = lamina.vtk.scene(renderer)
    camera = renderer.GetActiveCamera()
    assert scene["camera"] == {"eye": list(camera.GetPosition()), "center": list(camera.GetFocalPoint()),
                               "up": list(camera.GetViewUp()), "fov_y": 40}
    assert scene["image"] == {"width": 120, "height": 90, "color_space": "display", "background": [0, 0, 0]}
    assert scene["transfer_function"]["unit_length"] == 2
    assert scene.data.origin == (3, -2, 1) and scene.data.spacing == (1, 1, 1.5)
    assert np.shares_memory(scene.data.array, numpy_support.vtk_to_numpy(
        volume.GetMapper().GetInput().GetPointData().GetScalars()))
    # The command line draws what Python draws.
    assert lamina.render(lamina.Scene(dict(scene), scene.data), size=(20, 15)).array.max() > 0


def test_a_moved_and_turned_volume():
    image = image_mapper(ball((12, 14, 16)), (1, 2, 0.5), (4, 5, 6), step=0.1)
    image.GetInput().SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1)
    renderer, volume = scene_of(image, *functions(WARM, [(0.1, 0), (1, 0.4)]))
    volume.SetPosition(3, 1, -2)
    volume.RotateWXYZ(40, 1, 2, 3)
    volume.SetScale(1.5)
    renderer.ResetCamera()
    perspective(renderer)
    held = lamina.vtk.hold(renderer)
    assert held.l2 < 0.6 and held.shown.max() > 0.3
    assert np.abs(place_of(held.vtk) - place_of(held.shown)).max() < 0.05
    lowest, highest = (np.array(corner) for corner in lamina.vtk.scene(renderer).data.bounds)
    bounds = np.array(volume.GetBounds())  # VTK's box of the turned box is no smaller
    assert (bounds[::2] <= lowest + 1e-9).all() and (bounds[1::2] >= highest - 1e-9).all()


def test_tets():
    volume = lamina.Volume(ball((6, 7, 8)), spacing=(1, 1, 1.5))
    mesh = lamina.mesh(volume, kuhn=True)
    # VTK's opacity of tets is an extinction, and its table has 8 bits.
    mapper = tet_mapper(mesh.points, mesh.tets, mesh.values)
    renderer, _ = scene_of(mapper, *functions(WARM, [(0.0, 0), (1, 1)]), unit=3)
    perspective(renderer)
    scene = lamina.vtk.scene(renderer)
    points = scene["transfer_function"]["points"]
    assert [point["extinction"] for point in points] == pytest.approx([0, 0.4 / 3, 1 / 3])
    assert list(scene.data.scalars) == ["density"] and np.array_equal(scene.data.tets, mesh.tets)
    held = lamina.vtk.hold(renderer)
    # Interpolation without perspective, order by centres, 8 bits: a few codes, but the same picture.
    assert held.l2 < 4 and held.shown.max() > 0.2
    assert np.abs(place_of(held.vtk) - place_of(held.shown)).max() < 0.2
    parallel(renderer)
    flat = lamina.vtk.hold(renderer, method="project")
    assert flat.l2 < 4 and flat.picture.plan.method == "project"


@pytest.mark.parametrize("scale", [0.5, 3])
def test_units_of_length_in_scaled_volumes(scale):
    """VTK's ray caster measures in the volume's units, its mapper of tets in the world's."""
    def moved(mapper, opacities, unit):
        renderer, volume = scene_of(mapper, *functions(WARM, opacities), unit=unit)
        volume.SetScale(scale)
        renderer.ResetCamera()
        parallel(renderer)
        return renderer
    assert lamina.vtk.hold(moved(image_mapper(ball((12, 14, 16)), step=0.1), [(0.1, 0), (1, 0.4)], 1)).l2 < 0.1
    mesh = lamina.mesh(lamina.Volume(ball((6, 7, 8))), kuhn=True)
    assert lamina.vtk.hold(moved(tet_mapper(mesh.points, mesh.tets, mesh.values), [(0, 0), (1, 1)], 3 * scale)).l2 < 4
    image = moved(image_mapper(ball((12, 14, 16))), [(0.1, 0), (1, 0.4)], 1)
    image.GetVolumes().GetItemAsObject(0).SetScale(1, 2, 1)
    with pytest.raises(lamina.Error, match="scales x, y and z by 1, 2, 1"):
        lamina.vtk.scene(image)


def values_of(keys, value):
    """Colour and opacity of a scene's points, linear between them, after any step."""
    points = keys["points"]
    values = [point["value"] for point in points]
    rows = np.array([[*point["color"], point["opacity"]] for point in points])
    index = np.searchsorted(values, value, "right")
    if index in (0, len(values)):
        return rows[0 if index == 0 else -1]
    share = (value - values[index - 1]) / (values[index] - values[index - 1])
    return rows[index - 1] + share * (rows[index] - rows[index - 1])


def hsv(color, opacity):
    color.SetColorSpaceToHSV()


def sharp(color, opacity):
    color.RemoveAllPoints()
    color.AddRGBPoint(0, 0, 0, 1, 0.3, 0.2)
    color.AddRGBPoint(1, 1, 1, 0)
    opacity.RemoveAllPoints()
    opacity.AddPoint(0, 0, 0.7, 0.6)
    opacity.AddPoint(0.8, 0.5)


def steps(color, opacity):
    opacity.AllowDuplicateScalarsOn()
    opacity.AddPoint(0.5, 0.1)
    opacity.AddPoint(0.5, 0.6)


def unclamped(color, opacity):
    color.ClampingOff()
    opacity.ClampingOff()


@pytest.mark.parametrize("change", [None, hsv, sharp, steps, unclamped])
def test_transfer_functions_are_vtks(change):
    from lamina._vtk_functions import transfer_function_keys
    color, opacity = functions(WARM, [(0.1, 0), (0.3, 0.2), (0.9, 0.5)])
    if change:
        change(color, opacity)
    properties = vtk.vtkVolumeProperty()
    properties.SetColor(color)
    properties.SetScalarOpacity(opacity)
    properties.SetInterpolationTypeToLinear()
    keys = transfer_function_keys(properties, lamina.Volume(ball((4, 4, 4))))
    # Curved pieces become 256 straight ones. Across a bend by a slope s they are off by s h / 4: hues turn by up to 6 / .4
    # over the shortest piece, of which h is .4 / 256: .0059 for a full reversal, half of which occurs here.
    tolerance = 5e-3 if change in (hsv, sharp) else 1e-12
    for value in np.random.default_rng(3).uniform(-0.2, 1.2, 200):
        found = values_of(keys, value)
        assert np.allclose(found[:3], color.GetColor(value), atol=tolerance), value
        assert np.allclose(found[3], opacity.GetValue(value), atol=tolerance), value


def test_clipping_and_cropping(renderer):
    renderer, volume = renderer
    plane = vtk.vtkPlane()
    plane.SetOrigin(22, 15, 22)
    plane.SetNormal(1, 0.3, -0.2)
    volume.GetMapper().AddClippingPlane(plane)
    perspective(renderer)
    held = lamina.vtk.hold(renderer)
    whole = lamina.render(renderer_without_clip(renderer))
    assert held.picture.compare(whole).linf > 20
    assert held.l2 < 1.5  # at the cut VTK's first step is off by up to a step
    volume.GetMapper().RemoveAllClippingPlanes()
    volume.GetMapper().CroppingOn()
    volume.GetMapper().SetCroppingRegionPlanes(10, 30, 5, 25, 10, 30)
    volume.GetMapper().SetCroppingRegionFlagsToSubVolume()
    assert lamina.vtk.scene(renderer)["clip"] == {"box": {"min": [10, 5, 10], "max": [30, 25, 30]}}
    assert lamina.vtk.hold(renderer).l2 < 1.5


def renderer_without_clip(renderer):
    scene = lamina.vtk.scene(renderer)
    del scene["clip"]
    return scene


def shade(renderer, volume):
    volume.GetProperty().ShadeOn()


def gradient_opacity(renderer, volume):
    function = vtk.vtkPiecewiseFunction()
    function.AddPoint(0, 0)
    function.AddPoint(1, 1)
    volume.GetProperty().SetGradientOpacity(function)


def nearest(renderer, volume):
    volume.GetProperty().SetInterpolationTypeToNearest()


def projection(renderer, volume):
    volume.GetMapper().SetBlendModeToMaximumIntensity()


def second_volume(renderer, volume):
    renderer.AddVolume(vtk.vtkVolume())


def sphere(renderer, volume):
    renderer.AddActor(vtk.vtkActor())


def no_volume(renderer, volume):
    renderer.RemoveVolume(volume)


def components(renderer, volume):
    array = numpy_support.numpy_to_vtk(np.zeros((30 * 35 * 40, 2)), deep=True)
    volume.GetMapper().GetInput().GetPointData().SetScalars(array)


def gradient_background(renderer, volume):
    renderer.GradientBackgroundOn()


def window_center(renderer, volume):
    renderer.GetActiveCamera().SetWindowCenter(0.2, 0)


@pytest.mark.parametrize("change, message", [
    (shade, "found shading"), (gradient_opacity, "found gradient opacity"), (nearest, "found nearest neighbours"),
    (projection, "found the blend mode 1"), (second_volume, "found the visible props vtkOpenGLGPU|visible props vtk"),
    (sphere, "vtkVolume, vtkOpenGLActor|vtkVolume, vtk"), (no_volume, "visible props none"),
    (components, "found 2 components"), (gradient_background, "background of several colours"),
    (window_center, "off-centre window"),
])
def test_what_lamina_draws_otherwise_is_refused(renderer, change, message):
    change(*renderer)
    with pytest.raises(lamina.Error, match=message):
        lamina.vtk.scene(renderer[0])


def test_other_objects_are_refused():
    with pytest.raises(TypeError, match="renderer: found int, expected a vtkRenderer"):
        lamina.vtk.scene(3)


def test_cells_that_are_no_tets_are_refused():
    mapper = tet_mapper([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)], [0.0, 1, 2, 3])
    mapper.GetInput().GetCellTypesArray().SetValue(0, vtk.VTK_QUAD)
    renderer, _ = scene_of(mapper, *functions(WARM, [(0, 0), (1, 1)]))
    with pytest.raises(lamina.Error, match=r"cells of the types \[9\], expected tetrahedra"):
        lamina.vtk.scene(renderer)


def test_a_near_plane_that_cuts_is_said(renderer):
    renderer, _ = renderer
    camera = renderer.GetActiveCamera()
    near, far = camera.GetClippingRange()
    camera.SetClippingRange((near + far) / 2, far)
    with pytest.warns(lamina.PictureWarning, match="VTK draws depths from"):
        lamina.vtk.hold(renderer, method="slice")


def test_vtks_error_is_that_of_the_benchmark(source, tmp_path):
    """tools/bench --vtk measures VTK's picture of a scene against the tracer's; so does hold, from the renderer alone."""
    import sys
    sys.path.insert(0, str(source / "tools"))
    from bench_parts import scenes, vtk_side
    scene = scenes.find("bluntfin")
    if scene.missing():
        pytest.skip(scene.missing())
    window = vtk_side.mesh_window(scene, [160, 120])
    held = lamina.vtk.hold(window.renderer)
    window.write_picture(tmp_path / "vtk.npy")
    truth = lamina.trace(scene.path, size=(160, 120))
    e = 255 * (np.load(tmp_path / "vtk.npy") - truth.array[:, :, :3])
    # The scene has its colours and extinctions in double precision, VTK's functions have the same: 1e-6 of a code.
    assert math.isclose(held.l2, np.sqrt((e * e).mean()), rel_tol=1e-6)
    # docs/journal.md has 6.08 at 800 x 600; pixels 25 times as large see some edges more, some less.
    assert 5 < held.l2 < 7
