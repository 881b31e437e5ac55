# SPDX-License-Identifier: Apache-2.0
"""Words for what people change of a picture, as on the command line (docs/first-picture.md, "Changing it")."""
from __future__ import annotations

import json
import os
from typing import Any, Mapping

import numpy as np

from . import _lamina
from ._conversion import number, shown
from ._errors import Error

# Keywords that are words, with the names that the library has for them.
WORDS = {"azimuth": "azimuth", "elevation": "elevation", "zoom": "zoom", "density": "density", "up": "up", "view": "view",
         "light": "light", "crop": "crop", "opacity": "opacity", "preset": "preset", "cmap": "colormap", "clim": "range"}


# matplotlib's maps of up to so many colours are qualitative.
MOST_BANDS = 32


def take_words(keywords: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Returns the keywords that are keys of the scene, and the others as words of the library."""
    keys: dict[str, Any] = {}
    words: dict[str, Any] = {}
    for name, value in keywords.items():
        if value is None or not (name in WORDS or (name == "clip" and _is_word(value))):
            keys[name] = value
        elif name == "clip":
            words["clip"] = [value] if isinstance(value, str) else list(value)
        else:
            words[WORDS[name]] = _plain_word(name, value)
    return {name: value for name, value in keys.items() if name not in WORDS}, words


def _is_word(clip: Any) -> bool:
    return isinstance(clip, str) or (isinstance(clip, (list, tuple)) and all(isinstance(one, str) for one in clip))


def _plain_word(name: str, value: Any) -> Any:
    if name in ("azimuth", "elevation", "zoom", "density"):
        return number(name, value)
    if name == "clim":
        return ",".join(repr(number(name, end)) for end in _pair(name, value))
    if isinstance(value, str) and not value:
        raise ValueError(f"{name}: found '', expected a word")
    if name == "crop" and not isinstance(value, str):
        return _box(value)
    if name == "light" and isinstance(value, bool):
        if not value:
            raise TypeError("light: found False, expected a word; lighting=False draws without light")
        return "headlight"
    if name == "cmap":
        return _colormap(value)
    if name == "opacity" and not isinstance(value, str):
        return _opacity(value)
    if not isinstance(value, str):
        raise TypeError(f"{name}: found {shown(value)}, expected a word")
    return value


def _pair(name: str, value: Any) -> tuple[Any, Any]:
    if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != 2:
        raise TypeError(f"{name}: found {shown(value)}, expected two numbers")
    low, high = value
    return low, high


def _box(value: Any) -> str:
    """The word for ((x0, x1), (y0, y1), (z0, z1)), in which None is an open end."""
    if not hasattr(value, "__len__") or len(value) != 3:
        raise TypeError(f"crop: found {shown(value)}, expected ((x0, x1), (y0, y1), (z0, z1))")
    ends = [[("" if end is None else repr(number("crop", end))) for end in _pair("crop", axis)] for axis in value]
    return ",".join(":".join(axis) for axis in ends)


def _opacity(value: Any) -> str:
    """The word for numbers spread evenly over the values that show, or for pairs (value, number)."""
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.ndim == 1 and len(numbers) > 1:
        return ",".join(repr(share) for share in numbers.tolist())
    if numbers.ndim == 2 and numbers.shape[1] == 2 and len(numbers) > 1:
        return ",".join(f"{at!r}:{share!r}" for at, share in numbers.tolist())
    raise TypeError(f"opacity: found {shown(value)}, expected a word, two or more numbers, or pairs (value, number)")


def _colormap(value: Any) -> str:
    """The word for a map's name or file, or for a matplotlib object or name: then a ParaView preset as text."""
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    if isinstance(value, str):
        names = _lamina.colormap_names()
        if value in names or value.startswith("{") or os.path.exists(value):
            return value
        try:
            import matplotlib  # type: ignore[import]
        except ImportError:
            raise Error(f"cmap: found {shown(value)}, expected {', '.join(names)}, a file, or a name of matplotlib, which "
                        "is not installed") from None
        try:
            value = matplotlib.colormaps[value]
        except (AttributeError, KeyError):
            return str(value)  # the library says which names there are
    count = getattr(value, "N", None)
    if not callable(value) or not isinstance(count, (int, np.integer)) or count < 1:
        raise TypeError(f"cmap: found {shown(value)}, expected a name, a file or a matplotlib colormap")
    # Many colours are points of lines between them; few are bands, as matplotlib shows them.
    colors = _colors(value, int(count))
    rows = [[(i + 0.5) / count, *color] for i, color in enumerate(colors)]
    if count <= MOST_BANDS:
        rows = [[edge / count, *color] for i, color in enumerate(colors) for edge in (i, i + 1)]
    return json.dumps({"ColorSpace": "RGB", "RGBPoints": [one for row in rows for one in row]})


def _colors(colormap: Any, count: int) -> list[list[float]]:
    """All colours of a matplotlib map: three numbers from 0 to 1 each."""
    try:
        colors = np.asarray(colormap(np.arange(count)), dtype=float)
    except Exception as error:
        raise TypeError(f"cmap: {shown(colormap)} gives no colours: {error}") from error
    if colors.shape not in ((count, 3), (count, 4)):
        raise TypeError(f"cmap: {shown(colormap)} gives an array of shape {colors.shape}, expected ({count}, 4) for its "
                        f"{count} colours")
    wrong = colors[:, :3][~((colors[:, :3] >= 0) & (colors[:, :3] <= 1))]
    if len(wrong) > 0:
        raise ValueError(f"cmap: {shown(colormap)} gives {wrong[0]:g} in a colour, expected numbers from 0 to 1")
    listed: list[list[float]] = colors[:, :3].tolist()
    return listed
