# SPDX-License-Identifier: Apache-2.0
"""Differences of pictures."""
from __future__ import annotations

import os
import pathlib
from typing import Any, NamedTuple

import numpy as np

from . import _lamina
from ._conversion import plain_array
from ._errors import Error
from ._files import write_file
from ._volume import Path


class Norms(NamedTuple):
    """Norms of e = A - B in 1/255: ``linf`` = max |e|, ``mean`` = mean of e with its sign, ``l2`` = root of the mean of e^2.

    ``l1`` is the same as ``mean``: files and the command line call it so, as LaMar's paper does.

    >>> norms = lamina.compare(np.full((2, 2, 4), -1 / 255), np.zeros((2, 2, 4))).channels["R"]
    >>> norms.mean == norms.l1
    True
    """

    linf: float
    l1: float
    l2: float

    @property
    def mean(self) -> float:
        """Mean of e with its sign; the same as ``l1``."""
        return self.l1


class Comparison:
    """Difference of a picture A from a picture B: e = A - B in units of 1/255.

    ``linf``, ``mean``, ``l2``: the ``Norms`` over all pixels and channels; ``l1`` is the same as ``mean``. ``channels``: the
    ``Norms`` of each channel, by its name. ``worst``: column, row and channel of the largest |e|. ``array``: e itself,
    (height, width, channels) float64; None for PNG files.
    """

    def __init__(self, found: tuple[Any, ...], a: np.ndarray | None = None, b: np.ndarray | None = None) -> None:
        everything, channels, worst = found
        self.linf, self.l1, self.l2 = Norms(*everything)
        self.channels = {name: Norms(*norms) for name, norms in channels.items()}
        column, row, channel = worst
        self.worst: tuple[int, int, str] = (column, row, channel)
        self._a, self._b = a, b

    @property
    def mean(self) -> float:
        """Mean of e with its sign; the same as ``l1``."""
        return self.l1

    @property
    def array(self) -> np.ndarray | None:
        """The signed difference e."""
        if self._a is None or self._b is None:
            return None
        difference: np.ndarray = (self._a.astype(np.float64) - self._b) * 255
        return difference

    def save(self, file: Path, range: float | None = None) -> None:
        """Writes e in false colour as ``.png``, from -``range`` (dark blue) over 0 (white) to ``range`` (dark red), in
        1/255. ``range`` is finite and above 0; if it is None, it is the largest |e|."""
        path = pathlib.Path(file)
        if path.suffix != ".png":
            raise ValueError(f"file: found {str(path)!r}, expected a name that ends in .png")
        write_file(path, self._png(range))

    def _png(self, range: float | None = None) -> bytes:
        if self._a is None or self._b is None:
            raise Error("PNG files have no difference picture, expected pictures, EXR or NPY files to compare")
        darkest_at = (self.linf or 1) if range is None else range
        return _lamina.difference_png(self._a, self._b, darkest_at)

    def _repr_png_(self) -> bytes | None:
        return None if self._a is None else self._png()

    def __repr__(self) -> str:
        return f"<lamina.Comparison linf {self.linf:.4g}, l1 {self.l1:.4g}, l2 {self.l2:.4g}, in 1/255>"


def compare(a: Any, b: Any) -> Comparison:
    """Compares a picture A with a picture B.

    Each is a ``Picture``, an array (height, width, 4) or a file. PNG files compare with PNG files alone, as codes; EXR
    and NPY files compare with everything else. Raises ``lamina.Error`` for different sizes, NaN or infinity, or
    different colour spaces (linear light and display values); ``TypeError`` and ``ValueError`` for arrays of another
    form.

    >>> black, grey = np.zeros((2, 2, 4)), np.full((2, 2, 4), 1 / 255)
    >>> lamina.compare(grey, black)
    <lamina.Comparison linf 1, l1 1, l2 1, in 1/255>
    """
    if _is_png(a) and _is_png(b):
        return Comparison(_lamina.compare_files(pathlib.Path(a), pathlib.Path(b)))
    (pixels_a, space_a), (pixels_b, space_b) = _pixels("a", a), _pixels("b", b)
    if space_a and space_b and space_a != space_b:
        raise Error(f"one picture holds {space_a} and the other {space_b} values (image.color_space), expected the same "
                    "of both")
    return Comparison(_lamina.compare(pixels_a, pixels_b), pixels_a, pixels_b)


def _is_png(picture: Any) -> bool:
    return isinstance(picture, (str, os.PathLike)) and pathlib.Path(picture).suffix.lower() == ".png"


def _pixels(name: str, picture: Any) -> tuple[np.ndarray, str | None]:
    """Returns the numbers and, if it is known, the colour space."""
    if isinstance(picture, (str, os.PathLike)):
        pixels, space = _lamina.load_picture(pathlib.Path(picture))
        return pixels, space
    drawn = getattr(picture, "_drawn", None)
    array = picture.array if drawn is not None else plain_array(picture, name)
    if array.ndim != 3 or array.shape[2] != 4 or not array.size:
        raise ValueError(f"{name}: found the shape {array.shape}, expected (height, width, 4)")
    return array, None if drawn is None else drawn.scene.color_space
