# SPDX-License-Identifier: Apache-2.0
"""Random clips, and what they keep of a ray (written from docs/scene.md alone)."""
import numpy

from .dice import rounded


def numbers(values):
    return [rounded(float(value), 12) for value in values]


def plane(dice, corner, edges, eye):
    place = dice.weighted(inside=6, corner=1, middle=1, beside=0.7, eye=0.4)
    share = {"inside": lambda: dice.vector(0, 1), "corner": lambda: [dice.pick(0, 1) for _ in range(3)],
             "middle": lambda: [0.5, 0.5, 0.5], "beside": lambda: dice.vector(-0.6, 1.6), "eye": lambda: None}[place]()
    point = eye if share is None else corner + edges @ numpy.array(share, float)
    # Oblique planes should cross more than one corner of thin data, too.
    sizes = numpy.linalg.norm(edges, axis=0)
    normal = numpy.array(dice.direction())
    if dice.chance(0.3):
        axis = dice.whole(0, 2)
        normal = edges[:, axis] / sizes[axis] * dice.pick(1, -1)
    elif dice.chance(0.5):
        normal = (edges / sizes ** 2) @ normal * sizes.min()
    return {"point": numbers(point), "normal": numbers(normal * dice.pick(1, 1, 1e-9, 12.5))}


def box(dice, corner, edges):
    ends = numpy.array([corner + edges @ numpy.array(dice.vector(-0.1, 1.1)) for _ in range(2)])
    return {"min": numbers(ends.min(0)), "max": numbers(ends.max(0))}


def make(dice, corner, edges, eye):
    clip = {}
    kind = dice.weighted(planes=4, box=1.5, both=1)
    if kind != "box":
        clip["planes"] = [plane(dice, corner, edges, numpy.array(eye)) for _ in range(dice.pick(1, 1, 2, 3))]
    if kind != "planes":
        clip["box"] = box(dice, corner, edges)
    return clip


def half_spaces(clip):
    """(point, normal), each of them."""
    for entry in clip.get("planes", []):
        yield numpy.array(entry["point"], float), numpy.array(entry["normal"], float)
    if "box" in clip:
        for axis in range(3):
            for end, side in (("min", 1.0), ("max", -1.0)):
                yield numpy.array(clip["box"][end], float), side * numpy.eye(3)[axis]


def spans(clip, origins, directions):
    """Returns the z at which each ray begins and ends to be kept, and whether it runs along a plane within roundings of it."""
    near, far = numpy.zeros(len(origins)), numpy.full(len(origins), numpy.inf)
    tied = numpy.zeros(len(origins), bool)
    for point, normal in half_spaces(clip or {}):
        normal = normal / numpy.linalg.norm(normal)
        distance, slope = (origins - point) @ normal, directions @ normal
        with numpy.errstate(divide="ignore", invalid="ignore"):
            crossing = -distance / slope
        near = numpy.where(slope > 0, numpy.maximum(near, crossing), near)
        far = numpy.where(slope < 0, numpy.minimum(far, crossing), far)
        far = numpy.where((slope == 0) & (distance < 0), near, far)
        reach = numpy.abs(origins - point).max(1)
        tied |= (numpy.abs(distance) < 1e-12 * reach) & (numpy.abs(slope) < 1e-12 * numpy.linalg.norm(directions, axis=1))
    return near, numpy.maximum(near, far), tied
