# SPDX-License-Identifier: Apache-2.0
"""Regular grids of samples."""
from __future__ import annotations

import os
import pathlib
from typing import Any, Sequence

import numpy as np

from . import _conversion, _lamina
from ._errors import Error, PictureWarning, PrecisionWarning, warn
from ._watched import Watched, can_be_written

Path = str | os.PathLike[str]

LIKE_LABELS = ("array: its samples look like labels, and are taken for a field, which mixes labels where they meet: "
               "lookup=\"nearest\" takes them for labels, lookup=\"linear\" for a field without this warning")


def folder_name(folder: Path | None) -> str:
    """Returns the full name of a folder that data must be in, without links; empty if None."""
    if folder is None:
        return ""
    if not os.path.isdir(folder):
        raise Error(f"only_below: found {os.fspath(folder)}, expected a folder")
    return os.path.realpath(folder)


class Volume:
    """Samples on a regular grid.

    ``array`` has three axes, in the order ``axes``: ``"zyx"`` for ``array[z, y, x]``, ``"xyz"`` for ``array[x, y, z]``
    and so on, or two, without z, of one slice. The other arguments are always in the order x, y, z. ``spacing`` (> 0)
    and ``origin`` (the position of the first sample) are in world units. ``directions``: unit vectors along the
    array's x, y and z, perpendicular to each other. ``centers``: with ``"node"`` the box spans the samples, with
    ``"cell"`` it spans whole voxels, half a voxel more at each end. ``lookup``: with ``"linear"`` the field between
    samples is trilinear, with ``"nearest"`` it is constant in each sample's voxel, for labels: whole numbers of any
    type that 16 bits do not hold are then numbered as those of a file are (``labels``), with a ``PictureWarning``.
    Unlike files, arrays are never taken for labels by themselves: ``None`` is ``"linear"``, with a ``PictureWarning``
    if samples look like labels.

    Contiguous arrays (contiguous as ``array[z, y, x]``: for ``axes="xyz"`` that is Fortran order) of uint8, int16,
    uint16 and float32 in native byte order are not copied: do not change them while they are drawn. If an array was
    changed after a ``Session`` read it, the Session's next picture warns (``PictureWarning``) and reads the array
    again.

    All other arrays are copied once. Nothing is lost for other strides, the other byte order, bool, int8, float16 and
    larger integers that fit 16 bits. Other integers, float64 and longdouble become float32, with a
    ``PrecisionWarning`` if float32 cannot hold the values.

    NaN and infinity are kept. The scene's key ``nan`` says how they are drawn: ``"error"`` or ``"transparent"``.

    Raises ``TypeError`` for masked arrays and for arrays without real numbers, ``ValueError`` for other shapes, axes
    and values out of range.

    >>> values = np.zeros((4, 5, 6), np.uint8)
    >>> volume = lamina.Volume(values, spacing=(1, 1, 2))
    >>> volume
    <lamina.Volume 6 x 5 x 4 uint8, from (0, 0, 0) to (5, 4, 6)>
    >>> np.shares_memory(volume.array, values)
    True
    >>> lamina.Volume(np.zeros((2, 3, 4, 5)))
    Traceback (most recent call last):
    ValueError: array: found the shape (2, 3, 4, 5), expected three axes (z, y, x), or two (y, x) of one slice
    """

    def __init__(self, array: Any, spacing: float | Sequence[float] = (1, 1, 1),
                 origin: Sequence[float] = (0, 0, 0), axes: str = "zyx", *,
                 directions: Any = ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
                 centers: str | Sequence[str] = "node", lookup: str | None = None) -> None:
        ordered = _conversion.array_zyx(array, axes)
        step_vectors = [tuple(length * number for number in direction) for length, direction
                        in zip(_conversion.spacing_of(spacing), _conversion.directions_of(directions))]
        first_sample = _conversion.triple("origin", origin)
        centerings = _conversion.centers_of(centers, ordered.shape)
        native = ordered.dtype.newbyteorder("=")
        if lookup == "nearest" and native in _conversion.LABELS:
            samples = np.ascontiguousarray(ordered, dtype=native)
            self._core, warnings = _lamina.Volume.labels_over(samples, _conversion.LABELS[native], step_vectors,
                                                              first_sample, centerings)
            samples, self._conversion = self._core.array, ""
            for text in warnings:
                warn(text, PictureWarning)
        else:
            samples, self._conversion = _conversion.drawn_array(ordered)
            if self._conversion:
                warn(self._conversion, PrecisionWarning)
            self._core = _lamina.Volume.over(np.asarray(samples), step_vectors, first_sample, centerings,
                                             "linear" if lookup is None else lookup)
            if lookup is None and self._core.look_like_labels():
                warn(LIKE_LABELS, PictureWarning)
        is_shared = np.shares_memory(samples, ordered)
        self._changeable: np.ndarray | None = samples if is_shared and can_be_written(samples) else None
        self._file: pathlib.Path | None = None
        self._source: str | dict[str, Any] | None = None

    @classmethod
    def _of(cls, core: _lamina.Volume, file: pathlib.Path | None = None,
            source: str | dict[str, Any] | None = None) -> Volume:
        """`source` is the name of the volume in scenes."""
        volume = cls.__new__(cls)
        volume._core, volume._conversion, volume._file, volume._source = core, "", file, source
        volume._changeable = None
        return volume

    @property
    def array(self) -> np.ndarray:
        """The samples as they are drawn, ``array[z, y, x]``: read-only, no copy."""
        return self._core.array

    @property
    def shape(self) -> tuple[int, int, int]:
        """Samples along z, y and x."""
        z, y, x = self.array.shape
        return z, y, x

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the samples as they are drawn: uint8, int16, uint16 or float32."""
        kind: np.dtype[Any] = self.array.dtype
        return kind

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Distance of neighbouring samples along x, y and z, in world units."""
        x, y, z = (float(np.linalg.norm(step)) for step in self._core.steps)
        return x, y, z

    @property
    def directions(self) -> np.ndarray:
        """Unit vectors along x, y and z of the array, one a row."""
        directions: np.ndarray = np.array(self._core.steps) / np.array(self.spacing)[:, None]
        return directions

    @property
    def origin(self) -> tuple[float, float, float]:
        """World position (x, y, z) of the first sample."""
        x, y, z = self._core.origin
        return x, y, z

    @property
    def centers(self) -> tuple[str, str, str]:
        """``"node"`` or ``"cell"``, along x, y and z."""
        x, y, z = self._core.centers
        return x, y, z

    @property
    def lookup(self) -> str:
        """``"linear"`` or ``"nearest"``: the field between samples."""
        return self._core.lookup

    @property
    def unit(self) -> str:
        """The unit of lengths as the volume's file names it, such as ``"mm"``; empty if it names none."""
        return self._core.unit

    @property
    def labels(self) -> dict[int, tuple[int, str]]:
        """Labels that the file tells of (docs/scene.md): the number and name of a label, by the value of its samples.

        Values are the file's numbers, as long as 16 bits hold them all.
        """
        return {code: (int(number), name) for code, number, name in self._core.labels}

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Smallest and largest corner of the box that is drawn, in world units."""
        lowest, highest = (_conversion.triple("bounds", corner) for corner in self._core.bounds)
        return lowest, highest

    @property
    def conversion(self) -> str:
        """Text that says what the conversion to the drawn type lost; empty if it lost nothing."""
        return self._conversion

    @property
    def file(self) -> pathlib.Path | None:
        """The file that the volume was read from, or None."""
        return self._file

    def copy(self) -> Volume:
        """A volume with the same samples in memory of its own, which nobody else can change.

        >>> values = np.zeros((4, 5, 6), np.uint8)
        >>> volume = lamina.Volume(values).copy()
        >>> values[:] = 1
        >>> int(volume.array.max())
        0
        """
        core = _lamina.Volume.over(np.array(self.array), self._core.steps, self._core.origin, self._core.centers,
                                   self._core.lookup, self._core.unit).with_labels_of(self._core)
        volume = Volume._of(core, self._file, self._source)
        volume._conversion = self._conversion
        return volume

    def _watched(self) -> Watched | None:
        return None if self._changeable is None else Watched(self._changeable)

    def save(self, file: Path) -> None:
        """Writes a NRRD file (``.nrrd``), which the command line draws as this module draws the volume.

        Labels are written with their own numbers, and their names and colours with the keys of 3D Slicer's segmentations.
        """
        self._core.save(pathlib.Path(file))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return _conversion.converted(self.array, dtype, copy)

    def __repr__(self) -> str:
        z, y, x = self.shape
        lowest, highest = (", ".join(f"{number:g}" for number in corner) for corner in self.bounds)
        return f"<lamina.Volume {x} x {y} x {z} {self.dtype}, from ({lowest}) to ({highest})>"
