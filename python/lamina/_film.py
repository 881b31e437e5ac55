# SPDX-License-Identifier: Apache-2.0
"""Films."""
from __future__ import annotations

import operator
import pathlib
from typing import TYPE_CHECKING, Iterable, Sequence, overload

from . import _lamina
from ._files import write_file
from ._picture import Picture
from ._volume import Path

if TYPE_CHECKING:
    from ._session import Progress

# Frames a second of a turntable in a notebook, which also shows few views at a pace that an eye follows.
NOTEBOOK_RATE = 12


def save_film(pictures: Iterable[Picture], file: Path, *, fps: int = 25, progress: Progress | None = None) -> None:
    """Writes pictures of one size as the frames of a film, as ``lamina render`` does (docs/films.md): ``.mp4``, ``.webm``
    and ``.gif`` by the program ``ffmpeg``, ``.apng`` without it. Frames have their scenes' background and annotations, or
    are transparent (``.webm`` and ``.apng``) if the scenes are. The film appears when it is complete.

    Raises ``lamina.Error`` if there is no ``ffmpeg``, or if the film cannot hold the pictures.

    >>> session = lamina.Session({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}}, size=(40, 30))
    >>> lamina.save_film([session.draw(), session.draw()], "film.apng", fps=10)
    """
    if isinstance(pictures, Picture):
        raise TypeError("pictures: found one picture, expected a list of them")
    frames = [_frame(picture) for picture in pictures]
    _lamina.save_film(frames, pathlib.Path(file), _rate(fps), progress)


def _rate(fps: int) -> int:
    try:
        return operator.index(fps)
    except TypeError:
        raise TypeError(f"fps: found {fps!r}, expected a whole number") from None


def _frame(picture: Picture) -> bytes:
    if not isinstance(picture, Picture):
        raise TypeError(f"pictures: found {type(picture).__name__}, expected pictures")
    return picture._png(picture._drawn.scene.png_bits)


class Turntable(Sequence[Picture]):
    """The pictures of ``Session.turntable()``, in their order. A notebook shows them as one that moves."""

    def __init__(self, pictures: Sequence[Picture]) -> None:
        self._pictures = list(pictures)

    def __len__(self) -> int:
        return len(self._pictures)

    @overload
    def __getitem__(self, index: int) -> Picture: ...

    @overload
    def __getitem__(self, index: slice) -> Turntable: ...

    def __getitem__(self, index: int | slice) -> Picture | Turntable:
        if isinstance(index, slice):
            return Turntable(self._pictures[index])
        return self._pictures[index]

    def save(self, file: Path, *, fps: int = 25, progress: Progress | None = None) -> None:
        """Writes a film, as ``lamina.save_film`` does: ``.mp4``, ``.webm``, ``.gif`` or ``.apng``; a ``.png`` is an APNG,
        too, of which programs that do not know APNG show the first picture."""
        path = pathlib.Path(file)
        if path.suffix == ".png":
            write_file(path, _lamina.animated_png([_frame(picture) for picture in self], _rate(fps)))
        else:
            save_film(self, path, fps=fps, progress=progress)

    def _repr_png_(self) -> bytes:
        return _lamina.animated_png([picture._repr_png_() for picture in self], NOTEBOOK_RATE)

    def __repr__(self) -> str:
        return f"<lamina.Turntable {len(self)} pictures>"
