# SPDX-License-Identifier: Apache-2.0
"""VTK's own pictures."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import Error

GL_RGBA, GL_RGBA32F, GL_FLOAT, VTK_FLOAT = 0x1908, 0x8814, 0x1406, 10


def pixels_of(renderer: Any, precise: bool) -> np.ndarray:
    """Returns what VTK draws into a renderer's viewport: (height, width, 3) display values 0..1, row 0 on top."""
    window = renderer.GetRenderWindow()
    if window is None:
        raise Error("renderer: found no window, expected one (renderWindow.AddRenderer(renderer))")
    window.Render()
    rgb = _floats(renderer, window) if precise else _codes(renderer, window)
    wrong = np.count_nonzero(~np.isfinite(rgb).all(axis=2))
    if wrong:
        raise Error(f"VTK's picture has {wrong} pixels that are no numbers, expected none; precise=False takes its codes")
    return np.array(rgb[::-1], dtype=np.float64)


def _corners(renderer: Any) -> tuple[int, int, int, int]:
    left, bottom = renderer.GetOrigin()
    width, height = renderer.GetSize()
    return left, bottom, left + width - 1, bottom + height - 1


def _codes(renderer: Any, window: Any) -> np.ndarray:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
    codes = vtkUnsignedCharArray()
    window.GetPixelData(*_corners(renderer), 0, codes, 0)
    width, height = renderer.GetSize()
    return np.asarray(vtk_to_numpy(codes)).reshape(height, width, 3) / 255


def _floats(renderer: Any, window: Any) -> np.ndarray:
    """A float32 texture takes the place of the colour buffer for one picture."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkFloatArray
    from vtkmodules.vtkRenderingOpenGL2 import vtkTextureObject
    if not hasattr(window, "GetRenderFramebuffer"):
        raise Error(f"window: found {window.GetClassName()}, expected one of OpenGL, or precise=False")
    width, height = window.GetSize()
    target = vtkTextureObject()
    target.SetContext(window)
    target.SetInternalFormat(GL_RGBA32F)
    target.SetFormat(GL_RGBA)
    target.SetDataType(GL_FLOAT)
    target.Allocate2D(width, height, 4, VTK_FLOAT)
    framebuffer = window.GetRenderFramebuffer()
    if framebuffer.GetMultiSamples() > 0:
        raise Error("window: found multisampling, expected none (window.SetMultiSamples(0)), or precise=False")
    own = framebuffer.GetColorAttachmentAsTextureObject(0)
    framebuffer.Bind()
    framebuffer.AddColorAttachment(0, target)
    try:
        window.Render()
        pixels = vtkFloatArray()
        window.GetRGBAPixelData(*_corners(renderer), 0, pixels)
    finally:
        framebuffer.Bind()
        framebuffer.AddColorAttachment(0, own)
    width, height = renderer.GetSize()
    rgb = np.asarray(vtk_to_numpy(pixels)).reshape(height, width, 4)[:, :, :3]
    if np.abs(rgb * 255 - np.round(rgb * 255)).max() < 1e-3 and np.ptp(rgb) > 0:
        raise Error("window: VTK's picture came in 8 bits, expected float32; precise=False takes codes")
    return rgb
