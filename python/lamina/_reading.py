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


def _scene_of(file: pathlib.Path, kind: str, selection: dict[str, Any]) -> str:
    """The text of a scene that names a part of a file."""
    return json.dumps({"version": 1, kind: {"path": str(file), **plain(selection)}})


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
    if kind == "scene" and not path.exists():
        raise Error(f"{path}: no such file")
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


def info(file: Path, *, only_below: Path | None = None, **selection: Any) -> dict[str, Any]:
    """Describes a file as ``lamina info --json`` does: docs/info.md explains every key.

    ``arrays``, ``channels``, ``times``, ``levels`` and ``labels`` list, with their names, what there is to choose from;
    ``size``, ``type``, ``range``, ``spacing``, ``origin``, ``unit`` and others describe the part that ``selection``
    chooses. ``only_below`` and ``selection`` are those of ``lamina.read``; of a mesh's file there is ``time``.

    >>> np.save("two.npy", np.zeros((2, 3, 4, 5), np.int16))
    >>> lamina.info("two.npy", channel=1)["channels"]
    ['', '']
    """
    path, folder = pathlib.Path(file), folder_name(only_below)
    is_raw = "size" in selection or "type" in selection
    kind = "volume" if is_raw or not selection else _lamina.kind_of_file(path, folder)
    if kind == "mesh" and set(selection) != {"time"} and selection:
        raise Error(f"{path}: found {', '.join(sorted(selection))}, expected time: all arrays of a mesh are listed")
    scene = _scene_of(path.absolute(), kind, selection) if selection else ""
    text, warnings = _lamina.describe_file(path.absolute(), scene, folder)
    for warning in warnings:
        warn(warning, PictureWarning)
    described: dict[str, Any] = json.loads(text)
    return described
