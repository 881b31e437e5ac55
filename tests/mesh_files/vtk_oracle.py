#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vtk_oracle.py FOLDER: with VTK's own writers, writes an unstructured grid to FOLDER in every coding
that they know; then writes FILE.dump beside every .vtu and .vtk there: what VTK's own readers make of
it. Exits with 77 where VTK is not installed.

A dump: "points N", the coordinates; "cells N", a line "type count indices..." each; for every array
"point_array|cell_array COMPONENTS NAME", then its values.
"""
import glob
import random
import sys

try:
    import vtkmodules.vtkCommonCore as core
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader, vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
except ImportError:
    sys.exit(77)

CELLS = [(10, 4), (12, 8), (13, 6), (14, 5), (11, 8), (5, 3), (3, 2), (1, 1), (9, 4), (7, 5)]
ARRAYS = [  # class, name, components
    (core.vtkFloatArray, "first one", 1), (core.vtkDoubleArray, "velocity in %", 3),
    (core.vtkDoubleArray, "pair", 2), (core.vtkIntArray, "whole", 1),
    (core.vtkUnsignedCharArray, "bytes", 1), (core.vtkSignedCharArray, "signed", 1),
    (core.vtkShortArray, "short", 1), (core.vtkUnsignedShortArray, "ushort", 1),
    (core.vtkUnsignedIntArray, "unsigned", 1), (core.vtkLongLongArray, "longlong", 1),
    (core.vtkIdTypeArray, "ids", 1), (core.vtkDoubleArray, "tensor", 9)]


def add_arrays(data, count, rng):
    for kind, name, components in ARRAYS:
        array = kind()
        array.SetName(name)
        array.SetNumberOfComponents(components)
        for _ in range(count * components):
            if kind in (core.vtkFloatArray, core.vtkDoubleArray):
                array.InsertNextValue(rng.uniform(-1, 1))
            else:
                array.InsertNextValue(rng.randrange(100))
        data.AddArray(array)
    data.SetActiveScalars("first one")
    data.SetActiveVectors("velocity in %")
    text = core.vtkStringArray()
    text.SetName("words")
    for i in range(count):
        text.InsertNextValue("word %d" % i + "x" * (70 * (i % 2)))
    data.AddArray(text)


def make_grid():
    rng = random.Random(5)
    grid = vtkUnstructuredGrid()
    points = core.vtkPoints()
    points.SetDataTypeToDouble()
    for i in range(60):
        points.InsertNextPoint(rng.uniform(-9, 9), rng.uniform(-9, 9), i)
    grid.SetPoints(points)
    for i in range(60):
        kind, corners = CELLS[i % len(CELLS)]
        ids = core.vtkIdList()
        for point in rng.sample(range(60), corners):
            ids.InsertNextId(point)
        grid.InsertNextCell(kind, ids)
    add_arrays(grid.GetPointData(), 60, rng)
    add_arrays(grid.GetCellData(), 60, rng)
    return grid


def write_all(folder):
    grid = make_grid()
    for mode in ("Ascii", "Binary", "Appended"):
        for compressor in ("None", "ZLib", "LZ4", "LZMA"):
            for bits in (32, 64):
                for order in ("BigEndian", "LittleEndian"):
                    writer = vtkXMLUnstructuredGridWriter()
                    writer.SetInputData(grid)
                    getattr(writer, "SetDataModeTo" + mode)()
                    getattr(writer, "SetCompressorTypeTo" + compressor)()
                    getattr(writer, "SetHeaderTypeToUInt%d" % bits)()
                    getattr(writer, "SetByteOrderTo" + order)()
                    writer.SetBlockSize(256)
                    writer.SetEncodeAppendedData(bits == 64)  # base64 or raw
                    writer.SetFileName(f"{folder}/{mode}-{compressor}-{bits}-{order}.vtu")
                    writer.Write()
    for version in (42, 51):
        for binary in (False, True):
            writer = vtkUnstructuredGridWriter()
            writer.SetInputData(grid)
            writer.SetFileVersion(version)
            writer.SetFileType(2 if binary else 1)
            writer.SetFileName(f"{folder}/legacy-{version}-{binary}.vtk")
            writer.Write()


def dump(path):
    reader = vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtkUnstructuredGridReader()
    if path.endswith(".vtk"):
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    with open(path + ".dump", "w") as out:
        print("points", grid.GetNumberOfPoints(), file=out)
        for i in range(grid.GetNumberOfPoints()):
            print(*map(repr, grid.GetPoint(i)), file=out)
        print("cells", grid.GetNumberOfCells(), file=out)
        ids = core.vtkIdList()
        for i in range(grid.GetNumberOfCells()):
            grid.GetCellPoints(i, ids)
            n = ids.GetNumberOfIds()
            print(grid.GetCellType(i), n, *(ids.GetId(j) for j in range(n)), file=out)
        for label, data in (("point_array", grid.GetPointData()), ("cell_array", grid.GetCellData())):
            for i in range(data.GetNumberOfArrays()):
                array = data.GetArray(i)
                if array is None:  # strings
                    continue
                print(label, array.GetNumberOfComponents(), array.GetName(), file=out)
                for j in range(array.GetNumberOfTuples()):
                    print(*map(repr, array.GetTuple(j)), file=out)


if __name__ == "__main__":
    write_all(sys.argv[1])
    for name in sorted(glob.glob(sys.argv[1] + "/*.vt[uk]")):
        dump(name)
