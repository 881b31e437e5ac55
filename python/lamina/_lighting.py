# SPDX-License-Identifier: Apache-2.0
"""Light on emission."""
from __future__ import annotations

import dataclasses
from typing import Any, Sequence

from ._plain import plain


@dataclasses.dataclass(frozen=True)
class Light:
    """``direction``: ``"headlight"`` (to the eye, along every ray) or a vector (x, y, z) to the light, in world space.
    ``color``: as colours of transfer functions, components 0..1000."""

    direction: str | Sequence[float] = "headlight"
    color: Any = (1, 1, 1)

    def to_scene(self) -> dict[str, Any]:
        """One of the key ``lighting.lights`` of a scene file."""
        return {"direction": plain(self.direction, "direction"), "color": plain(self.color, "color")}


@dataclasses.dataclass(frozen=True)
class Lighting:
    """Emission lit by the gradient of the scalar, on both of its sides; opacity stays what it is.

    ``ambient``, ``diffuse``, ``specular`` (0..1000) and ``power`` (1..1000) are those of Blinn and Phong.
    ``smallest_gradient``, in scalar units per world unit: what is hardly steeper fades into the unlit picture; ``"auto"``
    is chosen from the data. Lit scenes are drawn by the method ``"trace"`` and by exact slices of the cpu engine
    (``context="cpu"``); the others refuse them.

    >>> lamina.Lighting(specular=0.3, power=30).to_scene()["lights"]
    [{'direction': 'headlight', 'color': [1, 1, 1]}]
    """

    ambient: float = 0.1
    diffuse: float = 0.7
    specular: float = 0.2
    power: float = 10
    smallest_gradient: float | str = "auto"
    lights: Sequence[Light] = (Light(),)

    def to_scene(self) -> dict[str, Any]:
        """The key ``lighting`` of a scene file."""
        keys = {field.name: plain(getattr(self, field.name), f"lighting.{field.name}")
                for field in dataclasses.fields(self)}
        return keys
