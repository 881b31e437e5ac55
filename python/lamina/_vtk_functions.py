# SPDX-License-Identifier: Apache-2.0
"""Transfer functions of VTK's volume properties."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import Error
from ._mesh import Mesh
from ._volume import Volume

PIECES = 256  # straight ones, for each piece of a function that is curved
RGB, LINEAR = 0, 0  # VTK_CTF_RGB, VTK_CTF_LINEAR


def transfer_function_keys(properties: Any, data: Volume | Mesh, scale: float = 1) -> dict[str, Any]:
    """Returns a vtkVolumeProperty as a scene file has it. `scale` is that of the volume: unit distances are in its unit."""
    _refuse_what_is_more(properties, data)
    unit = properties.GetScalarOpacityUnitDistance()
    if not unit > 0:
        raise Error(f"property: found the unit distance {unit}, expected a number above 0")
    unit *= scale
    opacity = _pieces_of_opacity(properties.GetScalarOpacity())
    color = _pieces_of_color(properties)
    points = []
    for value in sorted({*opacity[0], *color[0]}):
        sides = [tuple(_limit(pieces, value, side) for pieces in (color, opacity)) for side in ("below", "above")]
        for rgb, (alpha,) in sides if not np.array_equal(np.hstack(sides[0]), np.hstack(sides[1])) else sides[:1]:
            alpha = float(np.clip(alpha, 0, 1))
            density = {"extinction": alpha / unit} if isinstance(data, Mesh) else {"opacity": alpha}
            points.append({"value": float(value), "color": [max(0.0, float(part)) for part in rgb], **density})
    return {"unit_length": unit, "points": points}


def _refuse_what_is_more(properties: Any, data: Volume | Mesh) -> None:
    if properties.GetShade():
        raise Error("property: found shading, expected none: VTK lights one side, with lights of its own "
                    "(property.ShadeOff())")
    if isinstance(data, Mesh):
        return
    if not properties.GetDisableGradientOpacity(0):
        function = properties.GetStoredGradientOpacity(0)
        nodes = [_node(function, index, 1) for index in range(function.GetSize())] if function is not None else []
        if any(node[1][0] != 1 for node in nodes):
            raise Error("property: found gradient opacity, expected none (property.DisableGradientOpacityOn())")
    if properties.GetInterpolationType() == 0:
        raise Error("property: found nearest neighbours, expected linear interpolation "
                    "(property.SetInterpolationTypeToLinear())")


# Pieces: values in order, with a row of numbers each; two rows at one value make a step.
Pieces = tuple[np.ndarray, np.ndarray]


def _node(function: Any, index: int, parts: int) -> tuple[float, list[float], float, float]:
    """Value, numbers, midpoint and sharpness of a node."""
    numbers = [0.0] * (parts + 3)
    function.GetNodeValue(index, numbers)
    return numbers[0], numbers[1:1 + parts], numbers[1 + parts], numbers[2 + parts]


def _sampled(function: Any, parts: int, curved: bool) -> Pieces:
    """Returns the function at its nodes, and between them if it is not straight there."""
    nodes = [_node(function, index, parts) for index in range(function.GetSize())]
    if not nodes:
        raise Error(f"property: found a {function.GetClassName()} without points, expected one or more")
    values: list[float] = []
    rows: list[list[float]] = []
    for (value, numbers, midpoint, sharpness), after in zip(nodes, [*nodes[1:], None]):
        values.append(value)
        rows.append(numbers)
        if after is None or after[0] == value or not (curved or midpoint != 0.5 or sharpness != 0):
            continue
        for x in np.linspace(value, after[0], PIECES + 1)[1:-1]:
            found = function.GetColor(x) if parts == 3 else [function.GetValue(x)]
            values.append(float(x))
            rows.append(list(found))
    return np.array(values), np.array(rows)


def _ended(pieces: Pieces, clamped: bool) -> Pieces:
    """Adds the ends: beyond them a function that is not clamped is 0."""
    if clamped:
        return pieces
    values, rows = pieces
    nothing = np.zeros((1, rows.shape[1]))
    return np.hstack([values[:1], values, values[-1:]]), np.vstack([nothing, rows, nothing])


def _pieces_of_opacity(function: Any) -> Pieces:
    return _ended(_sampled(function, 1, False), bool(function.GetClamping()))


def _pieces_of_color(properties: Any) -> Pieces:
    if properties.GetColorChannels() == 1:
        grey = properties.GetGrayTransferFunction()
        values, rows = _ended(_sampled(grey, 1, False), bool(grey.GetClamping()))
        return values, np.repeat(rows, 3, axis=1)
    function = properties.GetRGBTransferFunction()
    curved = function.GetColorSpace() != RGB or function.GetScale() != LINEAR
    return _ended(_sampled(function, 3, curved), bool(function.GetClamping()))


def _limit(pieces: Pieces, value: float, side: str) -> np.ndarray:
    """Returns the value from below or above."""
    values, rows = pieces
    index = int(np.searchsorted(values, value, "left" if side == "below" else "right"))
    near = index if side == "below" else index - 1
    if 0 <= near < len(values) and values[near] == value:
        row: np.ndarray = rows[near]
    elif index in (0, len(values)):
        row = rows[0 if index == 0 else -1]
    else:
        share = (value - values[index - 1]) / (values[index] - values[index - 1])
        row = rows[index - 1] + share * (rows[index] - rows[index - 1])
    return row
