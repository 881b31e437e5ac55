# SPDX-License-Identifier: Apache-2.0
"""Random volumes: samples of all kinds on grids of all kinds, and the NRRD files that hold them."""
import gzip
from dataclasses import dataclass

import numpy

TYPES = {"uint8": "u1", "uint16": "<u2", "int16": "<i2", "float": "<f4"}


@dataclass
class Volume:
    """samples[x, y, z]; sample (0, 0, 0) lies at origin, columns of steps lead to the next ones."""
    samples: numpy.ndarray
    type: str
    cells: list  # per axis: whether it spans whole voxels
    origin: numpy.ndarray
    steps: numpy.ndarray
    kind: str
    nearest: bool = False  # each sample's value holds in its voxel

    def corners(self):
        """Lowest and highest index of the box."""
        size = numpy.array(self.samples.shape)
        voxels = numpy.array(self.cells) | (size == 1)
        return numpy.where(voxels, -0.5, 0), numpy.where(voxels, size - 0.5, size - 1)

    def to_world(self, index):
        return self.origin + self.steps @ numpy.asarray(index, float)

    def world_corners(self):
        low, high = self.corners()
        return numpy.array([self.to_world([(low, high)[(c >> a) & 1][a] for a in range(3)]) for c in range(8)])

    def finite_range(self):
        """None if no sample is finite."""
        values = self.samples.astype(float)
        values = values[numpy.isfinite(values)]
        return (values.min(), values.max()) if values.size else None


def sizes(dice):
    kind = dice.weighted(small=6, thin=2, line=1, single=0.3, wide=0.7)
    if kind == "wide":
        return [dice.whole(20, 64) for _ in range(3)]
    size = [dice.whole(2, 12) for _ in range(3)]
    if kind == "thin":
        size[dice.whole(0, 2)] = dice.whole(1, 2)
    if kind == "line":
        long = dice.whole(0, 2)
        size = [dice.whole(1, 2) for _ in range(3)]
        size[long] = dice.whole(2, 150)
    return [1, 1, 1] if kind == "single" else size


def field(kind, size, dice):
    """Numbers 0..1."""
    x, y, z = (numpy.linspace(0, 1, n).reshape([n if a == axis else 1 for a in range(3)])
               for axis, n in enumerate(size))
    if kind == "constant":
        return numpy.full(size, dice.share())
    if kind == "ramp":
        weights = [dice.whole(0, 3) for _ in range(3)]
        total = sum(weights) or 1
        return (weights[0] * x + weights[1] * y + weights[2] * z) / total + numpy.zeros(size)
    if kind == "noise":
        return dice.array(*size)
    if kind == "sparse":
        found = numpy.zeros(size)
        for _ in range(dice.whole(1, 8) if dice.chance(0.7) else dice.whole(20, 80)):
            found[tuple(dice.whole(0, n - 1) for n in size)] = dice.between(0.3, 1)
        return found
    if kind == "labels":
        labels = dice.whole(2, 6)
        coarse = dice.array(*[(n + 3) // 4 for n in size])
        spread = numpy.kron(numpy.floor(coarse * labels), numpy.ones((4, 4, 4)))
        return spread[:size[0], :size[1], :size[2]] / max(labels - 1, 1)
    if kind == "blobs":
        found = numpy.zeros(size)
        for _ in range(dice.whole(1, 4)):
            a, b, c, width = dice.share(), dice.share(), dice.share(), dice.between(0.02, 0.3)
            found = found + 1 / (1 + ((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) / width ** 2)
        return found / found.max()
    if kind == "blocks":
        found = numpy.full(size, dice.pick(0.0, 0.0, dice.share()))
        for _ in range(dice.whole(1, 4)):
            low = [dice.whole(0, n - 1) for n in size]
            high = [dice.whole(a + 1, n) for a, n in zip(low, size)]
            found[low[0]:high[0], low[1]:high[1], low[2]:high[2]] = dice.share()
        return found
    # sheets: a sample thick, across an axis
    found = numpy.zeros(size)
    axis = dice.whole(0, 2)
    for _ in range(dice.whole(1, 3)):
        numpy.moveaxis(found, axis, 0)[dice.whole(0, size[axis] - 1)] = dice.between(0.2, 1)
    return found


def with_type(values, kind, dice):
    if kind == "float":
        scale = dice.pick(1, 1, 255, dice.log_between(1e-3, 1e4), dice.log_between(1e-30, 1e30))
        offset = dice.pick(0, 0, -0.5, dice.between(-2, 2)) * scale
        return (values * scale + offset).astype("<f4")
    least, most = {"uint8": (0, 255), "uint16": (0, 65535), "int16": (-32768, 32767)}[kind]
    if dice.chance(0.4):  # part of what the type holds
        a, b = sorted((dice.between(least, most), dice.between(least, most)))
        least, most = int(a), int(b)
    # Six decimals are the same whatever the last bit of `values` is.
    return numpy.floor(least + numpy.round(values, 6) * (most - least) + 0.5).astype(TYPES[kind])


def add_nan(samples, dice):
    """Random ones, layers, ones next to a face; NaN and infinite."""
    size = samples.shape
    for _ in range(dice.whole(1, 3)):
        value = dice.pick(numpy.nan, numpy.nan, numpy.inf, -numpy.inf)
        kind = dice.weighted(random=3, layer=2, sample=2, block=1)
        if kind == "random":
            samples[dice.array(*size) < dice.log_between(0.005, 0.3)] = value
            continue
        place = [dice.pick(0, 1, n - 2, n - 1, dice.whole(0, n - 1)) % n for n in size]
        if kind == "layer":
            axis = dice.whole(0, 2)
            numpy.moveaxis(samples, axis, 0)[place[axis]] = value
        elif kind == "sample":
            samples[tuple(place)] = value
        else:
            samples[place[0]:place[0] + 2, place[1]:place[1] + 3, place[2]:] = value


def steps_and_origin(size, dice, scale):
    """Directions from sample to sample, and where the first one lies."""
    length = {"equal": [1, 1, 1], "unit": [1 / max(n, 1) for n in size], "each": dice.vector(0.2, 2),
              "stretched": [dice.log_between(0.01, 10) for _ in range(3)]}[
                  dice.weighted(equal=3, unit=2, each=2, stretched=1)]
    turn = numpy.eye(3)
    if dice.chance(0.4):
        turn = dice.rotation()
    elif dice.chance(0.2):  # axes exchanged
        turn = numpy.roll(turn, dice.whole(1, 2), axis=0)
    if dice.chance(0.25):
        turn = turn * [dice.pick(1, -1) for _ in range(3)]
    steps = turn * numpy.array(length) * scale
    reach = numpy.abs(steps @ numpy.array(size, float)).max()
    far = dice.weighted(none=4, near=3, far=1)
    if far == "none":
        return steps, numpy.zeros(3)
    return steps, reach * numpy.array(dice.vector(-1, 1)) * (1 if far == "near" else 1e3)


def make(dice, scale):
    size = sizes(dice)
    kind = dice.pick("ramp", "noise", "sparse", "labels", "blobs", "blocks", "sheets", "ramp", "noise", "sparse",
                     "constant")
    kind_of_sample = dice.pick("uint8", "uint8", "uint16", "int16", "float", "float")
    samples = with_type(field(kind, size, dice), kind_of_sample, dice)
    if kind_of_sample == "float" and dice.chance(0.4):
        add_nan(samples, dice)
    steps, origin = steps_and_origin(size, dice, scale)
    cells = [dice.chance(0.5) for _ in range(3)]
    return Volume(samples, kind_of_sample, cells, origin, steps, kind)


def nrrd(volume, dice):
    def vector(values):
        return "(" + ",".join(repr(float(x)) for x in values) + ")"

    encoding = dice.pick("raw", "raw", "gzip")
    header = ["NRRD0004", f"type: {volume.type}", "dimension: 3",
              "sizes: " + " ".join(map(str, volume.samples.shape)), f"encoding: {encoding}", "endian: little",
              "space dimension: 3", "space directions: " + " ".join(map(vector, volume.steps.T)),
              "space origin: " + vector(volume.origin),
              "centers: " + " ".join("cell" if cell else "node" for cell in volume.cells)]
    data = volume.samples.tobytes(order="F")
    return "\n".join(header).encode() + b"\n\n" + (gzip.compress(data, mtime=0) if encoding == "gzip" else data)
