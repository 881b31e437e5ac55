# SPDX-License-Identifier: Apache-2.0
"""A volume along rays, written from docs/scene.md alone: the trilinear field, cell by cell, as pieces for emission.py;
and slabs as post-classified slicing takes them."""
import numpy

from .emission import Pieces


def trilinear(samples, cell, local):
    """The field of a cell at coordinates 0..1 in it; outside the samples the border value repeats. [n], [n]: finite."""
    last = numpy.array(samples.shape) - 1
    low, high = numpy.clip(cell, 0, last), numpy.clip(cell + 1, 0, last)
    found, finite, least, most = 0, True, numpy.inf, -numpy.inf
    for corner in range(8):
        upper = [(corner >> axis) & 1 for axis in range(3)]
        x, y, z = (numpy.where(u, high[:, a], low[:, a]) for a, u in enumerate(upper))
        value = samples[x, y, z].astype(float)
        finite = finite & numpy.isfinite(value)
        weight = 1.0
        for axis, u in enumerate(upper):
            weight = weight * (local[:, axis] if u else 1 - local[:, axis])
        value = numpy.where(numpy.isfinite(value), value, 0)
        found, least, most = found + weight * value, numpy.minimum(least, value), numpy.maximum(most, value)
    return numpy.clip(found, least, most), finite  # exactly constant in a constant cell


class IndexRays:
    """Rays in coordinates of samples, clipped to the box and to z >= 0."""

    def __init__(self, volume, origins, directions):
        # Directions of steps are at right angles: the inverse is a projection on each.
        scale = numpy.abs(volume.steps).max()
        steps = volume.steps / scale
        inverse = (steps / (steps ** 2).sum(0)).T
        self.origin = (origins - volume.origin) / scale @ inverse.T
        self.slope = directions / scale @ inverse.T
        self.world = numpy.linalg.norm(directions, axis=1)
        low, high = volume.corners()
        with numpy.errstate(divide="ignore", invalid="ignore"):
            a, b = (low - self.origin) / self.slope, (high - self.origin) / self.slope
        flat = self.slope == 0
        outside = flat & ((self.origin < low) | (self.origin > high))
        near = numpy.where(flat, -numpy.inf, numpy.minimum(a, b)).max(1)
        far = numpy.where(flat, numpy.inf, numpy.maximum(a, b)).min(1)
        self.near = numpy.maximum(near, 0)
        self.far = numpy.where(outside.any(1), self.near, numpy.maximum(far, self.near))


def pieces(volume, origins, directions):
    """Cells along each ray, as cubics."""
    rays = IndexRays(volume, origins, directions)
    low, high = volume.corners()
    numbers, starts, ends, cells = [], [], [], []
    for i in range(len(rays.near)):
        if not rays.near[i] < rays.far[i]:
            continue
        cuts = [numpy.array([rays.near[i], rays.far[i]])]
        for axis in range(3):
            if rays.slope[i, axis] != 0:
                planes = numpy.arange(numpy.ceil(low[axis]), numpy.floor(high[axis]) + 1)
                cuts.append((planes - rays.origin[i, axis]) / rays.slope[i, axis])
        cuts = numpy.unique(numpy.clip(numpy.concatenate(cuts), rays.near[i], rays.far[i]))
        middles = rays.origin[i] + ((cuts[:-1] + cuts[1:]) / 2)[:, None] * rays.slope[i]
        numbers.append(numpy.full(len(cuts) - 1, i))
        starts.append(cuts[:-1])
        ends.append(cuts[1:])
        cells.append(numpy.floor(middles).astype(int))
    if not numbers:
        return Pieces(numpy.zeros(0, int), numpy.zeros(0), numpy.zeros(0), numpy.zeros((0, 4)))
    ray, start, end, cell = map(numpy.concatenate, (numbers, starts, ends, cells))
    # The cubic through four places of the cell, as Bernstein coefficients.
    values = []
    for share in (0, 1 / 3, 2 / 3, 1):
        place = rays.origin[ray] + (start + share * (end - start))[:, None] * rays.slope[ray]
        value, finite = trilinear(volume.samples, cell, numpy.clip(place - cell, 0, 1))
        values.append(value)
    a, b, c, d = values
    scalars = numpy.stack([a, (-5 * a + 18 * b - 9 * c + 2 * d) / 6, (2 * a - 9 * b + 18 * c - 5 * d) / 6, d], 1)
    constant = (a == b) & (b == c) & (c == d)
    scalars[constant] = a[constant, None]
    found = Pieces(ray, start * rays.world[ray], (end - start) * rays.world[ray], scalars)
    return found.at(finite & (end > start))


def slabs(volume, optics, rays, pixels, count):
    """Of some pixels (column and row): the colours [n, 4] of so many post-classified slabs, composited exactly, and how
    far roundings of float32 in the scalar can take each from them."""
    origins, directions = rays.of(*pixels)
    low, high = volume.corners()
    corners = [volume.to_world([(low, high)[(c >> a) & 1][a] for a in range(3)]) for c in range(8)]
    depths = [float((corner - rays.eye) @ rays.forward) for corner in corners]
    near, far = max(min(depths), 0), max(max(depths), 0)
    chord = IndexRays(volume, origins, directions)
    value_range = volume.finite_range() or (0, 0)
    # Scalars are made of values up to the range, weights of places up to the size: a few roundings of each.
    size = max(volume.samples.shape)
    doubt = 2.0 ** -24 * (8 + 2 * size) * (value_range[1] - value_range[0]) + 2.0 ** -23 * max(map(abs, value_range))
    picture, bound = numpy.zeros((len(origins), 4)), numpy.zeros(len(origins))
    clear, clearer = numpy.ones(len(origins)), numpy.ones(len(origins))
    for slab in range(count):
        start = numpy.maximum(near + (far - near) * slab / count, chord.near)
        end = numpy.minimum(near + (far - near) * (slab + 1) / count, chord.far)
        hit = numpy.flatnonzero(end > start)
        if not len(hit):
            continue
        middle = chord.origin[hit] + ((start + end) / 2)[hit, None] * chord.slope[hit]
        cell = numpy.clip(numpy.floor(middle), numpy.floor(low), numpy.ceil(high) - 1).astype(int)
        scalar, finite = trilinear(volume.samples, cell, numpy.clip(middle - cell, 0, 1))
        length = (end - start)[hit] * chord.world[hit] * finite
        looks = [optics.at(scalar + offset) for offset in (0, -doubt, doubt)]
        # Next to a face of cells that show nothing (NaN), roundings decide which side counts.
        edge = numpy.abs(middle - numpy.round(middle)).min(1) < 2.0 ** -20 * size
        alphas = [-numpy.expm1(-look[:, 3] * length) for look in looks]
        least = numpy.minimum.reduce(alphas)
        spread = numpy.maximum.reduce(alphas) - least
        colors = [look[:, :3] for look in looks]
        color_spread = (numpy.maximum.reduce(colors) - numpy.minimum.reduce(colors)).max(1)
        if not numpy.isfinite(volume.samples).all():
            spread = numpy.where(edge, 1.0, spread)
        picture[hit, :3] += (clear[hit] * alphas[0])[:, None] * colors[0]
        picture[hit, 3] += clear[hit] * alphas[0]
        bound[hit] += clearer[hit] * (spread * optics.brightest + numpy.maximum.reduce(alphas) * color_spread)
        clear[hit] *= 1 - alphas[0]
        clearer[hit] *= 1 - least
    return picture, bound
