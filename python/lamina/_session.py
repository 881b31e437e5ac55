# SPDX-License-Identifier: Apache-2.0
"""Scenes that change and are drawn again."""
from __future__ import annotations

import json
import threading
from typing import TYPE_CHECKING, Any, Callable, Mapping

from . import _lamina
from ._camera import Camera
from ._errors import PictureWarning, warn
from ._film import Turntable
from ._picture import Picture
from ._scene import Scene, scene_of
from ._volume import Path, Volume
from ._watched import CHANGED, Watched
from ._words import take_words

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Changes, Keywords

Progress = Callable[[str, float], object]


class Session:
    """Draws a scene again and again while camera, size, transfer function and settings change, and does each time only
    what the change makes necessary.

    ``data``, ``transfer_function`` and keywords: as ``Scene`` lists them. ``context``: ``"auto"`` (a GPU if there is
    one, else the cpu engine), ``"cpu"`` (that engine), ``"egl"`` or ``"osmesa"``. ``threads``: at most so many,
    0: one for each processor. ``many_frames``: choices may take longer if they make each picture quicker.
    ``only_below``: a folder; files that are not below it with all links followed, whoever names them, are refused.

    What is automatic is chosen for the first picture and kept; ``choose_again()`` chooses it again. Sessions of several
    threads do not disturb each other, and threads that share a session take turns.

    >>> session = lamina.Session({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}}, size=(40, 30))
    >>> first = session.draw()
    >>> session.camera = session.camera.turned(20)
    >>> second = session.draw()
    >>> first.compare(second).linf > 1
    True
    """

    def __init__(self, data: Any, transfer_function: Any = None, *, context: str = "auto", threads: int = 0,
                 many_frames: bool = False, only_below: Path | None = None, **keywords: Unpack[Keywords]) -> None:
        keys, words = take_words(keywords)
        self._scene = scene_of(data, transfer_function, keys, only_below)
        self._options = context, threads, many_frames, self._scene._only_below
        self._changing = threading.RLock()
        self._read()
        if words:
            self._adjust(words)

    def _read(self) -> None:
        data = self._scene.data
        watched = data._watched() if isinstance(data, Volume) else None
        core = _lamina.Session(self._scene._parsed(), None if data is None else data._core, *self._options)
        self._watched: Watched | None = watched
        self._core = core

    def _read_if_changed(self) -> None:
        with self._changing:
            changed = self._watched is not None and self._watched.is_changed()
            if changed:
                self._read()
        if changed:
            warn(CHANGED, PictureWarning)

    @property
    def scene(self) -> Scene:
        """The scene as it was asked for: a copy."""
        return self._scene._changed({})

    @property
    def resolved_scene(self) -> Scene:
        """The scene with every key written out, automatic ones as they were chosen: a copy."""
        return Scene(json.loads(self._core.resolved().text()), self._scene.data)

    @property
    def explanation(self) -> str:
        """The way in which pictures are drawn, line by line, and what is left out and why."""
        return self._core.explanation()

    def draw(self, progress: Progress | None = None) -> Picture:
        """Draws a picture. ``progress(activity, share)`` is called with how far it is, some 20 times a
        second. Ctrl-C ends it (``KeyboardInterrupt``), as does an exception of ``progress``; the next picture is then
        drawn from the start."""
        self._read_if_changed()
        return self._picture(self._core.draw(progress))

    def trace(self, progress: Progress | None = None) -> Picture:
        """Draws the truth: the same view by the reference tracer in double precision, to ``render.trace.tolerance`` (1e-5 of
        full scale). It takes seconds to minutes."""
        self._read_if_changed()
        return self._picture(self._core.trace(progress))

    def set(self, **keywords: Unpack[Changes]) -> None:
        """Changes keys of the scene, as ``Scene`` lists them, and ``transfer_function``. Settings of ``render`` choose what
        is automatic again; ``camera``, ``size``, ``transfer_function`` and ``clip`` do not. Words (``view``, ``light``, ...)
        change what the session has by then; camera, transfer function, lighting and clip are then written out."""
        keys, words = take_words(keywords)
        with self._changing:
            if keys:
                self._set(keys)
            if words:
                self._adjust(words)

    def _adjust(self, words: dict[str, Any]) -> None:
        chosen = json.loads(self._core.adjust(words).text())
        for key in ("camera", "transfer_function", "lighting", "clip"):
            if key in chosen:
                self._scene[key] = chosen[key]

    def _set(self, keywords: Mapping[str, Any]) -> None:
        changed = self._scene._changed(keywords)
        cheap = {"camera": self._core.set_camera, "size": self._core.set_size, "clip": self._core.set_clip,
                 "transfer_function": self._core.set_transfer_function}
        given = [name for name, value in keywords.items() if value is not None]
        automatic = any(changed.get(name, "auto") == "auto" for name in ("camera", "transfer_function") if name in given)
        if automatic or not set(given) <= set(cheap):
            self._core.set_scene(changed._parsed())
        else:
            # A colour map is read from a file: not for every camera.
            parsed = changed._parsed(without="" if "transfer_function" in given else "transfer_function")
            for name in given:
                cheap[name](parsed)
        self._scene = changed

    def choose_again(self) -> None:
        """Chooses all automatic values again."""
        self._core.choose_again()

    @property
    def camera(self) -> Camera:
        """The camera, as it was set or chosen. Set it to a ``Camera``, a dictionary or ``"auto"``."""
        return Camera(**self.resolved_scene["camera"])

    @camera.setter
    def camera(self, camera: Any) -> None:
        self.set(camera=camera)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels. Set it to change them."""
        parsed = self._scene._parsed(without="transfer_function")
        return parsed.width, parsed.height

    @size.setter
    def size(self, size: tuple[int, int]) -> None:
        self.set(size=size)

    @property
    def transfer_function(self) -> dict[str, Any]:
        """The points that are drawn, as a scene file has them: value, colour, extinction. Set it to a
        ``TransferFunction``, a dictionary or ``"auto"``."""
        points: dict[str, Any] = self.resolved_scene["transfer_function"]
        return points

    @transfer_function.setter
    def transfer_function(self, transfer_function: Any) -> None:
        self.set(transfer_function=transfer_function)

    def turntable(self, views: int = 36, progress: Progress | None = None) -> Turntable:
        """Pictures from all around: ``views`` of them, the camera turned about its ``up`` by 360 / ``views`` degrees
        from one to the next, the first from where it is. In a notebook the result moves; ``save`` makes a film of it.
        Afterwards the camera is where it was, written out if it was automatic."""
        if views < 1:
            raise ValueError(f"views: found {views!r}, expected 1 or more")
        camera, pictures = self.camera, []
        try:
            for view in range(views):
                self.camera = camera.turned(360 * view / views) if view else camera
                pictures.append(self.draw())
                if progress is not None:
                    progress("drawing views", (view + 1) / views)
        finally:
            self.camera = camera
        return Turntable(pictures)

    def _picture(self, drawn: _lamina.Drawn) -> Picture:
        for text in drawn.warnings:
            warn(text, PictureWarning)
        return Picture(drawn, self._scene.data)
