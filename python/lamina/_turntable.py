# SPDX-License-Identifier: Apache-2.0
"""Pictures from all around."""
from __future__ import annotations

import pathlib
import struct
import zlib
from typing import Iterator, Sequence, overload

from ._files import write_file
from ._picture import Picture
from ._volume import Path

SIGNATURE = b"\x89PNG\r\n\x1a\n"


class Turntable(Sequence[Picture]):
    """The pictures of ``Session.turntable()``, in their order. A notebook shows them as one that moves."""

    def __init__(self, pictures: Sequence[Picture], milliseconds: int = 80) -> None:
        self._pictures = list(pictures)
        self._milliseconds = milliseconds

    def __len__(self) -> int:
        return len(self._pictures)

    @overload
    def __getitem__(self, index: int) -> Picture: ...

    @overload
    def __getitem__(self, index: slice) -> Turntable: ...

    def __getitem__(self, index: int | slice) -> Picture | Turntable:
        if isinstance(index, slice):
            return Turntable(self._pictures[index], self._milliseconds)
        return self._pictures[index]

    def save(self, file: Path) -> None:
        """Writes one ``.apng`` or ``.png`` that moves (APNG: browsers play it, other programs show its first picture).
        ``lamina render --turntable`` makes other films."""
        path = pathlib.Path(file)
        if path.suffix not in (".apng", ".png"):
            raise ValueError(f"file: found {str(path)!r}, expected a name that ends in .apng or .png")
        write_file(path, self._repr_png_())

    def _repr_png_(self) -> bytes:
        return animated([picture._repr_png_() for picture in self._pictures], self._milliseconds)

    def __repr__(self) -> str:
        return f"<lamina.Turntable {len(self)} pictures>"


def chunks_of(png: bytes) -> Iterator[tuple[bytes, bytes]]:
    at = len(SIGNATURE)
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        yield kind, png[at + 8:at + 8 + length]
        at += 12 + length


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def animated(pngs: Sequence[bytes], milliseconds: int) -> bytes:
    """PNG files of one size as one file with a frame each, again and again (the APNG extension)."""
    first = list(chunks_of(pngs[0]))
    header = next(content for kind, content in first if kind == b"IHDR")
    result = [SIGNATURE, chunk(b"IHDR", header), chunk(b"acTL", struct.pack(">II", len(pngs), 0))]
    result += [chunk(kind, content) for kind, content in first if kind not in (b"IHDR", b"IDAT", b"IEND")]
    sequence = 0
    for number, png in enumerate(pngs):
        width_height = header[:8]
        result.append(chunk(b"fcTL", struct.pack(">I", sequence) + width_height
                            + struct.pack(">IIHHBB", 0, 0, milliseconds, 1000, 0, 0)))
        sequence += 1
        for kind, content in chunks_of(png):
            if kind != b"IDAT":
                continue
            if number == 0:
                result.append(chunk(b"IDAT", content))
            else:
                result.append(chunk(b"fdAT", struct.pack(">I", sequence) + content))
                sequence += 1
    return b"".join([*result, chunk(b"IEND", b"")])
