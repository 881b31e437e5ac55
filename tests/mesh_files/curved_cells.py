#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""curved_cells.py FOLDER: with VTK's own writers, writes quadratic cells, Lagrange cells and polyhedra
to FOLDER, as .vtu and as .vtk; and beside each file NAME.expected: what VTK says of it. Exits with 77
where VTK is not installed.

NAME.expected: "volume V" (0: not known), "boundary N" (triangles of the surface), "turned N" (0, or -1: not
known), then "made X Y Z S" for each point that the file lacks, in their order, with the value of array s
there. Array "linear" is 1 + x + 2 y - 3 z.
"""
import itertools
import random
import sys

try:
    import vtkmodules.vtkCommonCore as core
    import vtkmodules.vtkCommonDataModel as model
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
except ImportError:
    sys.exit(77)

FOLDER = sys.argv[1]
RNG = random.Random(17)
# World = SHEAR (parameters), a map of determinant 3.5.
SHEAR = [(2, .5, 0), (0, 1.5, .25), (1, 0, 1.125)]
DETERMINANT = 2 * (1.5 * 1.125 - 0) - .5 * (0 - .25 * 1)


def world(p, noise=0.):
    return tuple(sum(a * b for a, b in zip(row, p)) + RNG.uniform(-noise, noise) for row in SHEAR)


def array(name, values, components=1):
    made = core.vtkDoubleArray()
    made.SetName(name)
    made.SetNumberOfComponents(components)
    for value in values:
        made.InsertNextValue(value)
    return made


def write(name, places, cells, volume=0., boundary=0, turned=0, made=(), values=None, degrees=None):
    """cells: (type, points) or, for polyhedra, (42, faces). made: pairs of parameters and a VTK cell."""
    grid = model.vtkUnstructuredGrid()
    points = core.vtkPoints()
    points.SetDataTypeToDouble()
    for place in places:
        points.InsertNextPoint(place)
    grid.SetPoints(points)
    for kind, corners in cells:
        ids = core.vtkIdList()
        if kind == 42:
            ids.InsertNextId(len(corners))
            for face in corners:
                for number in (len(face), *face):
                    ids.InsertNextId(number)
        else:
            for number in corners:
                ids.InsertNextId(number)
        grid.InsertNextCell(kind, ids)
    values = values or [RNG.uniform(-1, 1) for _ in places]
    grid.GetPointData().AddArray(array("s", values))
    grid.GetPointData().AddArray(array("linear", [1 + x + 2 * y - 3 * z for x, y, z in places]))
    if degrees:
        grid.GetCellData().SetHigherOrderDegrees(array("orders", degrees, 3))
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(f"{FOLDER}/{name}.vtu")
    writer.Write()
    names = [name + ".vtu"]
    for version in () if degrees else (42, 51):
        if version == 42 and any(kind == 72 for kind, _ in cells):
            continue  # VTK does not write the old order of points
        legacy = vtkUnstructuredGridWriter()
        legacy.SetInputData(grid)
        legacy.SetFileVersion(version)
        legacy.SetFileType(2)
        legacy.SetFileName(f"{FOLDER}/{name}-{version}.vtk")
        legacy.Write()
        names.append(f"{name}-{version}.vtk")
    for file in names:
        with open(f"{FOLDER}/{file}.expected", "w") as out:
            print("volume", repr(volume), file=out)
            print("boundary", boundary, file=out)
            print("turned", turned, file=out)
            for parameters, cell in made:
                weights = [0.] * len(places)
                cell.InterpolateFunctions(parameters, weights)
                place = [sum(w * p[i] for w, p in zip(weights, places)) for i in range(3)]
                print("made", *map(repr, place), repr(sum(w * v for w, v in zip(weights, values))), file=out)


def write_apart(name, places, cells, volume, boundary):
    """Gives each cell points of its own, in random numbers."""
    own = [(i, number) for i, (kind, corners) in enumerate(cells)
           for number in sorted({n for face in corners for n in face} if kind == 42 else corners)]
    RNG.shuffle(own)
    new = {pair: i for i, pair in enumerate(own)}
    apart = [(kind, [[new[i, n] for n in face] for face in corners] if kind == 42 else [new[i, n] for n in corners])
             for i, (kind, corners) in enumerate(cells)]
    write("apart-" + name, [places[n] for _, n in own], apart, volume, boundary)


PYRAMID = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, .5, 1)]
PYRAMID_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]


def mean(places):
    return tuple(sum(c) / len(places) for c in zip(*places))


def parameters_of(cell):
    count = cell.GetNumberOfPoints()
    if count not in (13, 19):
        flat = cell.GetParametricCoords()
        return [tuple(flat[3 * i:3 * i + 3]) for i in range(count)]
    # A pyramid in the world, because VTK's parameters are those of a collapsed cube.
    places = PYRAMID + [mean([PYRAMID[a], PYRAMID[b]]) for a, b in PYRAMID_EDGES] + [(.5, .5, 0)]
    places += [mean([PYRAMID[a], PYRAMID[b], PYRAMID[4]]) for a, b in PYRAMID_EDGES[:4]] + [(.5, .5, .25)]
    return places[:count]


FACES = [(0, .5, .5), (1, .5, .5), (.5, 0, .5), (.5, 1, .5), (.5, .5, 0), (.5, .5, 1)]
MIDDLE = [(.5, .5, .5)]
WEDGE_FACES = [(.5, 0, .5), (.5, .5, .5), (0, .5, .5)]
QUADRATIC = [  # type, class, parameters of made points, volume in parameters, triangles of the surface
    (24, model.vtkQuadraticTetra, [], 1 / 6, 16), (25, model.vtkQuadraticHexahedron, FACES + MIDDLE, 1, 48),
    (26, model.vtkQuadraticWedge, WEDGE_FACES, 1 / 2, 32), (27, model.vtkQuadraticPyramid, [(.5, .5, 0)], 1 / 3, 24),
    (29, model.vtkTriQuadraticHexahedron, [], 1, 48), (31, model.vtkQuadraticLinearWedge, [], 1 / 2, 20),
    (32, model.vtkBiQuadraticQuadraticWedge, [], 1 / 2, 32),
    (33, model.vtkBiQuadraticQuadraticHexahedron, FACES[4:] + MIDDLE, 1, 48),
    (37, getattr(model, "vtkTriQuadraticPyramid", None), [], 1 / 3, 32)]


def write_quadratic():
    for kind, make, made, volume, boundary in QUADRATIC:
        if make is None:
            continue
        cell = make()
        parameters = parameters_of(cell)
        numbers = list(range(len(parameters)))
        pairs = [(p, cell) for p in made]
        write(f"straight-{kind}", [world(p) for p in parameters], [(kind, numbers)], volume * DETERMINANT,
              boundary, 0, pairs)
        write(f"bent-{kind}", [world(p, .05) for p in parameters], [(kind, numbers)], 0, boundary, 0, pairs)


def lagrange(kind, n, m, k):
    """The places of a Lagrange cell's points in parameters."""
    places = {}
    for c, b, a in itertools.product(range(k + 1), range(m + 1), range(n + 1)):
        if kind == 72:
            places[model.vtkLagrangeHexahedron.PointIndexFromIJK(a, b, c, [n, m, k])] = (a / n, b / m, c / k)
        elif kind == 73 and a + b <= n:
            places[model.vtkLagrangeWedge.PointIndexFromIJK(a, b, c, [n, n, k])] = (a / n, b / n, c / k)
        elif kind == 71 and a + b + c <= n:
            places[model.vtkLagrangeTetra.Index([a, b, c, n - a - b - c], n)] = (a / n, b / n, c / n)
    return [places[i] for i in range(len(places))]


def write_lagrange():
    for n in range(1, 11):
        for kind, volume, triangles in ((71, 1 / 6, 4), (72, 1, 12), (73, 1 / 2, 8)):
            places = [world(p) for p in lagrange(kind, n, n, n)]
            write(f"lagrange-{kind}-{n}", places, [(kind, range(len(places)))], volume * DETERMINANT,
                  triangles * n * n)
    for n, m, k in ((2, 3, 4), (7, 3, 1)):  # as many points as order 3 has
        places = [world(p) for p in lagrange(72, n, m, k)]
        write(f"orders-72-{n}{m}{k}", places, [(72, range(len(places)))], DETERMINANT,
              4 * (n * m + n * k + m * k), degrees=(n, m, k))
    for n, k in ((3, 1), (1, 6)):  # the second has as many points as VTK's wedge with points inside
        places = [world(p) for p in lagrange(73, n, n, k)]
        write(f"orders-73-{n}{n}{k}", places, [(73, range(len(places)))], DETERMINANT / 2, 2 * n * n + 6 * n * k,
              degrees=(n, n, k))


def write_neighbours():
    """4 x 4 x 4 cubes: quadratic hexahedra, pairs of quadratic wedges, and six quadratic pyramids; and the
    same of order 3 without pyramids. Points have random numbers."""
    cube = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    hexahedron, wedge = model.vtkQuadraticHexahedron(), model.vtkQuadraticWedge()
    for name, order in (("neighbours-2", 2), ("neighbours-3", 3)):
        cells = []
        for x, y, z in itertools.product(range(4), repeat=3):
            at = [tuple(a + b for a, b in zip((x, y, z), c)) for c in cube]

            def within(p):
                return tuple(a + b for a, b in zip((x, y, z), p))

            if (x, y) == (1, 1):
                for corners in ((0, 1, 2), (0, 2, 3)):
                    a, b, c = (at[i] for i in corners)
                    parameters = parameters_of(wedge) if order == 2 else lagrange(73, 3, 3, 3)
                    cells.append((26 if order == 2 else 73, [tuple(
                        round(a[i] + (b[i] - a[i]) * p[0] + (c[i] - a[i]) * p[1] + (p[2] if i == 2 else 0), 9)
                        for i in range(3)) for p in parameters]))
            elif order == 2 and (x + y + z) % 3 == 0:
                apex = within((.5, .5, .5))
                for quad in ((0, 1, 2, 3), (7, 6, 5, 4), (4, 5, 1, 0), (3, 2, 6, 7), (0, 3, 7, 4), (1, 5, 6, 2)):
                    corners = [at[i] for i in quad] + [apex]
                    cells.append((27, corners + [mean([corners[a], corners[b]]) for a, b in PYRAMID_EDGES]))
            else:
                parameters = parameters_of(hexahedron) if order == 2 else lagrange(72, 3, 3, 3)
                cells.append((25 if order == 2 else 72, [tuple(round(c, 9) for c in within(p)) for p in parameters]))
        places = sorted({place for _, corners in cells for place in corners})
        RNG.shuffle(places)
        number = {place: i for i, place in enumerate(places)}
        cells = [(kind, [number[c] for c in corners]) for kind, corners in cells]
        write(name, places, cells, 64., 6 * 16 * 2 * order * order)
        write_apart(name, [world(p, .01) for p in places], cells, 0., 6 * 16 * 2 * order * order)


def write_polyhedra():
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    cube = [world(p) for p in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
    write("cube", cube, [(42, faces)], DETERMINANT, 12)
    write("senses", cube, [(42, [f[::-1] if i % 2 else f for i, f in enumerate(faces)])], DETERMINANT, 12)
    # A cube of side 2 beside four of side 1, whose corners lie on its edges and its face, in random numbers.
    for turn in range(5):
        numbers = {}
        places = list(itertools.product(range(4), range(3), range(3)))
        RNG.shuffle(places)
        places = [p for p in places if p[0] >= 2 or (p[0] == 0 and p[1] != 1 and p[2] != 1)]
        numbers = {place: i for i, place in enumerate(places)}

        def face(*corners):
            return [numbers[c] for c in corners]

        big = [face((0, 0, 0), (0, 0, 2), (0, 2, 2), (0, 2, 0)),
               face((0, 0, 0), (2, 0, 0), (2, 0, 1), (2, 0, 2), (0, 0, 2)),
               face((0, 2, 0), (0, 2, 2), (2, 2, 2), (2, 2, 1), (2, 2, 0)),
               face((0, 0, 0), (0, 2, 0), (2, 2, 0), (2, 1, 0), (2, 0, 0)),
               face((0, 0, 2), (2, 0, 2), (2, 1, 2), (2, 2, 2), (0, 2, 2))]
        cells = []
        for b, c in itertools.product((0, 1), repeat=2):
            big.append(face((2, b, c), (2, b + 1, c), (2, b + 1, c + 1), (2, b, c + 1)))
            cells.append((12, face(*[(2 + i, b + j, c + k) for i, j, k in
                                     ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))])))
        # The surface: a square and 4 pentagons of the big cube, and 12 squares of the small ones.
        cells.append((42, big))
        write(f"hanging-{turn}", places, cells, 12., 2 + 4 * 3 + 12 * 2)
        write_apart(f"hanging-{turn}", places, cells, 12., 2 + 4 * 3 + 12 * 2)


if __name__ == "__main__":
    write_quadratic()
    write_lagrange()
    write_neighbours()
    write_polyhedra()
