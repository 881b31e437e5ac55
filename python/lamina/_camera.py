# SPDX-License-Identifier: Apache-2.0
"""Cameras."""
from __future__ import annotations

import dataclasses
import json
from typing import Any, Sequence

from . import _conversion, _lamina
from ._mesh import Mesh
from ._volume import Volume

Vector = tuple[float, float, float]


def _expect_data(data: Any) -> None:
    if not isinstance(data, (Volume, Mesh)):
        raise TypeError(f"data: found {type(data).__name__}, expected a lamina.Volume or a lamina.Mesh")


@dataclasses.dataclass(frozen=True)
class Camera:
    """``eye``, ``center``: world places (x, y, z) that it is at and looks at. ``up``: any vector not along the view.
    ``projection``: ``"perspective"`` (``fov_y``: its full vertical angle in degrees) or ``"orthographic"`` (``height``
    of the picture in world units).

    >>> camera = lamina.Camera(eye=(0, 0, 5), center=(0, 0, 0))
    >>> [round(number, 12) for number in camera.turned(90).eye]
    [5.0, 0.0, 0.0]
    """

    eye: Vector
    center: Vector
    up: Vector = (0, 1, 0)
    fov_y: float = 40
    height: float = 1
    projection: str = "perspective"

    def __post_init__(self) -> None:
        for name in ("eye", "center", "up"):
            object.__setattr__(self, name, _conversion.triple(name, getattr(self, name)))
        if self.projection not in ("perspective", "orthographic"):
            raise ValueError(f"projection: found {self.projection!r}, expected \"perspective\" or \"orthographic\"")
        object.__setattr__(self, "fov_y", float(self.fov_y))
        object.__setattr__(self, "height", float(self.height))

    @classmethod
    def look_at(cls, eye: Sequence[float], center: Sequence[float], up: Sequence[float] = (0, 1, 0), *,
                fov_y: float = 40, height: float | None = None) -> Camera:
        """A camera at ``eye`` that looks at ``center``: perspective, or orthographic if ``height`` is given."""
        places = [_conversion.triple(name, place) for name, place in (("eye", eye), ("center", center), ("up", up))]
        if height is None:
            return cls(places[0], places[1], places[2], fov_y)
        return cls(places[0], places[1], places[2], fov_y, height, "orthographic")

    @classmethod
    def orbit(cls, data: Volume | Mesh, azimuth: float = 0, elevation: float = 0, *, fov_y: float = 40) -> Camera:
        """Looks at the data's box from outside, so that all of it is seen: from its +z side at azimuth and elevation 0,
        to the right (+x) and up (+y) as they grow. Degrees.

        >>> lamina.Camera.orbit(lamina.Volume(np.zeros((9, 9, 9), np.uint8)), azimuth=90).center
        (4.0, 4.0, 4.0)
        """
        _expect_data(data)
        lowest, highest = data.bounds
        degrees = [_conversion.number(name, angle)
                   for name, angle in (("azimuth", azimuth), ("elevation", elevation), ("fov_y", fov_y))]
        return cls(**_lamina.orbit(lowest, highest, *degrees))

    @classmethod
    def fit(cls, data: Volume | Mesh, transfer_function: Any = None, azimuth: float = 0, elevation: float = 0, *,
            size: Sequence[int] = (800, 600)) -> Camera:
        """The camera of pictures without one: in three-quarter view, so that what the transfer function shows of the
        data (None: the automatic one) fills a picture of ``size`` (width, height) pixels; gone around that by degrees
        to the right and up, fitted again."""
        from ._scene import scene_of  # a scene reads cameras
        _expect_data(data)
        scene = scene_of(data, transfer_function, {"size": size})._parsed()
        return cls(**_lamina.fit(scene, data._core, _conversion.number("azimuth", azimuth),
                                 _conversion.number("elevation", elevation)))

    def turned(self, degrees: float) -> Camera:
        """This camera with its eye turned about the axis ``up`` through ``center``."""
        scene = {"version": 1, "volume": {"generate": "constant"}, "camera": self.to_scene()}
        parsed = _lamina.Scene.parse(json.dumps(scene), "camera")
        return Camera(**_lamina.turned(parsed, _conversion.number("degrees", degrees)))

    def to_scene(self) -> dict[str, Any]:
        """The key ``camera`` of a scene file."""
        return {name: list(value) if isinstance(value, tuple) else value
                for name, value in dataclasses.asdict(self).items()}
