# SPDX-License-Identifier: Apache-2.0
"""A data file as VTK shows it if nothing is said: vtk_defaults.py FILE OUT.png WIDTH HEIGHT."""
import pathlib
import sys

import vtk
from vtk.util import numpy_support

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from bench_parts import nrrd  # noqa: E402

# Viridis (Smith and van der Walt 2015) at nine even places; display values.
VIRIDIS = ((.267, .005, .329), (.279, .175, .483), (.230, .322, .546), (.173, .449, .558), (.128, .567, .551),
           (.158, .684, .502), (.369, .789, .383), (.678, .864, .190), (.993, .906, .144))


def viridis(lo, hi):
    function = vtk.vtkColorTransferFunction()
    for i, color in enumerate(VIRIDIS):
        function.AddRGBPoint(lo + (hi - lo) * i / (len(VIRIDIS) - 1), *color)
    return function


def image_of(file):
    if file.suffix != ".nrrd":
        reader = vtk.vtkNIFTIImageReader() if ".nii" in file.name else vtk.vtkMetaImageReader() \
            if file.suffix in (".mha", ".mhd") else vtk.vtkXMLImageDataReader()
        reader.SetFileName(str(file))
        reader.Update()
        return reader.GetOutput()
    samples, sizes, spacings = nrrd.read(file)
    image = vtk.vtkImageData()
    image.SetDimensions(sizes)
    image.SetSpacing(spacings)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(samples, deep=True))
    return image


def volume_of(image):
    lo, hi = image.GetScalarRange()
    opacity, properties = vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
    opacity.AddPoint(lo, 0)
    opacity.AddPoint(hi, 1)
    properties.SetColor(viridis(lo, hi))
    properties.SetScalarOpacity(opacity)
    properties.SetScalarOpacityUnitDistance(sum(image.GetSpacing()) / 3)
    properties.SetInterpolationTypeToLinear()
    mapper, volume = vtk.vtkSmartVolumeMapper(), vtk.vtkVolume()
    mapper.SetInputData(image)
    volume.SetMapper(mapper)
    volume.SetProperty(properties)
    return volume


def surface_of(file):
    reader = vtk.vtkXMLUnstructuredGridReader() if file.suffix == ".vtu" else vtk.vtkUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    values = grid.GetPointData().GetArray(0)
    grid.GetPointData().SetActiveScalars(values.GetName())
    mapper, actor = vtk.vtkDataSetMapper(), vtk.vtkActor()
    mapper.SetInputData(grid)
    mapper.SetLookupTable(viridis(*values.GetRange()))
    actor.SetMapper(mapper)
    return actor


def main():
    file, picture, width, height = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    renderer.SetBackground(1, 1, 1)
    renderer.AddViewProp(surface_of(file) if file.suffix in (".vtu", ".vtk") else volume_of(image_of(file)))
    window.SetOffScreenRendering(1)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(1, 1, 1)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    window.Render()
    shot, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    writer.SetFileName(picture)
    writer.SetInputConnection(shot.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
