# SPDX-License-Identifier: Apache-2.0
"""Transfer functions, from scalar values to colour and extinction."""
from __future__ import annotations

from typing import Any, Iterable, Mapping, Sequence

from ._conversion import shown
from ._plain import plain
from ._volume import Path

Color = str | Sequence[float] | Mapping[str, Any]


class TransferFunction:
    """Maps a scalar value to colour and extinction, linearly between points and constant outside.

    ``points``: ``(value, color, extinction)`` in order of value; two points at one value make a step. A colour is a
    triple (linear light, or display values if the scene's ``color_space`` is ``"display"``), a text like
    ``"#1a800d"`` or ``"tomato"`` (display values), or ``{"srgb": [r, g, b]}``. Extinction is per world unit, >= 0: a
    homogeneous box of length s has the opacity ``1 - exp(-extinction * s)``.

    ``interpolation="nearest"`` takes the nearest point's values. ``to_scene()`` is what a scene file has for it.

    Raises ``TypeError`` and ``ValueError`` for points of another form; what a scene file could not have (values out of
    order, negative extinction, unknown colours) is found when it is drawn: ``lamina.Error``.

    >>> lamina.TransferFunction([(28, "#1a800d", 0), (255, (1, 0.85, 0.6), 0.6)])
    <lamina.TransferFunction 2 points from 28 to 255>
    """

    def __init__(self, points: Iterable[tuple[float, Color, float]], *, interpolation: str = "linear") -> None:
        listed = _points(points, ("value", "color", "extinction"))
        self._keys: dict[str, Any] = {"interpolation": interpolation, "points": listed}

    @classmethod
    def _of(cls, keys: Mapping[str, Any]) -> TransferFunction:
        function = cls.__new__(cls)
        function._keys = plain(keys, "transfer_function")
        return function

    @classmethod
    def from_opacity(cls, points: Iterable[tuple[float, Color, float]], *, unit_length: float = 1,
                     interpolation: str = "linear") -> TransferFunction:
        """Makes one from points ``(value, color, opacity)``. Opacity (0..1) is that of ``unit_length`` world units of a
        homogeneous medium, and is linear between points, as in VTK and ParaView. (With
        ``interpolation="extinction"`` extinction is linear.)

        >>> lamina.TransferFunction.from_opacity([(0, "black", 0), (1, "white", 0.9)], unit_length=0.5).to_scene()
        {'unit_length': 0.5, 'interpolation': 'linear', 'points': [{'value': 0, 'color': 'black', 'opacity': 0}, \
{'value': 1, 'color': 'white', 'opacity': 0.9}]}
        """
        return cls._of({"unit_length": unit_length, "interpolation": interpolation,
                        "points": _points(points, ("value", "color", "opacity"))})

    @classmethod
    def colormap(cls, name: Path, *, range: Sequence[float] | None = None,
                 extinction: Iterable[tuple[float, float]] | None = None,
                 opacity: Iterable[tuple[float, float]] | None = None, unit_length: float = 1) -> TransferFunction:
        """The colours of a map (``lamina.colormaps``, or the file of a ParaView preset), stretched over ``range``
        (lo, hi), else over the range of the data. ``extinction`` or ``opacity``: points ``(value, number)``; without
        either the map's own opacities count, if it has them.

        >>> lamina.TransferFunction.colormap("viridis", range=(0, 1), extinction=[(0, 0), (1, 8)])
        <lamina.TransferFunction colormap 'viridis', 2 points from 0 to 1>
        """
        if extinction is not None and opacity is not None:
            raise TypeError("colormap: found extinction and opacity, expected one of the two")
        keys: dict[str, Any] = {"unit_length": unit_length, "colormap": name}
        if range is not None:
            keys["colormap_range"] = list(range)
        if extinction is not None:
            keys["points"] = _points(extinction, ("value", "extinction"))
        if opacity is not None:
            keys["points"] = _points(opacity, ("value", "opacity"))
        return cls._of(keys)

    @classmethod
    def from_paraview(cls, file: Path, *, range: Sequence[float] | None = None,
                      extinction: Iterable[tuple[float, float]] | None = None,
                      opacity: Iterable[tuple[float, float]] | None = None,
                      unit_length: float = 1) -> TransferFunction:
        """The colours, and the opacities if it has any, of a ParaView preset (a JSON file). Without ``range`` a preset
        keeps its own values; the rest is as in ``colormap``."""
        return cls.colormap(file, range=range, extinction=extinction, opacity=opacity, unit_length=unit_length)

    @property
    def points(self) -> list[dict[str, Any]]:
        """The points as in a scene file: ``value``, ``color``, ``extinction`` or ``opacity``."""
        return list(self._keys.get("points", []))

    def to_scene(self) -> dict[str, Any]:
        """The key ``transfer_function`` of a scene file."""
        return dict(self._keys)

    def __repr__(self) -> str:
        values = [point["value"] for point in self.points]
        text = f"{len(values)} points" + (f" from {values[0]:g} to {values[-1]:g}" if values else "")
        if "colormap" in self._keys:
            text = f"colormap {self._keys['colormap']!r}" + (f", {text}" if values else "")
        return f"<lamina.TransferFunction {text}>"


def _points(points: Iterable[Any], names: tuple[str, ...]) -> list[dict[str, Any]]:
    listed = []
    for index, point in enumerate(points):
        if isinstance(point, (str, Mapping)) or not hasattr(point, "__len__") or len(point) != len(names):
            raise TypeError(f"points.{index}: found {shown(point)}, expected ({', '.join(names)})")
        keys = plain(dict(zip(names, point)), f"points.{index}")
        for name in names:
            if name != "color" and (isinstance(keys[name], bool) or not isinstance(keys[name], (int, float))):
                raise TypeError(f"points.{index}.{name}: found {shown(keys[name])}, expected a number")
        listed.append(keys)
    if not listed:
        raise ValueError("points: found none, expected one or more")
    return listed
