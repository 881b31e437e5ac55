# SPDX-License-Identifier: Apache-2.0
"""Random meshes of tets, and the files that hold them."""
from dataclasses import dataclass

import numpy

from . import delaunay

# A cube's six tets along its diagonal (Kuhn); corners x + 2 y + 4 z.
KUHN = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]


@dataclass
class Mesh:
    points: numpy.ndarray
    tets: numpy.ndarray
    values: numpy.ndarray
    kind: str

    def finite_range(self):
        values = self.values[numpy.isfinite(self.values)]
        return (values.min(), values.max()) if values.size else None


def kuhn(size):
    x, y, z = (numpy.arange(n + 1) for n in size)
    points = numpy.array([(a, b, c) for c in z for b in y for a in x], float)
    row, layer = size[0] + 1, (size[0] + 1) * (size[1] + 1)
    tets = []
    for c in range(size[2]):
        for b in range(size[1]):
            for a in range(size[0]):
                first = a + b * row + c * layer
                corner = [first + (k & 1) + ((k >> 1) & 1) * row + (k >> 2) * layer for k in range(8)]
                tets += [[corner[k] for k in tet] for tet in KUHN]
    return points / max(size), numpy.array(tets)


def random_delaunay(dice):
    """Points nearly in a plane may have no tets; then others are drawn."""
    count = dice.whole(5, 26)
    places = [tuple(dice.whole(0, 1 << 16) for _ in range(3)) for _ in range(count)]
    if dice.chance(0.3):  # nearly in a plane, or in layers
        places = [(x, y, z >> dice.whole(8, 14) if dice.chance(0.8) else z) for x, y, z in places]
    places = sorted(set(places))
    tets = delaunay.tetrahedra(places)
    return (numpy.array(places, float) / (1 << 16), numpy.array(tets)) if tets else random_delaunay(dice)


def values_of(points, dice):
    kind = dice.weighted(ramp=2, noise=3, constant=0.5, labels=1, radial=2, one=1)
    if kind == "ramp":
        return points @ numpy.array(dice.vector(-1, 1))
    if kind == "constant":
        return numpy.full(len(points), dice.share())
    if kind == "radial":
        return ((points - dice.vector(0, 1)) ** 2).sum(1)
    noise = dice.array(len(points))
    if kind == "labels":
        return numpy.floor(noise * 4)
    return noise * (noise == noise.max()) if kind == "one" else noise


def make(dice, scale):
    kind = dice.weighted(kuhn=2, delaunay=4)
    if kind == "kuhn":
        points, tets = kuhn([dice.whole(1, 4) for _ in range(3)])
        if dice.chance(0.4):
            kind += ", moved"
            points = points + (dice.array(*points.shape) - 0.5) * 0.2 / max(points.max() * 4, 1)
    else:
        points, tets = random_delaunay(dice)
    if dice.chance(0.3) and len(tets) > 4:
        kind += ", holes"
        kept = dice.array(len(tets)) > dice.between(0.1, 0.6)
        tets = tets[kept] if kept.any() else tets
    if dice.chance(0.3):
        kind += ", squeezed"
        points = points * [dice.log_between(1e-4, 1) if dice.chance(0.5) else 1 for _ in range(3)]
    values = numpy.round(values_of(points, dice), 9)
    points = numpy.round(points, 12)
    if dice.chance(0.3):
        points = points @ dice.rotation().T
    points = (points + (dice.vector(-2, 2) if dice.chance(0.5) else [0, 0, 0])) * scale
    if dice.chance(0.15):
        values[dice.array(len(values)) < 0.1] = numpy.nan
    if dice.chance(0.3):  # inverted ones are turned
        tets = tets[:, [1, 0, 2, 3]]
    used = numpy.unique(tets)
    return Mesh(points[used], numpy.searchsorted(used, tets), values[used], kind)


def text(rows):
    return "\n".join(" ".join(repr(x) for x in row) for row in rows) + "\n"


def vtk(mesh):
    return ("# vtk DataFile Version 3.0\nrandom\nASCII\nDATASET UNSTRUCTURED_GRID\n"
            f"POINTS {len(mesh.points)} double\n" + text(mesh.points.tolist())
            + f"CELLS {len(mesh.tets)} {5 * len(mesh.tets)}\n" + text([4, *tet] for tet in mesh.tets.tolist())
            + f"CELL_TYPES {len(mesh.tets)}\n" + "10\n" * len(mesh.tets)
            + f"POINT_DATA {len(mesh.points)}\nSCALARS s double 1\nLOOKUP_TABLE default\n"
            + text([value] for value in mesh.values.tolist()))


def tetgen(mesh):
    """.node and .ele"""
    points = [[i, *point, value] for i, (point, value) in enumerate(zip(mesh.points.tolist(), mesh.values.tolist()))]
    tets = [[i, *tet] for i, tet in enumerate(mesh.tets.tolist())]
    return (f"{len(points)} 3 1 0\n" + text(points), f"{len(tets)} 4 0\n" + text(tets))


def files(mesh, dice):
    """Name of the one that a scene names, and contents by name."""
    if dice.chance(0.5):
        return "mesh.vtk", {"mesh.vtk": vtk(mesh).encode()}
    node, ele = tetgen(mesh)
    return "mesh.node", {"mesh.node": node.encode(), "mesh.ele": ele.encode()}
