# SPDX-License-Identifier: Apache-2.0
"""Scenes of VTK's, and cameras that look at them, for the tests of lamina.vtk."""
import numpy as np
import pytest

vtk = pytest.importorskip("vtk", reason="python3-vtk9 is not installed")
from vtk.util import numpy_support  # noqa: E402

SIZE = (120, 90)


def functions(colors, opacities):
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for value, rgb in colors:
        color.AddRGBPoint(value, *rgb)
    for value, alpha in opacities:
        opacity.AddPoint(value, alpha)
    return color, opacity


def scene_of(mapper, color, opacity, unit=1.0, size=SIZE):
    """A renderer in a window, and its volume."""
    volume, renderer, window = vtk.vtkVolume(), vtk.vtkRenderer(), vtk.vtkRenderWindow()
    volume.SetMapper(mapper)
    properties = volume.GetProperty()
    properties.SetColor(color)
    properties.SetScalarOpacity(opacity)
    properties.SetScalarOpacityUnitDistance(unit)
    properties.SetInterpolationTypeToLinear()
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    renderer.ResetCamera()
    renderer.window = window  # lives as long
    return renderer, volume


def image_mapper(array, spacing=(1, 1, 1), origin=(0, 0, 0), step=0.2):
    image, mapper = vtk.vtkImageData(), vtk.vtkOpenGLGPUVolumeRayCastMapper()
    image.SetDimensions(array.shape[::-1])
    image.SetSpacing(spacing)
    image.SetOrigin(origin)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(array.ravel(), deep=True))
    mapper.SetInputData(image)
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetSampleDistance(step * min(spacing))
    return mapper


def ball(shape=(30, 35, 40), dtype=np.float32, scale=1.0):
    z, y, x = np.mgrid[tuple(slice(-1, 1, n * 1j) for n in shape)]
    return (scale * np.exp(-2 * (x * x + y * y + z * z))).astype(dtype)


def tet_mapper(points, tets, values):
    grid, cells, places = vtk.vtkUnstructuredGrid(), vtk.vtkCellArray(), vtk.vtkPoints()
    places.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetData(4, numpy_support.numpy_to_vtkIdTypeArray(np.ascontiguousarray(tets, np.int64).ravel(), deep=True))
    grid.SetPoints(places)
    grid.SetCells(vtk.VTK_TETRA, cells)
    scalars = numpy_support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    scalars.SetName("density")
    grid.GetPointData().SetScalars(scalars)
    mapper = vtk.vtkProjectedTetrahedraMapper()
    mapper.SetInputData(grid)
    return mapper


WARM = [(0.0, (0, 0, 0.5)), (0.4, (1, 0.3, 0)), (1.0, (1, 1, 1))]


# Cameras. Placed by hand so that none looks along an axis.

def look(renderer, azimuth, elevation, roll=0):
    camera = renderer.GetActiveCamera()
    camera.Azimuth(azimuth)
    camera.Elevation(elevation)
    camera.Roll(roll)
    renderer.ResetCameraClippingRange()
    return camera


def perspective(renderer):
    look(renderer, 25, 15).SetViewAngle(40)


def parallel(renderer):
    look(renderer, -35, 20).ParallelProjectionOn()


def rolled_with_a_horizontal_angle(renderer):
    camera = look(renderer, 100, -30, 25)
    camera.UseHorizontalViewAngleOn()
    camera.SetViewAngle(45)


def from_inside_the_margin(renderer):
    look(renderer, 10, 5).Zoom(2.5)


def place_of(rgb):
    """Centre of gravity of a picture's light, in pixels."""
    weight = rgb.sum(axis=2)
    rows, columns = np.mgrid[:weight.shape[0], :weight.shape[1]] + 0.5
    return np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum()
