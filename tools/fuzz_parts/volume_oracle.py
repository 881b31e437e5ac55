# SPDX-License-Identifier: Apache-2.0
"""A volume along rays, written from docs/scene.md alone: the trilinear field, cell by cell, or the constant field of each
voxel, as pieces for emission.py; and slabs as post-classified slicing takes them."""
import numpy

from . import clips
from .emission import Pieces, integrate, joined


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


def voxel_values(samples, voxel):
    """The samples of voxels; outside, the border value repeats. [n], [n]: finite."""
    x, y, z = numpy.clip(voxel, 0, numpy.array(samples.shape) - 1).T
    value = samples[x, y, z].astype(float)
    return numpy.where(numpy.isfinite(value), value, 0), numpy.isfinite(value)


class IndexRays:
    """Rays in coordinates of samples, clipped to the box, to the scene's clip and to z >= 0."""

    def __init__(self, volume, origins, directions, clip=None):
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
        # Rays along a face, within roundings of it: nothing says on which side they are.
        beside = numpy.minimum(numpy.abs(self.origin - low), numpy.abs(self.origin - high)) < 1e-12 * (1 + high)
        along = numpy.abs(self.slope) * self.far[:, None] < 1e-12 * (1 + high)
        kept_near, kept_far, kept_tied = clips.spans(clip, origins, directions)
        self.near = numpy.maximum(self.near, kept_near)
        self.far = numpy.maximum(self.near, numpy.minimum(self.far, kept_far))
        self.tied = (beside & along).any(1) | kept_tied


def pieces(volume, origins, directions, clip=None):
    """Cells or voxels along each ray, as cubics."""
    rays = IndexRays(volume, origins, directions, clip)
    low, high = volume.corners()
    first = 0.5 if volume.nearest else 0  # faces of voxels lie between samples
    numbers, starts, ends, cells = [], [], [], []
    for i in range(len(rays.near)):
        if not rays.near[i] < rays.far[i]:
            continue
        cuts = [numpy.array([rays.near[i], rays.far[i]])]
        for axis in range(3):
            if rays.slope[i, axis] != 0:
                planes = numpy.arange(numpy.ceil(low[axis] - first), numpy.floor(high[axis] - first) + 1) + first
                cuts.append((planes - rays.origin[i, axis]) / rays.slope[i, axis])
        cuts = numpy.unique(numpy.clip(numpy.concatenate(cuts), rays.near[i], rays.far[i]))
        middles = rays.origin[i] + ((cuts[:-1] + cuts[1:]) / 2)[:, None] * rays.slope[i]
        numbers.append(numpy.full(len(cuts) - 1, i))
        starts.append(cuts[:-1])
        ends.append(cuts[1:])
        cells.append(numpy.floor(middles + first).astype(int))
    if not numbers:
        return Pieces(numpy.zeros(0, int), numpy.zeros(0), numpy.zeros(0), numpy.zeros((0, 4)))
    ray, start, end, cell = map(numpy.concatenate, (numbers, starts, ends, cells))
    # The cubic through four places of the cell, as Bernstein coefficients.
    values = []
    for share in (0, 1 / 3, 2 / 3, 1):
        place = rays.origin[ray] + (start + share * (end - start))[:, None] * rays.slope[ray]
        if volume.nearest:
            value, finite = voxel_values(volume.samples, cell)
        else:
            value, finite = trilinear(volume.samples, cell, numpy.clip(place - cell, 0, 1))
        values.append(value)
    a, b, c, d = values
    scalars = numpy.stack([a, (-5 * a + 18 * b - 9 * c + 2 * d) / 6, (2 * a - 9 * b + 18 * c - 5 * d) / 6, d], 1)
    constant = (a == b) & (b == c) & (c == d)
    scalars[constant] = a[constant, None]
    found = Pieces(ray, start * rays.world[ray], (end - start) * rays.world[ray], scalars)
    return found.at(finite & (end > start))


class SlabRays:
    """Some pixels' rays (column and row), cut by slabs of equal thickness between the box's nearest and farthest depth
    before the eye."""

    def __init__(self, volume, rays, pixels, count, clip=None):
        self.volume, self.count = volume, count
        self.low, self.high = volume.corners()
        depths = (volume.world_corners() - rays.eye) @ rays.forward
        self.near, self.far = max(depths.min(), 0.0), max(depths.max(), 0.0)
        self.chord = IndexRays(volume, *rays.of(*pixels), clip)
        lowest, highest = volume.finite_range() or (0, 0)
        # Scalars are made of values up to the range, weights of places up to the size: a few roundings of float32 each.
        self.doubt = (2.0 ** -24 * (8 + 2 * max(volume.samples.shape)) * (highest - lowest)
                      + 2.0 ** -23 * max(abs(lowest), abs(highest)))

    def slab(self, number):
        """The rays that have a part in it, and where in z that starts and ends."""
        start = numpy.maximum(self.near + (self.far - self.near) * number / self.count, self.chord.near)
        end = numpy.minimum(self.near + (self.far - self.near) * (number + 1) / self.count, self.chord.far)
        hit = numpy.flatnonzero(end > start)
        return hit, start[hit], end[hit]

    def scalar(self, hit, z):
        """Value, whether it is one, and the place in the volume."""
        place = self.chord.origin[hit] + z[:, None] * self.chord.slope[hit]
        cell = numpy.clip(numpy.floor(place), numpy.floor(self.low), numpy.ceil(self.high) - 1).astype(int)
        return *trilinear(self.volume.samples, cell, numpy.clip(place - cell, 0, 1)), place


def post_classified(rays, optics):
    """Colours [n, 4] of slabs that show what is in the middle of each segment, composited exactly, and how far
    roundings of float32 in the scalar can take each from them."""
    count = len(rays.chord.near)
    picture, bound = numpy.zeros((count, 4)), numpy.zeros(count)
    clear, clearer = numpy.ones(count), numpy.ones(count)
    holes = not numpy.isfinite(rays.volume.samples).all()
    for slab in range(rays.count):
        hit, start, end = rays.slab(slab)
        if not len(hit):
            continue
        scalar, finite, place = rays.scalar(hit, (start + end) / 2)
        length = (end - start) * rays.chord.world[hit] * finite
        looks = [optics.at(scalar + offset) for offset in (0, -rays.doubt, rays.doubt)]
        alphas = [-numpy.expm1(-look[:, 3] * length) for look in looks]
        least, most = numpy.minimum.reduce(alphas), numpy.maximum.reduce(alphas)
        spread = most - least
        if holes:  # next to a face of cells that show nothing, roundings decide which side counts
            edge = numpy.abs(place - numpy.round(place)).min(1) < 2.0 ** -20 * max(rays.volume.samples.shape)
            spread = numpy.where(edge, 1.0, spread)
        colors = [look[:, :3] for look in looks]
        color_spread = (numpy.maximum.reduce(colors) - numpy.minimum.reduce(colors)).max(1)
        picture[hit, :3] += (clear[hit] * alphas[0])[:, None] * colors[0]
        picture[hit, 3] += clear[hit] * alphas[0]
        bound[hit] += clearer[hit] * (spread * optics.brightest + most * color_spread)
        clear[hit] *= 1 - alphas[0]
        clearer[hit] *= 1 - least
    return picture, bound


def preintegrated(rays, optics):
    """Returns the picture of slabs in which the scalar runs straight from end to end, moved so that its mean is that
    of the parabola through both and the middle (docs/precision.md), within the range of the data; what shows nothing
    between the least and the largest of the three shows nothing."""
    parts, samples = [], []
    for slab in range(rays.count):
        hit, start, end = rays.slab(slab)
        samples.append(numpy.stack([rays.scalar(hit, z)[0] for z in (start, (start + end) / 2, end)], 1))
        parts.append(Pieces(hit, start * rays.chord.world[hit], (end - start) * rays.chord.world[hit], samples[-1]))
    parts, samples = joined(*parts), numpy.concatenate(samples)
    bend = 2 / 3 * (samples[:, 1] - (samples[:, 0] + samples[:, 2]) / 2)
    ends = numpy.clip(samples[:, [0, 2]] + bend[:, None], *rays.volume.finite_range())
    pictures = []
    # Roundings of the ends, and (the last one counts) of the least and the largest sample.
    for front, back, wider in ((0, 0, 0), (1, 1, 0), (-1, -1, 0), (1, -1, 0), (-1, 1, 0), (0, 0, 1), (0, 0, -1)):
        shifted = ends + rays.doubt * numpy.array([front, back])
        scalars = shifted[:, :1] + (shifted[:, 1:] - shifted[:, :1]) * numpy.array([0, 1 / 3, 2 / 3, 1])
        same = ends[:, 0] == ends[:, 1]
        scalars[same] = shifted[same][:, :1]
        seen = optics.shows(samples.min(1) - wider * rays.doubt, samples.max(1) + wider * rays.doubt)
        pieces = Pieces(parts.ray, parts.start, parts.length, scalars).at(seen)
        pictures.append(integrate(pieces, optics, len(rays.chord.near))[0])
    return pictures[0], 2 * numpy.abs(numpy.array(pictures) - pictures[0]).max((0, 2))
