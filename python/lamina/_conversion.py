# SPDX-License-Identifier: Apache-2.0
"""Arrays of all kinds as the few that are drawn as they are."""
from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np

DRAWN = (np.dtype(np.uint8), np.dtype(np.int16), np.dtype(np.uint16), np.dtype(np.float32))
# Smallest and largest value of the types of whole numbers.
WHOLE = ((0, 255, "uint8"), (-32768, 32767, "int16"), (0, 65535, "uint16"))
# Types of labels that may need other numbers, by their names in C++.
LABELS = {np.dtype(kind): "float" if kind == "float32" else "double" if kind == "float64" else kind
          for kind in ("int32", "uint32", "int64", "uint64", "float32", "float64")}
LARGEST_COORDINATE = 1e100


def shown(value: Any) -> str:
    """Returns a value as messages show it."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def number(name: str, value: Any) -> float:
    if isinstance(value, (str, bool)) or not hasattr(value, "__float__"):
        raise TypeError(f"{name}: found {shown(value)}, expected a number")
    return float(value)


def triple(name: str, value: Any) -> tuple[float, float, float]:
    """Checks three numbers for x, y and z: finite, and no farther than scenes may be."""
    try:
        numbers = tuple(float(number) for number in value)
    except TypeError:
        raise TypeError(f"{name}: found {shown(value)}, expected three numbers (x, y, z)") from None
    if len(numbers) != 3 or not all(math.isfinite(number) for number in numbers):
        raise ValueError(f"{name}: found {shown(value)}, expected three finite numbers (x, y, z)")
    if max(abs(number) for number in numbers) > LARGEST_COORDINATE:
        raise ValueError(f"{name}: found {shown(value)}, expected coordinates up to 1e100")
    return numbers[0], numbers[1], numbers[2]


def spacing_of(value: Any) -> tuple[float, float, float]:
    numbers = triple("spacing", (value,) * 3 if np.ndim(value) == 0 else value)
    if min(numbers) < 1e-100:
        raise ValueError(f"spacing: found {shown(value)}, expected three numbers from 1e-100 to 1e100")
    return numbers


def directions_of(value: Any) -> tuple[tuple[float, float, float], ...]:
    """Unit vectors along x, y and z of the array, perpendicular to each other."""
    if np.shape(value) != (3, 3):
        raise ValueError(f"directions: found {shown(value)}, expected three vectors, one for each of x, y and z")
    matrix = np.array([triple("directions", vector) for vector in value])
    # The tolerance of the readers of files: it moves samples by less than a hundredth of a voxel over 1000 voxels.
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > 1e-5:
        raise ValueError(f"directions: found {shown(value)}, expected perpendicular vectors of length 1")
    x, y, z = (triple("directions", vector) for vector in matrix)
    return x, y, z


def centers_of(value: str | Sequence[str], shape: tuple[int, ...]) -> tuple[str, str, str]:
    """Returns the centers along x, y and z; an axis with one sample is a cell."""
    words = (value,) * 3 if isinstance(value, str) else tuple(value)
    if len(words) != 3 or any(word not in ("node", "cell") for word in words):
        raise ValueError(f"centers: found {shown(value)}, expected \"node\" or \"cell\", or one of them for each of "
                         "x, y and z")
    x, y, z = ("cell" if size == 1 else word for word, size in zip(words, reversed(shape)))
    return x, y, z


def plain_array(values: Any, what: str) -> np.ndarray:
    """Returns numbers as an array, whatever they come in."""
    if isinstance(values, np.ma.MaskedArray) and bool(np.any(values.mask)):
        raise TypeError(f"{what}: found a masked array, expected an array without a mask; "
                        "values.filled(numpy.nan) with nan=\"transparent\" shows nothing where values are masked")
    array = np.asarray(values)
    if isinstance(values, str):
        raise TypeError(f"{what}: found {shown(values)}, expected numbers; lamina.read reads files")
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{what}: found the type {array.dtype}, expected whole or floating-point numbers")
    return array


def converted(array: np.ndarray, dtype: Any, copy: bool | None) -> np.ndarray:
    """Returns what ``__array__`` has to, with any version of numpy.

    ``copy``: always if True, never if False (``ValueError`` if ``dtype`` needs one), and if None only for another
    ``dtype``. numpy 1 takes False as None, numpy 2 does not.
    """
    if copy:
        return np.array(array, dtype=dtype)
    result = np.asarray(array, dtype=dtype)
    if copy is False and not np.may_share_memory(result, array):
        raise ValueError(f"copy: found False, expected None or True to turn {array.dtype} into {result.dtype}")
    return result


def array_zyx(values: Any, axes: str) -> np.ndarray:
    """Returns a view with the axes z, y, x."""
    array = plain_array(values, "array")
    if not isinstance(axes, str):
        raise TypeError(f"axes: found {shown(axes)}, expected a text like \"zyx\"")
    if sorted(axes) != ["x", "y", "z"]:
        raise ValueError(f"axes: found {shown(axes)}, expected the letters x, y and z, each once, in the order of the "
                         "array's axes")
    if array.ndim == 2:
        array = np.expand_dims(array, axes.index("z"))  # one slice
    if array.ndim != 3:
        raise ValueError(f"array: found the shape {array.shape}, expected three axes ({', '.join(axes)}), or two "
                         "(y, x) of one slice")
    if array.size == 0:
        raise ValueError(f"array: found the shape {array.shape}, expected one sample or more along each axis")
    return array.transpose([axes.index(letter) for letter in "zyx"])


def drawn_array(array: np.ndarray) -> tuple[np.ndarray, str]:
    """Returns the array itself if it is contiguous and of a type that is drawn, else a copy; and what was lost, or ""."""
    native = array.dtype.newbyteorder("=")
    if native in DRAWN:
        return np.require(array, dtype=native, requirements=["C_CONTIGUOUS", "ALIGNED"]), ""
    if native.kind == "b":
        return np.ascontiguousarray(array, dtype=np.uint8), ""
    if native == np.int8:
        return np.ascontiguousarray(array, dtype=np.int16), ""
    if native == np.float16:
        return np.ascontiguousarray(array, dtype=np.float32), ""
    if native.kind in "iu":
        lowest, highest = int(array.min()), int(array.max())
        for smallest, largest, kind in WHOLE:
            if smallest <= lowest and highest <= largest:
                return np.ascontiguousarray(array, dtype=kind), ""
    return rounded(array)


def rounded(array: np.ndarray) -> tuple[np.ndarray, str]:
    """Returns the array in float32, and by how much that differs."""
    with np.errstate(over="ignore"):
        result = np.ascontiguousarray(array, dtype=np.float32)
    overflows = int(np.count_nonzero(np.isinf(result) & np.isfinite(array)))
    if overflows:
        raise ValueError(f"array: {overflows} values of {array.dtype} are beyond float32, expected up to 3.4e38")
    back = result.astype(array.dtype if array.dtype.kind == "f" else np.longdouble)
    with np.errstate(invalid="ignore"):
        differences = np.abs(back - array)
    differing = int(np.count_nonzero(differences > 0))
    if not differing:
        return result, ""
    return result, (f"{array.dtype} values are drawn as float32, which cannot hold them: {differing} of {array.size} "
                    f"differ, by up to {float(np.nanmax(differences)):.3g}")
