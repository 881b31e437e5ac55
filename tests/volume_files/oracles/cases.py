# SPDX-License-Identifier: Apache-2.0
"""Parts that oracles share: values, axes, and the list of what each file holds."""
import json
import math
import os

import numpy as np

SHAPE = (4, 5, 6)  # z, y, x
TYPES = ["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64"]


def drawn_type(array):
    """The smallest type that draws integers; the others stay or become float."""
    if array.dtype in (np.uint8, np.int16, np.uint16):
        return str(array.dtype)
    if array.dtype == np.int8:
        return "int16"
    if array.dtype.kind not in "iu":
        return "float"
    lo, hi = int(array.min()), int(array.max())
    for name in ("uint8", "int16", "uint16"):
        if lo >= np.iinfo(name).min and hi <= np.iinfo(name).max:
            return name
    return "float"


def values_of(dtype, shape, seed=1):
    """Numbers over much of the type's range, with NaN among floats; [z, y, x]."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(dtype)
    if dtype.kind in "iu":
        info = np.iinfo(dtype)
        array = rng.integers(info.min, info.max, size=shape, dtype=dtype, endpoint=True)
        array.flat[0], array.flat[1] = info.min, info.max
        return array
    array = rng.normal(size=shape).astype(dtype) * dtype.type(1e3)
    array.flat[2] = np.nan
    array.flat[3] = -np.inf
    return array


class Cases:
    def __init__(self, folder):
        self.folder = folder
        self.cases = []

    def path(self, name):
        return os.path.join(self.folder, name)

    def add(self, name, stored, steps=((1, 0, 0), (0, 1, 0), (0, 0, 1)), origin=(0, 0, 0), cell=False, drawn=None,
            warnings=None, lps=None, unit=None, **request):
        """`stored`: [z, y, x], as stored; `drawn`: the type where it does not follow from that."""
        kind = drawn or drawn_type(stored)
        values = stored.astype(np.float32) if kind == "float" else stored
        number = len(self.cases)
        np.ascontiguousarray(values, dtype="<f8").tofile(self.path(f"values{number}.raw"))
        self.cases.append({
            "file": name, "request": request, "type": kind, "size": list(stored.shape[::-1]),
            "steps": np.asarray(steps, float).tolist(), "origin": np.asarray(origin, float).tolist(), "cell": cell,
            "values": f"values{number}.raw", "warnings": warnings, "lps": lps, "unit": unit})

    def refuse(self, name, *words, **request):
        """The file is an error whose message has these words."""
        self.cases.append({"file": name, "request": request, "error": words})

    def write(self):
        with open(self.path("cases.json"), "w", encoding="utf-8") as file:
            json.dump(self.cases, file)


def rotation(a, b, c):
    """Rotation matrix for three angles about z, y, x."""
    def turn(i, j, angle):
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = math.cos(angle)
        matrix[i, j], matrix[j, i] = -math.sin(angle), math.sin(angle)
        return matrix
    return turn(0, 1, a) @ turn(0, 2, b) @ turn(1, 2, c)


def ramp(dtype="<i2", shape=SHAPE):
    """Samples that all differ, and differ from those of any other order of axes."""
    return (np.arange(np.prod(shape)).reshape(shape) * 7 % 997).astype(dtype)


def diagonal(x, y, z):
    return np.diag([x, y, z]).astype(float)
