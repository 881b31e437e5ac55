# SPDX-License-Identifier: Apache-2.0
"""Pictures."""
from __future__ import annotations

import functools
import json
import pathlib
from typing import Any, NamedTuple

import numpy as np

from . import _lamina
from ._comparison import Comparison, compare
from ._conversion import converted
from ._mesh import Mesh
from ._scene import Scene
from ._volume import Path, Volume


class Omission(NamedTuple):
    """Something that the scene did not need, and why it was left out."""

    name: str
    reason: str


class Plan(NamedTuple):
    """The way in which a picture was drawn. ``slabs``: number of slabs of slicing. ``text``: all of it for people."""

    method: str
    target: str
    slabs: int
    text: str


class Picture:
    """A picture and what is known of it. It does not change when its session draws again.

    >>> picture = lamina.render({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}}, size=(32, 24))
    >>> picture
    <lamina.Picture 32 x 24, slice>
    >>> picture.array.dtype, picture.array.shape
    (dtype('float32'), (24, 32, 4))
    >>> picture.array is picture.array
    True
    """

    def __init__(self, drawn: _lamina.Drawn, data: Volume | Mesh | None) -> None:
        self._drawn, self._data, self._array = drawn, data, drawn.array

    @property
    def array(self) -> np.ndarray:
        """(height, width, 4): red, green, blue, opacity; associated, before any background, in linear light unless the
        scene's ``color_space`` is ``"display"``; row 0 on top. float32, of ``trace`` float64. No copy: a session uses
        the memory again only when nobody holds it."""
        return self._array

    @property
    def annotations(self) -> np.ndarray | None:
        """The layer of what is drawn beside the picture (keyword ``annotations``): an array of the shape and in the colour
        space of ``array``, float32, associated; or ``None``. PNG files show it over the picture, EXR files have it as a
        layer."""
        return self._drawn.annotations

    @property
    def error(self) -> float | None:
        """The largest error of the picture, in 1/255, of any pixel and channel; ``None`` if it is unknown: the scene
        states something that nothing was measured of (triangles, say), tets of the mesh overlap and are not ordered, more
        than 8 was found, or a ray runs along a surface at which the transfer function jumps, or in a face of a mesh's
        boundary, and may be off by more than ``max_error``. ``error_kind`` says how it is known.
        """
        return self._drawn.error

    @property
    def error_kind(self) -> str:
        """Evidence for ``error``. ``"derived"``: a bound, no pixel is worse. ``"trials"``: found with the number of slabs
        that was chosen, on rays of the view. ``"sampled"``: found on rays of the view and tets of the mesh.
        ``"estimated"``: by the rule that cuts lit rays into pieces, or, of a traced picture, by the tracer. ``"unknown"``."""
        return self._drawn.error_kind

    @property
    def error_along_ramps(self) -> float | None:
        """A bound, in 1/255, on the error of rays that run along a surface at which the transfer function is steep, if
        ``error`` does not hold for them; else ``None``."""
        return self._drawn.error_along_ramps

    @property
    def plan(self) -> Plan:
        """The way in which the picture was drawn."""
        scene, traced = self._drawn.scene, self._drawn.scene.method == "trace"
        return Plan(scene.method, "float64" if self._drawn.traced else "float32" if traced else self._drawn.target,
                    self._drawn.slabs, self._drawn.explanation)

    @property
    def omitted(self) -> list[Omission]:
        """Work that was left out, and why. It does not change the picture."""
        return [Omission(*omission) for omission in self._drawn.omitted]

    @property
    def stats(self) -> dict[str, Any]:
        """``drawn_by``, ``draw_ms``, ``stages_ms`` (by name), ``fragments`` (segments of rays; 0: not counted),
        ``bytes`` (memory beside the data)."""
        return self._drawn.statistics

    @property
    def warnings(self) -> list[str]:
        """Warnings about data and picture, each said once by a session."""
        return list(self._drawn.warnings)

    @functools.cached_property
    def scene(self) -> Scene:
        """The scene with every key written out, what was automatic as well: drawn again, by the command line too, it
        gives the same picture, bit for bit on the cpu engine."""
        document = json.loads(self._drawn.scene.text())
        scene = Scene(document, self._data)
        return scene

    def save(self, file: Path, *, transparent: bool | None = None) -> None:
        """Writes ``.exr`` (float32, with scene and plan), ``.npy`` (every number as it is) or ``.png`` (to look at, over
        the scene's background or, if ``transparent``, without one and with straight alpha; unless given, as the scene's
        key says; with the scene's annotations). The file appears when it is complete."""
        scene = self._drawn.scene
        alpha = scene.transparent if transparent is None else transparent
        attributes = {"scene": scene.text(), "plan": self._drawn.explanation,
                      "renderer": str(self.stats["drawn_by"]), "software": f"lamina {_lamina.version}"}
        _lamina.save_picture(self._drawn, self._array, pathlib.Path(file), scene.background, alpha, scene.png_bits,
                             scene.color_space, attributes)

    def compare(self, other: Any) -> Comparison:
        """Compares this picture with another one (a picture, an array, an EXR or NPY file): ``lamina.compare``."""
        return compare(self, other)

    def _png(self, bits: int) -> bytes:
        scene = self._drawn.scene
        return _lamina.picture_png(self._drawn, self._array, scene.background, scene.transparent, bits, scene.color_space)

    def _repr_png_(self) -> bytes:
        return self._png(8)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return converted(self._array, dtype, copy)

    def __dlpack__(self, *, stream: Any = None) -> Any:
        return self._array.__dlpack__(stream=stream)

    def __dlpack_device__(self) -> Any:
        return self._array.__dlpack_device__()

    def __repr__(self) -> str:
        height, width = self._array.shape[:2]
        return f"<lamina.Picture {width} x {height}, {self._drawn.scene.method}>"
