# SPDX-License-Identifier: Apache-2.0
"""Single pictures."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._picture import Picture
from ._scene import scene_of
from ._session import Progress, Session
from ._volume import Path
from ._words import take_words

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Keywords


def render(data: Any, transfer_function: Any = None, *, context: str = "auto", threads: int = 0,
           progress: Progress | None = None, only_below: Path | None = None, **keywords: Unpack[Keywords]) -> Picture:
    """Draws one picture.

    ``data``: a ``Volume``, a ``Mesh``, an array, a scene (``Scene``, dictionary or file) or a data file. What is not said
    is chosen from the data. ``transfer_function``: a ``TransferFunction``, or what scene files have. Other keywords have
    the names of scene files (``Keywords``): ``camera``, ``size``, ``max_error``, ``method``, ``lighting``, ``clip``, ...
    or are the command line's words: ``up``, ``view``, ``azimuth``, ``elevation``, ``zoom``, ``light``, ``clip``, ``crop``,
    ``opacity``, ``preset``, ``cmap``, ``clim`` (``--range``), ``density``.
    ``context``, ``threads``, ``only_below``: as for ``Session``, which is quicker if several pictures are drawn of the
    same data. ``progress(activity, share)``: hears how far it is.

    Raises ``lamina.Error`` for bad data and scenes, ``TypeError`` and ``ValueError`` for arguments of the wrong form,
    ``KeyboardInterrupt`` after Ctrl-C.

    >>> ramp = np.linspace(0, 1, 32, dtype=np.float32) * np.ones((32, 32, 1), np.float32)
    >>> volume = lamina.Volume(ramp, spacing=1 / 31)
    >>> tf = lamina.TransferFunction([(0, "white", 0), (1, "white", 2)])
    >>> picture = lamina.render(volume, tf, camera=lamina.Camera.orbit(volume), size=(64, 48), max_error=0.5)
    >>> 0.5 < picture.array[24, 32, 3] < 0.75
    True
    """
    return Session(data, transfer_function, context=context, threads=threads, only_below=only_below,
                   **keywords).draw(progress)


def trace(data: Any, transfer_function: Any = None, *, threads: int = 0, progress: Progress | None = None,
          only_below: Path | None = None, **keywords: Unpack[Keywords]) -> Picture:
    """Draws the truth: the same picture by the reference tracer, in double precision (``Picture.array`` is float64).

    Arguments are those of ``render``; ``trace={"tolerance": 1e-7}`` asks for less error than 1e-5 of full scale. It takes
    seconds to minutes.

    >>> scene = {"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}}
    >>> truth = lamina.trace(scene, size=(24, 18))
    >>> picture = lamina.render(truth.scene, method="slice")
    >>> picture.compare(truth).linf < 1
    True
    """
    keys, words = take_words(keywords)
    scene = scene_of(data, transfer_function, keys, only_below)
    if scene._parsed().method == "project":
        scene.setdefault("render", {}).setdefault("trace", {}).setdefault("of", "mesh")
    session = Session(scene, threads=threads, only_below=only_below, method="trace")
    if words:
        session._adjust(words)
    return session.trace(progress)
