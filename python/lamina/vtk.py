# SPDX-License-Identifier: Apache-2.0
"""VTK's scenes, and its pictures held against the truth (needs VTK 9, Debian's ``python3-vtk9``).

``scene(renderer)`` takes over a ``vtkRenderer`` with one volume; ``hold(renderer)`` draws it in VTK and in lamina and
says how they differ. What pyvista plots is VTK's: ``lamina.vtk.hold(plotter.renderer)``.

What is taken over as VTK means it:

- Colours are display values, and VTK composites them as they are: ``image.color_space`` is ``"display"``.
- Image data span their samples, with spacing, origin, direction and the volume's matrix. Opacity is linear between the
  function's points, over its unit distance, which is in the volume's own units: a matrix that scales it does so, too.
- Unstructured tets: their mappers take the opacity as an extinction, 1 - exp(-opacity * length / unit distance), linear
  between points and in world units. So does the scene.
- Parallel and perspective cameras, clipping planes, a cropping box, the viewport's size, one background colour.

What VTK does differently, and so is part of its difference: it takes steps along rays, reads colours and opacities from
tables, keeps the tables of tets and often the picture in 8 bits, sorts tets by their centres and interpolates them
without perspective. What lamina cannot draw as VTK means it is refused with ``lamina.Error``: shading, gradient opacity,
nearest neighbours, other blend modes, more than one component, cells that are no tets, further visible props.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import Error
from ._held import Held
from ._scene import Scene
from ._volume import Volume
from ._vtk_camera import camera_keys, check_clipping_range
from ._vtk_data import clip_keys, drawn_data, scale_of, volume_of
from ._vtk_functions import transfer_function_keys
from ._vtk_window import pixels_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .keywords import Keywords

__all__ = ["Held", "hold", "scene"]


def scene(renderer: Any) -> Scene:
    """The scene of a ``vtkRenderer`` with one visible volume: data, transfer functions, camera, size, background.

    The data are shared with VTK if they can be. Raises ``lamina.Error`` for what lamina does not draw as VTK means it.

    >>> import vtk                                                                         # doctest: +SKIP
    >>> lamina.render(lamina.vtk.scene(renderer)).save("as_vtk_means_it.png")              # doctest: +SKIP
    """
    volume = volume_of(renderer)
    data = drawn_data(volume)
    width, height = renderer.GetSize()
    if width < 1 or height < 1:
        raise Error("renderer: found no size, expected one in a window: renderWindow.SetSize(width, height)")
    if renderer.GetGradientBackground() or renderer.GetTexturedBackground():
        raise Error("renderer: found a background of several colours, expected one")
    # VTK's mappers of tets measure in world units.
    scale = scale_of(volume) if isinstance(data, Volume) else 1.0
    document = {"version": 1, "nan": "transparent", "camera": camera_keys(renderer),
                "transfer_function": transfer_function_keys(volume.GetProperty(), data, scale),
                "image": {"width": width, "height": height, "color_space": "display",
                          "background": list(renderer.GetBackground())}}
    clip = clip_keys(volume)
    if clip:
        document["clip"] = clip
    return Scene(document, data)


def hold(renderer: Any, *, precise: bool = True, **keywords: Unpack[Keywords]) -> Held:
    """Draws a renderer's volume in VTK and in lamina, and measures VTK's picture.

    ``precise``: VTK draws into float32, so that rounding to 8 bits is not counted against it; else its codes are taken as
    a window shows them. Other keywords change lamina's scene as for ``render`` (``trace={"tolerance": 1e-6}``).
    ``method``: ``"trace"`` if nothing is said, the truth; ``"slice"`` or ``"project"`` are quicker.

    The renderer's own window draws; without a display it can be an off-screen one.
    """
    from ._drawing import render, trace
    taken = scene(renderer)
    check_clipping_range(renderer, taken.data)
    pixels = pixels_of(renderer, precise)
    traced = (keywords.get("method") or "trace") == "trace"
    picture = trace(taken, **keywords) if traced else render(taken, **keywords)
    return Held(pixels, picture, tuple(renderer.GetBackground()))
