# SPDX-License-Identifier: Apache-2.0
"""Tetrahedral meshes."""
from __future__ import annotations

import os
import pathlib
from typing import Any, Callable, Mapping

import numpy as np

from . import _conversion, _lamina
from ._errors import PictureWarning, warn
from ._volume import Path, Volume


class Mesh:
    """Tetrahedra with scalars.

    ``points``: (N, 3) world coordinates. ``tets``: (M, 4) indices of corners, in either orientation. ``values``: N
    numbers at the points or M at the tets (averaged to points when they are drawn), or several such arrays by name; the
    scene's ``scalar`` says which is drawn, else the first. A mesh keeps copies, in double precision.

    Raises ``TypeError`` for arrays that hold no real numbers, ``ValueError`` for other shapes, places that are not
    finite and corners out of range.

    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> lamina.Mesh(points, [(0, 1, 2, 3)], [0, 1, 2, 3])
    <lamina.Mesh 4 points, 1 tets: scalar>
    >>> lamina.Mesh(points, [(0, 1, 2, 4)], [0, 1, 2, 3])
    Traceback (most recent call last):
    ValueError: tets: found the corner 4, expected 0 to 3 (there are 4 points)
    """

    def __init__(self, points: Any, tets: Any, values: Any) -> None:
        places = _conversion.plain_array(points, "points")
        if places.ndim != 2 or places.shape[1] != 3 or not len(places):
            raise ValueError(f"points: found the shape {places.shape}, expected (N, 3)")
        places = np.ascontiguousarray(places, dtype=np.float64)
        if not np.isfinite(places).all() or np.abs(places).max() > _conversion.LARGEST_COORDINATE:
            raise ValueError("points: found a coordinate that is not finite or beyond 1e100")
        corners = self._corners(tets, len(places))
        named = dict(values) if isinstance(values, Mapping) else {"scalar": values}
        arrays = {str(name): self._values(str(name), array, len(places), len(corners))
                  for name, array in named.items()}
        if not arrays:
            raise ValueError("values: found none, expected one or more")
        at_points = [(name, array) for name, array in arrays.items() if len(array) == len(places)]
        at_tets = [(name, array) for name, array in arrays.items() if len(array) != len(places)]
        self._core = _lamina.Mesh.of(places, corners, at_points, at_tets)
        self._report: dict[str, Any] = {}
        self._file: pathlib.Path | None = None

    @staticmethod
    def _corners(tets: Any, points: int) -> np.ndarray:
        corners = np.asarray(tets)
        if corners.dtype.kind not in "iu":
            raise TypeError(f"tets: found the type {corners.dtype}, expected whole numbers")
        if corners.ndim != 2 or corners.shape[1] != 4 or not len(corners):
            raise ValueError(f"tets: found the shape {corners.shape}, expected (M, 4)")
        for corner in (corners.min(), corners.max()):
            if not 0 <= corner < points:
                raise ValueError(f"tets: found the corner {corner}, expected 0 to {points - 1} (there are {points} "
                                 "points)")
        return np.ascontiguousarray(corners, dtype=np.int32)

    @staticmethod
    def _values(name: str, values: Any, points: int, tets: int) -> np.ndarray:
        array = _conversion.plain_array(values, name)
        if array.shape not in ((points,), (tets,)):
            raise ValueError(f"{name}: found the shape {array.shape}, expected ({points},), one a point, or ({tets},), "
                             "one a tet")
        return np.ascontiguousarray(array, dtype=np.float64)

    @classmethod
    def _of(cls, core: _lamina.Mesh, file: pathlib.Path | None = None, report: dict[str, Any] | None = None) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._core, mesh._file, mesh._report = core, file, report or {}
        return mesh

    @property
    def points(self) -> np.ndarray:
        """(N, 3) float64, world coordinates: read-only, no copy."""
        return self._core.points

    @property
    def tets(self) -> np.ndarray:
        """(M, 4) int32, indices of corners: read-only, no copy."""
        return self._core.tets

    @property
    def scalars(self) -> dict[str, np.ndarray]:
        """All arrays by name, at points or at tets: float64, read-only, no copy."""
        return {**self._core.point_scalars, **self._core.cell_scalars}

    @property
    def values(self) -> np.ndarray:
        """The first of the arrays, which is drawn if the scene names none."""
        return next(iter(self.scalars.values()))

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Smallest and largest corner of the mesh's box, in world units."""
        lowest, highest = (_conversion.triple("bounds", corner) for corner in
                           (self.points.min(axis=0), self.points.max(axis=0)))
        return lowest, highest

    @property
    def report(self) -> dict[str, Any]:
        """Report on a mesh that ``lamina.mesh`` made: ``error`` (largest difference to the volume's trilinear field, in its
        units), ``relative_error`` (as a share of its range), ``within_tolerance``, ``stopped_by_max_tets``, ``tets``,
        ``kuhn_tets``. It is empty for other meshes."""
        return self._report

    @property
    def file(self) -> pathlib.Path | None:
        """The file that it was read from, or None."""
        return self._file

    def save(self, file: Path) -> None:
        """Writes a VTK file (``.vtu``) in double precision, from which the command line draws the same."""
        self._core.save(pathlib.Path(file))

    def __repr__(self) -> str:
        return f"<lamina.Mesh {len(self.points)} points, {len(self.tets)} tets: {', '.join(self.scalars)}>"


def mesh(volume: Volume | Any, tolerance: float = 0.02, *, max_tets: int = 5000000, kuhn: bool = False,
         transfer_function: Any = None, progress: Callable[[str, float], object] | None = None) -> Mesh:
    """Makes tetrahedra from a volume (or an array, or a file), as few as keep to ``tolerance``.

    ``tolerance``: largest difference to the volume's trilinear field anywhere, as a share of its range of values.
    ``max_tets``: where the making stops, with a ``PictureWarning``. ``kuhn``: every sample and six tets a cell
    instead; needs no TetGen. ``transfer_function``: the mesh may be coarse where it shows nothing.
    ``progress(activity, share)`` is called some 20 times a second.

    >>> x = np.linspace(0, 1, 9)
    >>> volume = lamina.Volume(np.float32(x[:, None, None] * x[:, None] * x), spacing=1 / 8)
    >>> made = lamina.mesh(volume, kuhn=True)
    >>> len(made.tets), made.report["error"] < 1 / 64
    (3072, True)
    """
    from ._reading import read  # makes meshes
    from ._scene import scene_of  # a scene reads transfer functions
    data = read(volume) if isinstance(volume, (str, os.PathLike)) else volume
    if isinstance(data, Mesh):
        raise TypeError("volume: found a mesh, expected a volume, an array or the file of a volume")
    data = data if isinstance(data, Volume) else Volume(data)
    if not 0 < tolerance <= 1:
        raise ValueError(f"tolerance: found {tolerance!r}, expected a number above 0 and up to 1 (of the range of values)")
    scene = None if transfer_function is None else scene_of(data, transfer_function, {})._parsed()
    core, report = _lamina.make_mesh(data._core, tolerance, max_tets, kuhn, scene, progress)
    if not (kuhn or report["within_tolerance"]):
        where = f"at {report['tets']} tets (max_tets)" if report["stopped_by_max_tets"] else \
            "where points would lie too close"
        warn(f"the mesh stopped {where}: it differs from the volume by up to {report['relative_error']:.3g} of the range "
             f"of values, wanted {tolerance:.3g}", PictureWarning)
    return Mesh._of(core, report=report)
