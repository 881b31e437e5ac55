# SPDX-License-Identifier: Apache-2.0
"""Detects changes of arrays that are drawn without a copy."""
from __future__ import annotations

import numpy as np

from . import _lamina

CHANGED = ("the volume's array was changed since it was read: it is read and measured again; Volume.copy() keeps the "
           "samples as they are")


def can_be_written(array: np.ndarray) -> bool:
    """Tells whether numpy lets somebody write to the memory of the array, through it or what it is a view of."""
    owner: object = array
    while isinstance(owner, np.ndarray):
        if owner.flags.writeable:
            return True
        owner = owner.base
    return False


class Watched:
    """Tells whether an array was changed. Each time it looks at one cache line (64 bytes) of each 16, another one each
    time: a contiguous change of 2 KiB is seen at once, a smaller one within 16 times. Of arrays above 64 MiB it looks
    at no more than 4 MiB each time, and a small change may not be seen. Of arrays up to 64 KiB it looks at all."""

    def __init__(self, array: np.ndarray) -> None:
        self._array, self._next = array, 0
        self._hashes = [_lamina.hash_of_part(array, part) for part in range(_lamina.sample_parts)]

    def is_changed(self) -> bool:
        part = self._next
        self._next = (part + 1) % len(self._hashes)
        return _lamina.hash_of_part(self._array, part) != self._hashes[part]
