# SPDX-License-Identifier: Apache-2.0
"""VTK's picture beside lamina's."""
from __future__ import annotations

from typing import Sequence

import numpy as np

from ._comparison import Norms
from ._picture import Picture
from ._lamina import difference_png


class Held:
    """VTK's picture and lamina's of one scene.

    ``vtk``: (height, width, 3) float64, display values 0..1 over the background, row 0 on top. ``picture``: lamina's.
    ``shown``: the same as ``vtk``, of lamina's picture. ``difference``: vtk - shown in 1/255. ``linf``, ``mean``, ``l2``:
    its ``lamina.Norms`` over all pixels and channels; ``l1`` is the same as ``mean``. A notebook shows the difference in
    false colour, from blue (VTK is darker) over white to red.
    """

    def __init__(self, vtk: np.ndarray, picture: Picture, background: Sequence[float]) -> None:
        self.vtk, self.picture = vtk, picture
        rgba = np.asarray(picture.array, dtype=np.float64)
        self.shown = rgba[:, :, :3] + (1 - rgba[:, :, 3:]) * np.asarray(background)
        self.difference = 255 * (self.vtk - self.shown)
        self.linf = float(np.abs(self.difference).max())
        self.l1 = float(self.difference.mean())
        self.l2 = float(np.sqrt(np.mean(self.difference ** 2)))

    @property
    def mean(self) -> float:
        """Mean of the difference with its sign; the same as ``l1``."""
        return self.l1

    @property
    def norms(self) -> Norms:
        """``linf``, ``l1`` and ``l2``."""
        return Norms(self.linf, self.l1, self.l2)

    def _repr_png_(self) -> bytes:
        opaque = [np.dstack([rgb, np.ones(rgb.shape[:2])]) for rgb in (self.vtk, self.shown)]
        return difference_png(opaque[0], opaque[1], self.linf or 1)

    def __repr__(self) -> str:
        return f"<lamina.vtk.Held linf {self.linf:.4g}, l1 {self.l1:.4g}, l2 {self.l2:.4g}, in 1/255>"
