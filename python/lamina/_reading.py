# SPDX-License-Identifier: Apache-2.0
"""Data from files."""
from __future__ import annotations

import pathlib

from . import _lamina
from ._errors import Error
from ._mesh import Mesh
from ._volume import Path, Volume


def read(file: Path) -> Volume | Mesh:
    """The volume or the tetrahedral mesh in a file, of every kind that ``lamina render`` draws, known by its content.

    World coordinates are the file's own. Raises ``lamina.Error`` for bad files, and for scenes: ``lamina.Scene.load``
    reads these.

    >>> lamina.Volume(np.zeros((2, 3, 4), np.int16)).save("small.nrrd")
    >>> lamina.read("small.nrrd")
    <lamina.Volume 4 x 3 x 2 int16, from (0, 0, 0) to (3, 2, 1)>
    """
    path = pathlib.Path(file)
    kind = _lamina.kind_of_file(path)
    if kind == "scene":
        raise Error(f"{path}: holds a scene, expected a volume or a mesh; lamina.Scene.load reads scenes")
    absolute = path.absolute()
    if kind == "volume":
        return Volume._of(_lamina.Volume.load(path), absolute)
    return Mesh._of(_lamina.Mesh.load(path), absolute)
