#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vtk_pieces.py FOLDER: with VTK's own writers, writes a conforming mesh of hexahedra, wedges and
pyramids to FOLDER: whole.vtu, and cut into pieces as ghosts.pvtu (each piece has its neighbours' cells
as ghosts, too), plain.pvtu and pieces.vtu. Exits with 77 where VTK is not installed.
"""
import itertools
import random
import sys

try:
    import vtkmodules.vtkCommonCore as core
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkFiltersParallel import vtkExtractUnstructuredGridPiece
    from vtkmodules.vtkIOParallelXML import vtkXMLPUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
except ImportError:
    sys.exit(77)

SIDE = 4
CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def make_grid():
    rng = random.Random(11)
    places = list(itertools.product(range(SIDE + 1), repeat=3))
    middles = [(x + .5, y + .5, z + .5) for x, y, z in itertools.product(range(SIDE), repeat=3)
               if (x + y + z) % 3 == 0 and (x, y) != (1, 1)]
    all_places = places + middles
    rng.shuffle(all_places)
    number = {place: i for i, place in enumerate(all_places)}
    points = core.vtkPoints()
    points.SetDataTypeToDouble()
    scalar, vector = core.vtkDoubleArray(), core.vtkDoubleArray()
    scalar.SetName("height")
    vector.SetName("velocity")
    vector.SetNumberOfComponents(3)
    for x, y, z in all_places:
        points.InsertNextPoint(x * .1, y / 3, z)
        scalar.InsertNextValue(x + 10 * y + 100 * z)
        vector.InsertNextTuple((x, -2 * y, z * z))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.GetPointData().AddArray(scalar)
    grid.GetPointData().AddArray(vector)
    of_cells = core.vtkIntArray()
    of_cells.SetName("cell")

    def add(kind, corners):
        ids = core.vtkIdList()
        for corner in corners:
            ids.InsertNextId(corner)
        grid.InsertNextCell(kind, ids)
        of_cells.InsertNextValue(of_cells.GetNumberOfTuples())

    for x, y, z in itertools.product(range(SIDE), repeat=3):
        c = [number[(x + i, y + j, z + k)] for i, j, k in CUBE]
        if (x, y) == (1, 1):
            add(13, (c[0], c[2], c[1], c[4], c[6], c[5]))
            add(13, (c[0], c[3], c[2], c[4], c[7], c[6]))
        elif (x + y + z) % 3 == 0:
            m = number[(x + .5, y + .5, z + .5)]
            for quad in ((0, 1, 2, 3), (7, 6, 5, 4), (4, 5, 1, 0), (3, 2, 6, 7), (0, 3, 7, 4), (1, 5, 6, 2)):
                add(14, [c[i] for i in quad] + [m])
        else:
            add(12, c)
    grid.GetCellData().AddArray(of_cells)
    return grid


def main(folder):
    grid = make_grid()
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(folder + "/whole.vtu")
    writer.Write()
    for name, ghosts in (("ghosts", 1), ("plain", 0)):
        cut = vtkExtractUnstructuredGridPiece()
        cut.SetInputData(grid)
        cut.SetCreateGhostCells(bool(ghosts))
        parallel = vtkXMLPUnstructuredGridWriter()
        parallel.SetInputConnection(cut.GetOutputPort())
        parallel.SetNumberOfPieces(4)
        parallel.SetStartPiece(0)
        parallel.SetEndPiece(3)
        parallel.SetGhostLevel(ghosts)
        parallel.SetFileName(f"{folder}/{name}.pvtu")
        parallel.Write()
    cut = vtkExtractUnstructuredGridPiece()
    cut.SetInputData(grid)
    cut.SetCreateGhostCells(False)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputConnection(cut.GetOutputPort())
    writer.SetNumberOfPieces(3)
    writer.SetFileName(folder + "/pieces.vtu")
    writer.Write()


if __name__ == "__main__":
    main(sys.argv[1])
