# SPDX-License-Identifier: Apache-2.0
"""Delaunay tets of a few points with whole coordinates (Bowyer 1981, Watson 1981), by exact arithmetic."""


def determinant(rows):
    """Determinant of whole numbers, 3 x 3 or 4 x 4."""
    if len(rows) == 3:
        (a, b, c), (d, e, f), (g, h, i) = rows
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return sum((-1) ** column * rows[0][column]
               * determinant([[x for k, x in enumerate(row) if k != column] for row in rows[1:]])
               for column in range(len(rows)) if rows[0][column])


def orientation(a, b, c, d):
    return determinant([[p[i] - d[i] for i in range(3)] for p in (a, b, c)])


def in_sphere(tet, point):
    """In-sphere test of a tet of positive orientation(): > 0 if the point lies inside its sphere."""
    rows = []
    for corner in tet:
        away = [corner[i] - point[i] for i in range(3)]
        rows.append([*away, sum(x * x for x in away)])
    return determinant(rows)


def tetrahedra(points):
    """Four numbers of points for each tet. The hull is that of the points, or a little less, as a big tet around all of
    them stands for the outside."""
    count = len(points)
    reach = 64 * max(abs(x) for p in points for x in p) + 64
    places = [*points, (-3 * reach, -2 * reach, -reach), (3 * reach, -2 * reach, -reach), (0, 5 * reach, -reach),
              (0, 0, 7 * reach)]

    def turned(tet):
        a, b, c, d = tet
        return tet if orientation(*(places[i] for i in tet)) > 0 else (b, a, c, d)

    tets = {turned((count, count + 1, count + 2, count + 3))}
    for number, point in enumerate(points):
        hit = [tet for tet in tets if in_sphere([places[i] for i in tet], point) > 0]
        faces = {}
        for tet in hit:
            for left_out in range(4):
                face = tuple(sorted(tet[:left_out] + tet[left_out + 1:]))
                faces[face] = face not in faces
        tets.difference_update(hit)
        tets.update(turned((*face, number)) for face, open_face in faces.items() if open_face)
    return sorted(tet for tet in tets if max(tet) < count)
