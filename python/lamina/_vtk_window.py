# SPDX-License-Identifier: Apache-2.0
"""VTK's own pictures."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import Error

GL_RGBA, GL_RGBA32F, GL_FLOAT, VTK_FLOAT = 0x1908, 0x8814, 0x1406, 10


def pixels_of(renderer: Any, precise: bool) -> np.ndarray:
    """Returns what VTK draws into a renderer's viewport: (height, width, 3) display values 0..1, row 0 on top.

    ``precise``: float32 if True, else the window's 8-bit codes / 255.
    """
    window = renderer.GetRenderWindow()
    if window is None:
        raise Error("renderer: found no window, expected one (renderWindow.AddRenderer(renderer))")
    window.Render()  # the framebuffer exists only after a first picture
    rgb = _floats(renderer, window) if precise else _codes(renderer, window)
    wrong = np.count_nonzero(~np.isfinite(rgb).all(axis=2))
    if wrong:
        raise Error(f"VTK's picture has {wrong} pixels with NaN or infinity, expected none; precise=False takes its "
                    "codes")
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
    """Draws with a float32 texture in place of the window's colour buffer."""
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
        rgb = _float_pixels(renderer, window)
        if _are_codes(rgb) and not _keeps_halves(renderer, window):
            raise Error("window: VTK's picture came in 8 bits, expected float32; precise=False takes codes")
    finally:
        framebuffer.Bind()
        framebuffer.AddColorAttachment(0, own)
    return rgb


def _float_pixels(renderer: Any, window: Any) -> np.ndarray:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkFloatArray
    pixels = vtkFloatArray()
    window.GetRGBAPixelData(*_corners(renderer), 0, pixels)
    width, height = renderer.GetSize()
    return np.asarray(vtk_to_numpy(pixels)).reshape(height, width, 4)[:, :, :3]


def _are_codes(rgb: np.ndarray) -> bool:
    """Tells whether all values are whole codes / 255. A thousandth of a code is more than float32 rounds."""
    return bool(np.abs(rgb * 255 - np.round(rgb * 255)).max() < 1e-3)


def _keeps_halves(renderer: Any, window: Any) -> bool:
    """Tells whether a background between two codes comes back as such.

    VTK's render passes may draw in 8 bits and copy the result into the float32 texture. A picture of codes alone does
    not show whether they did: an opaque red volume on black has only the codes 0 and 255 in float32, too.
    """
    collection, background = renderer.GetViewProps(), renderer.GetBackground()
    props = [collection.GetItemAsObject(i) for i in range(collection.GetNumberOfItems())]
    visible = [prop for prop in props if prop.GetVisibility()]
    try:
        for prop in visible:
            prop.VisibilityOff()
        renderer.SetBackground(*[100.5 / 255] * 3)
        window.Render()
        return not _are_codes(_float_pixels(renderer, window))
    finally:
        renderer.SetBackground(*background)
        for prop in visible:
            prop.VisibilityOn()
        window.Render()  # the window shows the picture again, and not the background alone
