# SPDX-License-Identifier: Apache-2.0
"""Meshes with values far from all others: those that mark missing data, flat parts beside huge values, and transfer
functions whose points fill a millionth of the values' range. `make` of scene_maker.py draws them with dice of their own,
so that seeds without --markers stay the scenes that they were."""
import numpy

MARKERS = (-9999.0, -32768.0, -1e20, 9.97e36, 1e6, -2e5, 1e11, 3e38, -3e38)


def marker(dice, low, high):
    if dice.chance(0.6):
        return dice.pick(*MARKERS)
    width = max(high - low, 1e-3 * abs(high), 1e-3)
    value = width * dice.log_between(3, 1e12)
    return high + value if dice.chance(0.5) else low - value


def mark(mesh, dice):
    """Changes some values of a mesh; returns the range of the others."""
    rest = mesh.values[numpy.isfinite(mesh.values)]
    low, high = (rest.min(), rest.max()) if rest.size else (0.0, 1.0)
    kind = dice.weighted(one=4, tenth=2, thousandth=2, two=1, flat=2)
    shares = {"one": 0, "tenth": 0.1, "thousandth": 0.001, "two": 0.05, "flat": 0.1}
    chosen = dice.array(len(mesh.values)) < shares[kind]
    chosen[dice.whole(0, len(mesh.values) - 1)] = True
    values = mesh.values.copy()
    if kind == "flat":  # parts of one value beside huge ones
        values = numpy.where(numpy.isfinite(values), numpy.floor(3 * (values - low) / max(high - low, 1e-9)), values)
        low, high = 0.0, 3.0
        found = 1e11
    else:
        found = marker(dice, low, high)
    values[chosen] = found
    if kind == "two":
        other = marker(dice, low, high)
        values[chosen & (dice.array(len(values)) < 0.5)] = other
    mesh.values = values
    mesh.kind += f", {kind} of {found:.4g}"
    return float(low), float(high)


def window(mesh, dice):
    """A millionth of the range of a mesh without markers."""
    finite = mesh.values[numpy.isfinite(mesh.values)]
    low, high = (finite.min(), finite.max()) if finite.size else (0.0, 1.0)
    width = (high - low) * dice.pick(1e-6, 1e-5, 1e-4)
    middle = float(dice.pick(*finite[:8].tolist())) if finite.size and dice.chance(0.5) else dice.between(low, high)
    mesh.kind += ", window"
    return middle - width / 2, middle + width / 2
