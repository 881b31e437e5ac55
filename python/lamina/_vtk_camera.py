# SPDX-License-Identifier: Apache-2.0
"""Cameras of VTK."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._errors import Error, PictureWarning, warn


def camera_keys(renderer: Any) -> dict[str, Any]:
    """Returns a renderer's camera as a scene file has it."""
    camera = renderer.GetActiveCamera()
    _require_plain_camera(camera)
    width, height = renderer.GetSize()
    keys: dict[str, Any] = {"eye": list(camera.GetPosition()), "center": list(camera.GetFocalPoint()),
                            "up": list(camera.GetViewUp())}
    if camera.GetParallelProjection():
        keys.update(projection="orthographic", height=2 * camera.GetParallelScale())
    elif camera.GetUseHorizontalViewAngle():
        half = math.tan(math.radians(camera.GetViewAngle()) / 2) * height / width
        keys["fov_y"] = 2 * math.degrees(math.atan(half))
    else:
        keys["fov_y"] = camera.GetViewAngle()
    return keys


def _require_plain_camera(camera: Any) -> None:
    found = {
        "an off-centre window": tuple(camera.GetWindowCenter()) != (0, 0),
        "a view shear": tuple(camera.GetViewShear()) != (0, 0, 1),
        "off-axis projection": bool(camera.GetUseOffAxisProjection()),
        "an explicit projection matrix": bool(camera.GetUseExplicitProjectionTransformMatrix()),
        "a user view transform": camera.GetUserViewTransform() is not None,
        "a model transform": not _is_identity(camera.GetModelTransformMatrix()),
    }
    for what, is_there in found.items():
        if is_there:
            raise Error(f"camera: found {what}, expected a plain parallel or perspective camera")


def _is_identity(matrix: Any) -> bool:
    return all(matrix.GetElement(row, column) == (row == column) for row in range(4) for column in range(4))


def check_clipping_range(renderer: Any, data: Any) -> None:
    """Warns if VTK's near or far plane cuts the data: lamina has neither."""
    camera = renderer.GetActiveCamera()
    lowest, highest = np.array(data.bounds)
    corners = np.array([[(lowest, highest)[bits >> axis & 1][axis] for axis in range(3)] for bits in range(8)])
    depths = (corners - camera.GetPosition()) @ np.array(camera.GetDirectionOfProjection())
    near, far = camera.GetClippingRange()
    slack = 1e-6 * (highest - lowest).max()
    if (depths.min() < near - slack and depths.max() > near) or depths.max() > far + slack:
        warn(f"VTK draws depths from {near:g} to {far:g} and the data reach from {depths.min():g} to "
             f"{depths.max():g}: what it cuts off is part of the difference; renderer.ResetCameraClippingRange()",
             PictureWarning)
