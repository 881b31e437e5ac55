# SPDX-License-Identifier: Apache-2.0
"""Data from files."""
from __future__ import annotations

import json
import pathlib
from typing import Any

from . import _lamina
from ._errors import Error, PictureWarning, warn
from ._mesh import Mesh
from ._plain import plain
from ._volume import Path, Volume, folder_name


def read(file: Path, *, only_below: Path | None = None, **selection: Any) -> Volume | Mesh:
    """The volume or the tetrahedral mesh in a file, of every kind that ``lamina render`` draws, known by its content.

    Of a volume's file ``selection`` has the keys of a scene's volume object: ``array``, ``level``, ``channel``, ``time``,
    ``spacing``, ``origin``; of a file without a header ``size``, ``type``, ``offset`` and ``endian``.

    ``only_below``: a folder; files that are not below it with all links followed, whoever names them, are refused.

    World coordinates are the file's own. What is noteworthy, such as that samples are taken for labels, or which of
    several channels is read, is a ``PictureWarning``. Raises ``lamina.Error`` for bad files, and for scenes: ``lamina.Scene.load``
    reads these.

    >>> lamina.Volume(np.zeros((2, 3, 4), np.int16)).save("small.nrrd")
    >>> lamina.read("small.nrrd")
    <lamina.Volume 4 x 3 x 2 int16, from (0, 0, 0) to (3, 2, 1)>
    """
    path, folder = pathlib.Path(file), folder_name(only_below)
    kind = "volume" if selection else _lamina.kind_of_file(path, folder)
    if kind == "scene":
        raise Error(f"{path}: holds a scene, expected a volume or a mesh; lamina.Scene.load reads scenes")
    absolute = path.absolute()
    if kind == "volume":
        source: str | dict[str, Any] = {"path": str(absolute), **plain(selection)} if selection else str(absolute)
        core, warnings = _lamina.Volume.load(json.dumps({"version": 1, "volume": source}), folder)
        for text in warnings:
            warn(text, PictureWarning)
        return Volume._of(core, absolute, source)
    return Mesh._of(_lamina.Mesh.load(path, folder), absolute)
