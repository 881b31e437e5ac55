# SPDX-License-Identifier: Apache-2.0
"""Image data in all forms of VTK, and TIFF files by it."""
import numpy as np

from .cases import TYPES, rotation, values_of


def vtk_files(cases):
    import vtkmodules.vtkCommonCore as core
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkTIFFWriter
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    def image_of(array, origin=(1, 2, 3), spacing=(.5, .75, 2), matrix=None, first=(0, 0, 0), of_cells=False, name="v"):
        image = vtkImageData()
        size = array.shape[2::-1]
        last = [first[i] + size[i] - (0 if of_cells else 1) for i in range(3)]
        image.SetExtent(first[0], last[0], first[1], last[1], first[2], last[2])
        image.SetOrigin(origin)
        image.SetSpacing(spacing)
        if matrix is not None:
            image.SetDirectionMatrix(*np.asarray(matrix).flat)
        components = array.shape[3] if array.ndim == 4 else 1
        values = numpy_to_vtk(np.ascontiguousarray(array).reshape(-1, components) if components > 1 else array.ravel(),
                              deep=True)
        values.SetName(name)
        (image.GetCellData() if of_cells else image.GetPointData()).SetScalars(values)
        return image

    def write(image, file, mode, compressor, big, header64):
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(cases.path(file))
        writer.SetInputData(image)
        {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary,
         "appended": writer.SetDataModeToAppended, "base64": writer.SetDataModeToAppended}[mode]()
        writer.SetEncodeAppendedData(mode == "base64")
        {"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib,
         "lz4": writer.SetCompressorTypeToLZ4, "lzma": writer.SetCompressorTypeToLZMA}[compressor]()
        (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
        (writer.SetHeaderTypeToUInt64 if header64 else writer.SetHeaderTypeToUInt32)()
        writer.Write()

    number = 0
    steps = np.diag([.5, .75, 2])
    for kind in TYPES:
        array = values_of(kind, (4, 5, 6), seed=1)
        for mode in ("ascii", "binary", "appended", "base64"):
            for compressor in ("none", "zlib", "lz4", "lzma"):
                if mode == "ascii" and (compressor != "none" or kind.startswith("float")):
                    continue  # numbers as text have fewer digits
                number += 1
                file = f"{kind}_{mode}_{compressor}.vti"
                write(image_of(array), file, mode, compressor, number % 2 == 0, number % 3 == 0)
                cases.add(file, array, steps, (1, 2, 3))
    array = values_of("int16", (4, 5, 6), seed=2)
    for turn, label in ((rotation(.3, .2, .1), "turned"), (rotation(.3, .2, .1) @ np.diag([1, -1, 1]), "mirrored")):
        for of_cells in (False, True):
            first = np.array((2, -1, 4))
            image = image_of(array, matrix=turn, first=first, of_cells=of_cells)
            file = f"{label}{of_cells}.vti"
            write(image, file, "appended", "zlib", False, True)
            world = (turn * (.5, .75, 2)).T
            origin = np.array((1, 2, 3)) + (first + (.5 if of_cells else 0)) @ world
            cases.add(file, array, world, origin, cell=of_cells)
    vectors = values_of("float32", (4, 5, 6, 3), seed=3)
    image = image_of(vectors, name="velocity")
    other = numpy_to_vtk(array.ravel(), deep=True)
    other.SetName("pressure")
    image.GetPointData().AddArray(other)
    write(image, "several.vti", "binary", "zlib", False, False)
    cases.add("several.vti", vectors[..., 0], steps, (1, 2, 3),
              warnings=['array "velocity" of 2 is taken', "channel 0 of 3 is taken"])
    cases.add("several.vti", vectors[..., 2], steps, (1, 2, 3), array="velocity", channel=2)
    cases.add("several.vti", array, steps, (1, 2, 3), array="pressure")

    for kind in TYPES[:6] + TYPES[8:]:
        for compressed in (False, True):
            array = values_of(kind, (4, 5, 6), seed=4)
            writer = vtkMetaImageWriter()
            suffix = "mha" if compressed else "mhd"
            writer.SetFileName(cases.path(f"{kind}.{suffix}"))
            if not compressed:
                writer.SetRAWFileName(cases.path(f"{kind}.raw"))
            writer.SetCompression(compressed)
            writer.SetInputData(image_of(array))
            writer.Write()
            cases.add(f"{kind}.{suffix}", array, steps, (1, 2, 3))
    for kind in ("uint8", "uint16", "float32"):
        for compression in ("NoCompression", "PackBits", "Deflate"):
            page = values_of(kind, (1, 30, 40), seed=5)
            writer = vtkTIFFWriter()
            writer.SetFileName(cases.path(f"{kind}_{compression}.tif"))
            getattr(writer, f"SetCompressionTo{compression}")()
            writer.SetInputData(image_of(page[:, ::-1]))  # VTK's rows run upwards
            writer.Write()
            cases.add(f"{kind}_{compression}.tif", page)
    legacy_files(cases)
    grids_and_pieces(cases)
    hidden_files(cases)
    del core


def write_with(writer, path, data, *calls):
    writer.SetFileName(path)
    writer.SetInputData(data)
    for call in calls:
        getattr(writer, call)()
    writer.Write()


def array_of(values, name, components=1):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    flat = np.ascontiguousarray(values)
    result = numpy_to_vtk(flat.reshape(-1, components) if components > 1 else flat.ravel(), deep=True)
    result.SetName(name)
    return result


def legacy_files(cases):
    """Structured points and rectilinear grids in legacy files; floats in binary alone: text has fewer digits."""
    from vtkmodules.vtkCommonDataModel import vtkStructuredPoints
    from vtkmodules.vtkIOLegacy import vtkRectilinearGridWriter, vtkStructuredPointsWriter
    steps = np.diag([.5, .75, 2])
    for kind in TYPES:
        for mode in ("SetFileTypeToASCII", "SetFileTypeToBinary"):
            if "ASCII" in mode and kind.startswith("float"):
                continue
            points, cells = values_of(kind, (4, 5, 6), seed=1), values_of("int16", (3, 4, 5), seed=2)
            image = vtkStructuredPoints()
            image.SetDimensions(6, 5, 4)
            image.SetOrigin(1, 2, 3)
            image.SetSpacing(.5, .75, 2)
            image.GetPointData().SetScalars(array_of(points, "values"))
            vectors = values_of("int32", (4, 5, 6, 3), seed=3)
            image.GetPointData().SetVectors(array_of(vectors, "speed", 3))
            more = values_of("uint16", (4, 5, 6), seed=4)
            image.GetPointData().AddArray(array_of(more, "more"))
            image.GetCellData().AddArray(array_of(cells, "cells"))
            file = f"{kind}{mode[13:]}.vtk"
            write_with(vtkStructuredPointsWriter(), cases.path(file), image, mode)
            if kind == "uint8":  # VTK writes them as fractions of 1 in text, and reads them so
                from vtkmodules.util.numpy_support import vtk_to_numpy
                from vtkmodules.vtkIOLegacy import vtkStructuredPointsReader
                reader = vtkStructuredPointsReader()
                reader.SetFileName(cases.path(file))
                reader.Update()
                points = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(4, 5, 6)
            cases.add(file, points, steps, (1, 2, 3), warnings=['array "'])
            cases.add(file, vectors[..., 2], steps, (1, 2, 3), array="speed", channel=2)
            cases.add(file, more, steps, (1, 2, 3), array="more")
            cases.add(file, cells, steps, np.array((1, 2, 3)) + (.25, .375, 1), cell=True, array="cells")
            file = f"grid{kind}{mode[13:]}.vtk"
            write_with(vtkRectilinearGridWriter(), cases.path(file), rectilinear(values_of(kind, (4, 5, 6), seed=5), "float32"),
                       mode)
            cases.add(file, values_of(kind, (4, 5, 6), seed=5), steps, (1, 2, 3))
    colours = values_of("uint8", (4, 5, 6, 3), seed=6)
    image = vtkStructuredPoints()
    image.SetDimensions(6, 5, 4)
    image.GetPointData().SetScalars(array_of(colours, "colours", 3))
    for mode in ("SetFileTypeToASCII", "SetFileTypeToBinary"):
        write_with(vtkStructuredPointsWriter(), cases.path(f"colours{mode[13:]}.vtk"), image, mode)
        cases.add(f"colours{mode[13:]}.vtk", colours[..., 1], channel=1)


def rectilinear(array, kind, name="v"):
    from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
    grid = vtkRectilinearGrid()
    grid.SetDimensions(*array.shape[::-1])
    for axis, (first, step) in enumerate(((1, .5), (2, .75), (3, 2))):
        places = (first + step * np.arange(array.shape[2 - axis])).astype(kind)
        (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)[axis](array_of(places, "xyz"[axis]))
    grid.GetPointData().SetScalars(array_of(array, name))
    return grid


def grids_and_pieces(cases):
    """Rectilinear grids with even steps, parallel images with and without ghosts, and lists by time."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
    from vtkmodules.vtkIOParallelXML import vtkXMLPImageDataWriter
    from vtkmodules.vtkIOXML import vtkXMLRectilinearGridWriter
    steps = np.diag([.5, .75, 2])
    for kind in ("float32", "float64"):
        array = values_of("int16", (4, 5, 6), seed=7)
        write_with(vtkXMLRectilinearGridWriter(), cases.path(f"even_{kind}.vtr"), rectilinear(array, kind))
        cases.add(f"even_{kind}.vtr", array, steps, (1, 2, 3))
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-2, 9, 0, 9, 3, 10)
    for level in (0, 1, 2):
        for pieces in (1, 3, 8):
            writer = vtkXMLPImageDataWriter()
            file = f"ghosts{level}_{pieces}.pvti"
            writer.SetFileName(cases.path(file))
            writer.SetInputConnection(source.GetOutputPort())
            writer.SetNumberOfPieces(pieces)
            writer.SetStartPiece(0)
            writer.SetEndPiece(pieces - 1)
            writer.SetGhostLevel(level)
            writer.Write()
            source.UpdateWholeExtent()
            values = vtk_to_numpy(source.GetOutput().GetPointData().GetScalars()).reshape(8, 10, 12)
            cases.add(file, values, origin=(-2, 0, 3))
    times = [values_of("int16", (4, 5, 6), seed=20 + i) for i in range(3)]
    sets = ""
    for i, time in ((2, 1.5), (0, 0), (1, .5)):  # VTK sorts them by time
        write_with(vtkXMLRectilinearGridWriter(), cases.path(f"at{i}.vtr"), rectilinear(times[i], "float64"))
        sets += f'<DataSet timestep="{time}" group="" part="0" file="at{i}.vtr"/>\n'
    with open(cases.path("times.pvd"), "w", encoding="ascii") as out:
        out.write(f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n{sets}</Collection></VTKFile>\n')
    cases.add("times.pvd", times[0], steps, (1, 2, 3), warnings=["time 0 of 3 is taken"])
    cases.add("times.pvd", times[2], steps, (1, 2, 3), time=2)


def hidden_files(cases):
    """Blanked points and cells. lamina draws a cell of samples only if no corner is NaN, as VTK does with points."""
    from vtkmodules.vtkCommonDataModel import vtkUniformGrid
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    def case(file, hide, expected_points, expected_cells):
        image = vtkUniformGrid()
        image.SetDimensions(6, 5, 4)
        points, cells = values_of("int16", (4, 5, 6), seed=1), values_of("uint8", (3, 4, 5), seed=2)
        image.GetPointData().AddArray(array_of(points, "p"))
        image.GetCellData().AddArray(array_of(cells, "c"))
        hide(image)
        write_with(vtkXMLImageDataWriter(), cases.path(file), image)
        says = ["are hidden by ghost arrays"]
        cases.add(file, np.where(expected_points, np.nan, points), drawn="float", array="p", warnings=says)
        cases.add(file, np.where(expected_cells, np.nan, cells), origin=(.5, .5, .5), cell=True, drawn="float", array="c",
                  warnings=says)

    def blank_cells(image):  # all with x < 2: only the points with x < 2 touch no other cell
        for cell in range(60):
            if cell % 5 < 2:
                image.BlankCell(cell)

    x = np.broadcast_to(np.arange(6), (4, 5, 6))
    case("hidden_cells.vti", blank_cells, x < 2, x[:3, :4, :5] < 2)

    def blank_point(image):  # (0, 0, 0), and with it the cell in the corner
        image.BlankPoint(0)

    corner = np.zeros((4, 5, 6), bool)
    corner[0, 0, 0] = True
    case("hidden_point.vti", blank_point, corner, corner[:3, :4, :5])

    def old_levels(image):  # of files before VTK 6.3: cells of another piece have a level above 0
        levels = np.zeros((3, 4, 5), np.uint8)
        levels[2] = 1
        image.GetCellData().AddArray(array_of(levels, "vtkGhostLevels"))

    z = np.broadcast_to(np.arange(4)[:, None, None], (4, 5, 6))
    case("levels.vti", old_levels, z == 3, z[:3, :4, :5] == 2)

    def thin(image):  # one layer of cells, x = 2: no point touches hidden cells alone
        for cell in range(60):
            if cell % 5 == 2:
                image.BlankCell(cell)

    case("thin.vti", thin, (x == 2) | (x == 3), x[:3, :4, :5] == 2)
