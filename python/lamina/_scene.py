# SPDX-License-Identifier: Apache-2.0
"""Scenes: what to draw, and how."""
from __future__ import annotations

import copy
import difflib
import json
import os
import pathlib
from typing import Any, Mapping

import numpy as np

from . import _lamina
from ._conversion import shown
from ._errors import Error
from ._files import write_file
from .keywords import KEYWORDS
from ._mesh import Mesh
from ._plain import plain
from ._volume import Path, Volume, folder_name
from ._words import WORDS

# Suffixes of pictures and of data, which people mean for Picture.save() and Volume.save().
_NO_SCENES = (".png", ".exr", ".npy", ".jpg", ".jpeg", ".tif", ".tiff", ".nrrd", ".vtu")

# Keywords that people expect of render(), and the place that takes each.
_ELSEWHERE = {
    **dict.fromkeys(("title", "axes", "scale_bar", "labels", "box"), ", which annotations={...} takes"),
    **dict.fromkeys(("legend", "colorbar", "colourbar", "scalar_bar"), ', expected annotations={"colorbar": True}'),
    **dict.fromkeys(("spacing", "origin", "directions", "centers", "lookup"), ", which lamina.Volume takes"),
    **dict.fromkeys(("range", "vmin", "vmax", "window", "threshold"), ", expected clim=(LO, HI), the values that show"),
    **dict.fromkeys(("color", "colors", "colour", "colours", "lut", "palette"),
                    ", expected cmap, the name of a colour map, or transfer_function"),
    "alpha": ", expected opacity, or opacities in transfer_function",
    **dict.fromkeys(("turntable", "fps", "frames"), ": lamina.Session(data).turntable(VIEWS).save(FILE, fps=...) makes films"),
    **dict.fromkeys(("output", "file", "filename"), ": lamina.render(data).save(FILE) writes the picture"),
    "samples": ', expected slice={"samples": ...}',
    "image": ", whose keys are keywords themselves, as width=400",
    **dict.fromkeys(("time", "channel", "level", "array"), ", which lamina.read takes"),
}


class Scene(dict[str, Any]):
    """A scene file's keys, and the data in memory that it draws, if any.

    It is a dictionary, to be read and changed as such: ``scene["camera"]["eye"]``. ``data``: a ``Volume`` or a ``Mesh``,
    drawn whatever the keys ``volume`` and ``mesh`` say, or None. ``folder``: what relative paths start from.

    ``render``, ``trace`` and ``Session`` take, wherever they take data: a scene, a plain dictionary of that form, the
    path of a scene file or of a data file, a ``Volume``, a ``Mesh`` or an array. All of them take keywords with the
    names of scene files (``Keywords`` lists them): the scene's own keys, those of ``image`` and those of ``render``,
    ``size=(width, height)``, and ``set={"render.slice.samples": 64}`` for any key, named by its path. A keyword replaces
    what the scene has under its key; None leaves it.

    >>> scene = lamina.Scene({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}})
    >>> lamina.render(scene, size=(40, 30)).array.shape
    (30, 40, 4)
    """

    def __init__(self, document: Mapping[str, Any], data: Volume | Mesh | None = None, folder: Path = "") -> None:
        if not isinstance(document, Mapping):
            raise TypeError(f"scene: found {type(document).__name__}, expected a dictionary")
        super().__init__(plain(document))
        self.data = data
        self.folder = pathlib.Path(folder)
        self._name = "scene"
        self._only_below = ""  # the folder that its data must be in; empty: anywhere

    @classmethod
    def load(cls, file: Path) -> Scene:
        """Reads the scene in a file. Raises ``lamina.Error`` if the file is not one."""
        path = pathlib.Path(file)
        try:
            document = json.loads(path.read_text(encoding="utf-8"), object_pairs_hook=_without_duplicates)
        except OSError as error:
            raise Error(f"{path}: cannot open: {error.strerror}") from None
        except ValueError as error:
            raise Error(f"{path}: found no JSON: {error}") from None
        if not isinstance(document, dict):
            raise Error(f"{path}: found no object, expected a scene {{...}}")
        scene = cls(document, folder=path.parent)
        scene._name = path.name
        return scene

    def save(self, file: Path) -> None:
        """Writes a scene file from which the command line draws the same. Data that are in memory alone go beside it
        (``.nrrd``, ``.vtu``)."""
        path = pathlib.Path(file)
        if path.suffix.lower() in _NO_SCENES:
            raise Error(f"{path}: found the suffix \"{path.suffix}\", expected a name as s.json: a scene is JSON")
        document = dict(self)
        if isinstance(self.data, Volume):
            document["volume"] = self.data._source or str(_kept(self.data, path.with_suffix(".nrrd")))
        elif self.data is not None:
            document["mesh"] = str(_kept(self.data, path.with_suffix(".vtu")))
        for key in ("volume", "mesh"):
            if self.data is None and isinstance(document.get(key), str):
                document[key] = self._absolute(document[key])
        volume = document.get("volume")
        if self.data is None and isinstance(volume, Mapping) and isinstance(volume.get("path"), str):
            document["volume"] = {**volume, "path": self._absolute(volume["path"])}
        write_file(path, (json.dumps(document, indent=1) + "\n").encode())

    def _absolute(self, name: str) -> str:
        if name.startswith("${LAMINA_DATA}"):
            return name
        return os.path.abspath(self.folder / name)

    def _parsed(self, without: str = "") -> _lamina.Scene:
        """Has the library check and read it. `without` is a key that does not matter, because it may take long to read."""
        text = json.dumps({key: value for key, value in self.items() if key != without}, allow_nan=False)
        return _lamina.Scene.parse(text, str(self.folder / self._name), None if self.data is None else self.data._core,
                                   self._only_below)

    def _changed(self, keywords: Mapping[str, Any]) -> Scene:
        """Returns a copy with the keys that keyword arguments stand for."""
        scene = Scene(copy.deepcopy(dict(self)), self.data, self.folder)
        scene._name, scene._only_below = self._name, self._only_below
        for name, value in keywords.items():
            if value is None:
                continue
            if name == "set":
                if not isinstance(value, Mapping):
                    raise TypeError(f"set: found {shown(value)}, expected a dictionary, as in "
                                    '{"render.slice.samples": 64}')
                for key, item in value.items():
                    _set(scene, str(key), plain(item, str(key)))
            elif name == "size":
                width, height = _size(value)
                _set(scene, "image.width", width)
                _set(scene, "image.height", height)
            elif name == "transfer_function" or name in KEYWORDS:
                item = plain(value, name)
                if name in _OBJECTS and not isinstance(item, Mapping) and item != "auto":
                    raise TypeError(f"{name}: found {shown(value)}, expected {_OBJECTS[name]}")
                _set(scene, ".".join(KEYWORDS.get(name, (name,))), item)
            else:
                near = difflib.get_close_matches(name, [*KEYWORDS, *WORDS, "size", "set", "transfer_function"], 1)
                hint = _ELSEWHERE.get(name) or (f", did you mean {near[0]!r}?" if near else "")
                raise TypeError(f"unexpected keyword {name!r}{hint}")
        return scene

    def __repr__(self) -> str:
        return f"<lamina.Scene {shown(dict(self))}, {self.data!r}>" if self.data is not None else super().__repr__()


def scene_of(data: Any, transfer_function: Any = None, keywords: Mapping[str, Any] | None = None,
             only_below: Path | None = None) -> Scene:
    """Returns the scene that draws what a caller names, in any of the ways that ``Scene`` lists."""
    changes = {"transfer_function": transfer_function, **(keywords or {})}
    folder = folder_name(only_below)
    chosen = _CHOSEN if transfer_function is None else {}
    scene = _plain_scene_of(data, folder, chosen)._changed(changes)
    scene._only_below = folder
    return scene


# Keywords for which Python has objects.
_OBJECTS = {"camera": "a lamina.Camera, a dictionary or \"auto\"",
            "transfer_function": "a lamina.TransferFunction, a dictionary or \"auto\"; cmap names a colour map"}

# Keys chosen for a picture of plain data, beside transfer function and camera (docs/first-picture.md), unless a
# transfer function is given.
_CHOSEN: dict[str, Any] = {"lighting": "auto", "image": {"background": [1, 1, 1]}}


def _plain_scene_of(data: Any, only_below: str, chosen: Mapping[str, Any]) -> Scene:
    if isinstance(data, Scene):
        return data
    if isinstance(data, Mapping):
        return Scene(data)
    if isinstance(data, (str, os.PathLike)):
        return _file_scene(pathlib.Path(data), only_below, chosen)
    if isinstance(data, Volume):
        return Scene({"version": 1, **({"volume": data._source} if data._source else {}), **chosen}, data)
    if isinstance(data, Mesh):
        document: dict[str, Any] = {"version": 1, **({"mesh": data.file} if data.file else {}), **chosen}
        if not data._core.point_scalars:
            document["scalar"] = next(iter(data.scalars), "")
        return Scene(document, data)
    if hasattr(data, "__array__") or hasattr(data, "__array_interface__") or isinstance(data, memoryview):
        return Scene({"version": 1, **chosen}, Volume(np.asanyarray(data)))
    raise TypeError(f"found {type(data).__name__}, expected a Volume, a Mesh, an array, a Scene, a dictionary or the path "
                    "of a scene or data file")


def _file_scene(path: pathlib.Path, only_below: str, chosen: Mapping[str, Any]) -> Scene:
    kind = _lamina.kind_of_file(path, only_below)
    if kind == "scene":
        return Scene.load(path)
    # The command line has the same rule (docs/first-picture.md).
    return Scene({"version": 1, kind: str(path.absolute()), "nan": "transparent", **chosen})


def _kept(data: Volume | Mesh, beside: pathlib.Path) -> pathlib.Path:
    """Returns the file that has the data: their own, or a new one."""
    if data.file is not None:
        return data.file
    data.save(beside)
    return beside.absolute()


def _size(size: Any) -> tuple[int, int]:
    if not hasattr(size, "__len__") or len(size) != 2:
        raise TypeError(f"size: found {shown(size)}, expected (width, height)")
    width, height = plain(list(size), "size")
    return width, height


def _set(document: dict[str, Any], key: str, value: Any) -> None:
    """Sets a key that is named by its path; None removes it."""
    *path, last = key.split(".")
    node: Any = document
    if key in ("mesh.scalar", "mesh.array"):
        raise ValueError(f"set: {key}: expected 'scalar': the array of a mesh is a key of the scene itself")
    if path and path[0] in ("volume", "mesh") and isinstance(document.get(path[0]), str):
        document[path[0]] = {"path": document[path[0]]}  # a file's name stands for an object with a path
    for part in path:
        if isinstance(node, dict):
            if node.get(part) == "auto":
                node[part] = {}
            node = node.setdefault(part, {})
        elif isinstance(node, list) and part.isdigit() and int(part) < len(node):
            node = node[int(part)]
        else:
            raise ValueError(f"set: {key}: {part!r} is not inside an object")
    if isinstance(node, list) and last.isdigit() and int(last) < len(node):
        node[int(last)] = value
    elif not isinstance(node, dict):
        raise ValueError(f"set: {key}: {last!r} is not inside an object")
    elif value is None:
        node.pop(last, None)
    else:
        node[last] = value


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise ValueError(f"the key {name!r} stands twice in one object")
        found[name] = value
    return found
