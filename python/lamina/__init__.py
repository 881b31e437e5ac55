# SPDX-License-Identifier: Apache-2.0
"""lamina: an array in, a picture and its error out.

Draws volumes and tetrahedral meshes, and says how wrong each picture is.

    >>> import lamina, numpy as np
    >>> z, y, x = np.mgrid[-1:1:48j, -1:1:48j, -1:1:48j].astype(np.float32)
    >>> volume = lamina.Volume(np.exp(-4 * (x * x + y * y + z * z)), spacing=2 / 47)
    >>> picture = lamina.render(volume, size=(160, 120))

A notebook shows ``picture``; ``picture.array`` has its numbers, ``picture.save("a.png")`` writes it. How wrong is it?

    >>> truth = lamina.trace(picture.scene)
    >>> picture.compare(truth).linf < 1     # the largest error, in 1/255: max_error was 1
    True

Data: ``Volume``, ``Mesh``, ``read``, ``info``, ``mesh``, ``Sampler`` (values and gradients at points).
Looks: ``TransferFunction``, ``Camera``, ``Lighting``, ``Light``; everything else by the names that scene files have
(``Scene``; types: ``Keywords``, ``Changes``, ``lamina.keywords``).
Pictures: ``render``, ``trace``, ``Session`` (to change things and draw again), ``Picture``, ``Turntable``,
``save_film``.
Errors: ``compare``, ``Comparison``, ``study``, ``Study``.
VTK: ``lamina.vtk`` takes over a ``vtkRenderer`` and holds its picture against the truth.

Lengths are in world units, errors of pictures in 1/255 of full scale, times in ms, angles in degrees. Pictures are
linear, associated RGBA with row 0 on top. What is wrong with data and scenes is a ``lamina.Error``; wrong arguments are
``TypeError`` and ``ValueError``.
"""
from typing import Any as _Any

from . import _lamina
from ._camera import Camera
from ._comparison import Comparison, Norms, compare
from ._drawing import render, trace
from ._errors import Error, PictureWarning, PrecisionWarning
from ._film import Turntable, save_film
from ._lamina import version as __version__
from .keywords import Changes, Keywords
from ._lighting import Light, Lighting
from ._mesh import Mesh, mesh
from ._picture import Omission, Picture, Plan
from ._reading import info, read
from ._sampling import Sampler
from ._scene import Scene
from ._session import Session
from ._study import Study, study
from ._transfer_function import TransferFunction
from ._volume import Volume

colormaps = tuple(_lamina.colormap_names())

__all__ = [
    "Camera", "Changes", "Comparison", "Error", "Keywords", "Light", "Lighting", "Mesh", "Norms", "Omission",
    "Picture", "PictureWarning", "Plan", "PrecisionWarning", "Sampler", "Scene", "Session", "Study", "TransferFunction",
    "Turntable", "Volume", "colormaps", "compare", "info", "mesh", "read", "render", "save_film", "study", "trace",
]

for _name in __all__:
    if hasattr(globals()[_name], "__module__"):
        globals()[_name].__module__ = "lamina"
del _name


def __getattr__(name: str) -> _Any:
    if name == "vtk":  # VTK takes a second to import
        import importlib
        return importlib.import_module("lamina.vtk")
    raise AttributeError(f"module 'lamina' has no attribute {name!r}")
