# SPDX-License-Identifier: Apache-2.0
"""VTK's mappers on a scene of lamina's: same camera, same transfer function, black background. A lit volume is shaded
with the same numbers and VTK's headlight. VTK shades flat regions, too, where lamina's light fades out: its errors are
those of another definition there.

A frame runs from the camera's change to glFinish; no files, no read-back. Frames are timed as VTK draws them, into 8
bits. For its errors the same picture is drawn once more into a float32 target that takes the place of the window's
colour buffer, so that rounding to 8 bits is not counted against VTK (its own intermediate roundings are).
"""
import math
import statistics
import time

import numpy
import vtk
from vtk.util import numpy_support

from bench_parts import nrrd

DEGREES_PER_FRAME = 0.1  # as `lamina render --frames`
STEPS = 64  # opacity points between two points of the scene
GL_RGBA, GL_RGBA32F, GL_FLOAT = 0x1908, 0x8814, 0x1406


def linear_in_opacity(function):
    """Tells whether all points give opacity, and opacity is linear between them, as VTK has it."""
    return function.get("interpolation", "linear") == "linear" and all("opacity" in p for p in function["points"])


def extinction_of(point, unit_length):
    return point.get("extinction", -math.log1p(-min(point.get("opacity", 0), 1 - 1e-9)) / unit_length)


def transfer_points(scene):
    """Value, colour and extinction of each point of the scene's transfer function; extinction is linear between them."""
    function = scene.json["transfer_function"]
    if function.get("interpolation") == "nearest" or "points" not in function or linear_in_opacity(function):
        raise SystemExit(f"bench: {scene.path}: transfer_function: expected points with linear extinction")
    return [(p["value"], p["color"], extinction_of(p, function.get("unit_length", 1))) for p in function["points"]]


def make_property(points, opacities, unit_distance):
    """Colours of the points; opacities by value, in VTK's unit distance."""
    color, opacity, result = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
    color.AllowDuplicateScalarsOn()  # steps
    opacity.AllowDuplicateScalarsOn()
    for value, rgb, _ in points:
        color.AddRGBPoint(value, *rgb)
    for value, alpha in opacities:
        opacity.AddPoint(value, alpha)
    result.SetColor(color)
    result.SetScalarOpacity(opacity)
    result.SetScalarOpacityUnitDistance(unit_distance)
    result.SetInterpolationTypeToLinear()
    return result


def volume_property(scene):
    """The ray caster takes the opacity of a step as 1 - (1 - opacity)^(step / unit distance). It is linear in opacity
    between points: a scene whose opacities are, too, has them as they are; of one that is linear in extinction they are
    resampled, the largest is 0.95."""
    function = scene.json["transfer_function"]
    if "points" in function and linear_in_opacity(function):
        return make_property([(p["value"], p["color"], None) for p in function["points"]],
                             [(p["value"], p["opacity"]) for p in function["points"]], function.get("unit_length", 1))
    points = transfer_points(scene)
    unit = 3 / (max(extinction for _, _, extinction in points) or 3)
    opacities = [(x0 + i / STEPS * (x1 - x0), -math.expm1(-unit * (e0 + i / STEPS * (e1 - e0))))
                 for (x0, _, e0), (x1, _, e1) in zip(points, points[1:] + points[-1:])
                 for i in range(STEPS if x1 > x0 else 1)]
    return make_property(points, opacities, unit)


def mesh_property(scene):
    """The tets' program takes 1 - exp(-opacity * length / unit distance): its opacity is an extinction, linear between
    points like a scene's. It is kept in 8 bits: the largest is 1."""
    points = transfer_points(scene)
    unit = 1 / (max(extinction for _, _, extinction in points) or 1)
    return make_property(points, [(value, unit * extinction) for value, _, extinction in points], unit)


def shade(scene, properties):
    """Light as VTK has it, if the scene has a headlight alone."""
    lighting = scene.json.get("lighting")
    if lighting is None:
        return properties
    lights = lighting.get("lights", [{}])
    if len(lights) != 1 or lights[0].get("direction", "headlight") != "headlight" or "color" in lights[0]:
        raise SystemExit(f"bench: {scene.path}: lighting.lights: expected one white headlight, as VTK's own light is")
    properties.ShadeOn()
    properties.SetAmbient(lighting.get("ambient", 0.1))
    properties.SetDiffuse(lighting.get("diffuse", 0.7))
    properties.SetSpecular(lighting.get("specular", 0.2))
    properties.SetSpecularPower(lighting.get("power", 10))
    return properties


class Window:
    """A scene's volume or mesh in a window of VTK's."""

    def __init__(self, scene, mapper, properties, size):
        self.scene, self.mapper, self.size = scene, mapper, size
        volume = vtk.vtkVolume()  # a plain volume: no level of detail
        volume.SetMapper(mapper)
        volume.SetProperty(properties)
        self.renderer, self.window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
        self.renderer.AddVolume(volume)
        self.renderer.SetBackground(0, 0, 0)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.frame_ms(0)  # opens the window
        self.gl = self.window.ReportCapabilities().partition("renderer string:")[2].partition("\n")[0].strip()

    def set_camera(self, degrees):
        """The scene's camera, its eye turned about `up` through the centre."""
        wanted, turn = self.scene.json["camera"], vtk.vtkTransform()
        turn.Translate(wanted["center"])
        turn.RotateWXYZ(degrees, wanted["up"])
        turn.Translate([-x for x in wanted["center"]])
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(turn.TransformPoint(wanted["eye"]))
        camera.SetFocalPoint(wanted["center"])
        camera.SetViewUp(wanted["up"])
        if wanted.get("projection") == "orthographic":
            camera.ParallelProjectionOn()
            camera.SetParallelScale(wanted["height"] / 2)
        else:
            camera.SetViewAngle(wanted["fov_y"])
        self.renderer.ResetCameraClippingRange()  # VTK drops whole tets that cross the near plane

    def frame_ms(self, degrees):
        start = time.perf_counter()
        self.set_camera(degrees)
        self.window.Render()
        self.window.WaitForCompletion()  # glFinish
        return (time.perf_counter() - start) * 1e3

    def median_ms(self, frames):
        """Times this many frames after one to warm up."""
        return statistics.median([self.frame_ms(DEGREES_PER_FRAME * i) for i in range(frames + 1)][1:])

    def write_picture(self, path):
        """The scene's own frame as .npy: linear associated R, G, B (over black) in float32."""
        width, height = self.size
        target = vtk.vtkTextureObject()
        target.SetContext(self.window)
        target.SetInternalFormat(GL_RGBA32F)
        target.SetFormat(GL_RGBA)
        target.SetDataType(GL_FLOAT)
        target.Allocate2D(width, height, 4, vtk.VTK_FLOAT)
        framebuffer = self.window.GetRenderFramebuffer()
        eight_bits = framebuffer.GetColorAttachmentAsTextureObject(0)
        framebuffer.Bind()
        framebuffer.AddColorAttachment(0, target)
        self.frame_ms(0)
        pixels = vtk.vtkFloatArray()
        self.window.GetRGBAPixelData(0, 0, width - 1, height - 1, 0, pixels)
        framebuffer.Bind()
        framebuffer.AddColorAttachment(0, eight_bits)
        rgb = numpy_support.vtk_to_numpy(pixels).reshape(height, width, 4)[::-1, :, :3]
        if numpy.abs(rgb * 255 - numpy.round(rgb * 255)).max() < 1e-3:
            raise SystemExit("bench: VTK's picture came in 8 bits, expected float32")
        numpy.save(path, numpy.ascontiguousarray(rgb))

    def codes(self):
        """The scene's own frame as VTK shows it: 8-bit R, G, B, row 0 on top."""
        width, height = self.size
        self.frame_ms(0)
        pixels = vtk.vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0)
        return numpy_support.vtk_to_numpy(pixels).reshape(height, width, 3)[::-1]

    def close(self):
        self.window.Finalize()


def volume_window(scene, size, steps_a_voxel):
    """The GPU ray caster, at its default of one sample a unit (a voxel, if the spacing is 1) for steps_a_voxel 1."""
    samples, sizes, spacings = nrrd.read(scene.data_file())
    image, mapper = vtk.vtkImageData(), vtk.vtkOpenGLGPUVolumeRayCastMapper()
    image.SetDimensions(sizes)
    image.SetSpacing(spacings)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(samples, deep=True))
    mapper.SetInputData(image)
    mapper.AutoAdjustSampleDistancesOff()  # else it may draw fewer pixels
    mapper.SetSampleDistance(min(spacings) / steps_a_voxel)
    return Window(scene, mapper, shade(scene, volume_property(scene)), size)


def mesh_window(scene, size):
    """Projected tetrahedra: sorted by cell centres, classified at the vertices, interpolated without perspective."""
    path = scene.data_file()
    if "lighting" in scene.json:
        raise SystemExit(f"bench: {scene.path}: lighting: VTK's mapper of tets has no shading")
    if path.suffix not in (".vtu", ".vtk"):
        raise SystemExit(f"bench: {scene.path}: mesh: expected a .vtu or .vtk file, which VTK can read")
    reader = vtk.vtkXMLUnstructuredGridReader() if path.suffix == ".vtu" else vtk.vtkUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    name = scene.json.get("scalar", grid.GetPointData().GetArrayName(0))
    if not name or not grid.GetPointData().HasArray(name):
        raise SystemExit(f"bench: {path}: no point array {name!r}")
    if not grid.GetNumberOfCells() or not grid.IsHomogeneous() or grid.GetCellType(0) != vtk.VTK_TETRA:
        raise SystemExit(f"bench: {path}: expected tetrahedra only: VTK's mapper draws no other cells")
    mapper = vtk.vtkProjectedTetrahedraMapper()
    mapper.SetInputData(grid)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectScalarArray(name)
    return Window(scene, mapper, mesh_property(scene), size)
