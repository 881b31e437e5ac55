# SPDX-License-Identifier: Apache-2.0
"""Python's values as those of JSON."""
from __future__ import annotations

import math
import os
from typing import Any, Mapping

import numpy as np


def plain(value: Any, key: str = "") -> Any:
    """Returns a value as a scene file would have it. `key` is its place, for messages."""
    if hasattr(value, "to_scene"):
        return value.to_scene()
    if value is None or isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(name): plain(item, f"{key}.{name}".lstrip(".")) for name, item in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), key)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{key}: found {value}, expected a finite number")
        return value
    if isinstance(value, (list, tuple, range)):
        return [plain(item, f"{key}.{index}") for index, item in enumerate(value)]
    raise TypeError(f"{key}: found {type(value).__name__}, expected what a scene file can hold")
