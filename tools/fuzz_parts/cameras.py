# SPDX-License-Identifier: Apache-2.0
"""Random cameras about a box, and the rays of their pixels (written from docs/scene.md alone)."""
import math

import numpy

from .dice import rounded


def eye_place(dice):
    """In coordinates of the box: 0..1 is inside."""
    kind = dice.weighted(outside=6, near=1.5, inside=2, face=1, edge=0.6, corner=0.6, far=0.5)
    if kind in ("outside", "far"):
        way = numpy.array(dice.direction())
        reach = dice.between(1.1, 4) if kind == "outside" else dice.log_between(10, 1e5)
        return kind, 0.5 + reach * way / math.sqrt(float(way @ way))
    place = numpy.array(dice.vector(0.02, 0.98))
    on = {"inside": 0, "near": 1, "face": 1, "edge": 2, "corner": 3}[kind]
    first = dice.whole(0, 2)
    for i in range(on):
        end = dice.pick(0.0, 1.0)
        away = dice.log_between(1e-6, 0.2) if kind == "near" else 0
        place[(first + i) % 3] = end + (away if end else -away)
    return kind, place


def up_for(forward, dice):
    for candidate in ([0, 1, 0], dice.vector(-1, 1), [0, 0, 1], [1, 0, 0]):
        if numpy.linalg.norm(numpy.cross(forward, candidate)) > 1e-2 * numpy.linalg.norm(candidate):
            return [float(x) for x in candidate]
    raise AssertionError("no vector is along all axes")


def make(dice, corner, edges):
    """corner: of the box, in the world; edges: columns, from there to its neighbours."""
    lengths = numpy.linalg.norm(edges, axis=0)
    size = float(lengths.max())
    kind, place = eye_place(dice)
    if kind in ("outside", "far"):  # as far as the box is large, however thin
        eye = corner + edges @ numpy.full(3, 0.5) + (place - 0.5) * size
    else:
        eye = corner + edges @ place
    along = dice.chance(0.25)
    if along:  # exactly along an axis of the box, or as exactly as it is turned
        axis = dice.whole(0, 2)
        step = edges[:, axis] / lengths[axis] * size
        if kind in ("outside", "far"):
            middle = corner + edges @ numpy.array([dice.pick(0.5, 0.5, dice.between(0.05, 0.95)) for _ in range(3)])
            eye = middle - step * dice.between(1.1, 4)
        center = eye + step
    elif dice.chance(0.5) and kind not in ("edge", "corner", "face"):
        center = corner + edges @ numpy.full(3, 0.5)
    else:
        center = corner + edges @ numpy.array(dice.vector(0.1, 0.9))
    eye = numpy.array([rounded(x, 12) for x in eye])
    center = numpy.array([rounded(x, 12) for x in center])
    distance = float(numpy.linalg.norm(center - eye))
    if not distance > 1e-9 * size:
        center = eye + edges[:, 0]
        distance = float(lengths[0])
    camera = {"eye": eye.tolist(), "center": center.tolist(),
              "up": up_for((center - eye) / distance, dice)}
    if dice.chance(0.35):
        camera["projection"] = "orthographic"
        camera["height"] = rounded(size * dice.log_between(0.1, 2.5))
    else:
        fits = math.degrees(2 * math.atan(0.5 * size / max(distance, 1e-9 * size)))
        camera["fov_y"] = dice.pick(rounded(min(max(fits * dice.between(0.3, 1.8), 1e-4), 150)), dice.between(20, 90),
                                    dice.between(100, 170) if kind != "far" else rounded(max(fits, 1e-4)))
    return camera, kind + (" along" if along else "")


class Rays:
    """Returns the rays of an image's pixels: origin + z * direction, z >= 0 the depth before the eye's plane."""

    def __init__(self, camera, width, height):
        self.eye = numpy.array(camera["eye"], float)
        forward = numpy.array(camera["center"], float) - self.eye
        forward = forward / numpy.abs(forward).max()
        self.forward = forward / numpy.linalg.norm(forward)
        right = numpy.cross(self.forward, camera["up"])
        self.right = right / numpy.linalg.norm(right)
        self.up = numpy.cross(self.right, self.forward)
        self.parallel = camera.get("projection") == "orthographic"
        self.width, self.height = width, height
        self.pixel = (camera["height"] if self.parallel else 2 * math.tan(math.radians(camera["fov_y"]) / 2)) / height

    def of(self, columns, rows):
        x = (numpy.asarray(columns, float) + 0.5 - 0.5 * self.width) * self.pixel
        y = (0.5 * self.height - (numpy.asarray(rows, float) + 0.5)) * self.pixel
        offset = x[:, None] * self.right + y[:, None] * self.up
        if self.parallel:
            return self.eye + offset, numpy.broadcast_to(self.forward, offset.shape)
        return numpy.broadcast_to(self.eye, offset.shape), self.forward + offset
