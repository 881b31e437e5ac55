# SPDX-License-Identifier: Apache-2.0
"""Values and gradients at points."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _conversion, _lamina
from ._errors import PictureWarning, warn
from ._mesh import Mesh
from ._volume import Volume


class Sampler:
    """The field of a ``Volume``, an array or a ``Mesh``, as pictures show it: for those who write their own integrator.

    ``scalar``: the name of a mesh's scalar; without it the first one at points. In a volume the value is trilinear
    between samples, and the gradient is the one that light sees: from differences of neighbouring samples, trilinear
    between them. In a mesh the value is linear in each tet; the gradient at a point of the mesh is the mean of the tets
    around it, weighted by volume, and linear in between. All are exact for linear fields. In the half voxels of ``cell``
    axes the border's value and gradient repeat. Arrays that are not copied (``Volume``) are read when they are sampled.

    >>> z, y, x = np.mgrid[0:4, 0:4, 0:4].astype(np.float32)
    >>> values, gradients = lamina.Sampler(lamina.Volume(x + 10 * z, spacing=2)).at([(1, 1, 1), (9, 1, 1)])
    >>> values
    array([5.5, nan])
    >>> gradients[0]
    array([0.5, 0. , 5. ])
    """

    def __init__(self, data: Volume | Mesh | Any, scalar: str | None = None) -> None:
        if isinstance(data, Mesh):
            self._core = _lamina.Sampler.of_mesh(data._core, scalar or "")
            if scalar is None and not data._core.point_scalars:
                warn(f'"{next(iter(data.scalars))}" is cell data: averaged to points', PictureWarning)
            return
        if scalar is not None:
            raise TypeError("scalar: found a name, expected none: a volume has one scalar")
        volume = data if isinstance(data, Volume) else Volume(data)
        self._core = _lamina.Sampler.of_volume(volume._core)

    def at(self, points: Any) -> tuple[np.ndarray, np.ndarray]:
        """Values (...) and gradients (..., 3) at points (..., 3): float64, in units of the value, and of the value per
        world unit. Both are NaN outside the volume's box or the mesh's tets, and beside samples that are not finite.

        ``points``: world coordinates x, y, z. Raises ``ValueError`` for other shapes.
        """
        places = _conversion.plain_array(points, "points")
        if places.ndim < 1 or places.shape[-1] != 3:
            raise ValueError(f"points: found the shape {places.shape}, expected (..., 3)")
        rows = np.ascontiguousarray(places, dtype=np.float64).reshape(-1, 3)
        values, gradients = self._core.at(rows)
        return values.reshape(places.shape[:-1]), gradients.reshape(places.shape)
