# SPDX-License-Identifier: Apache-2.0
"""Keyword arguments with the names of scene files, and their types. Made from docs/scene.schema.json by tools/key_files."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence, TypedDict, Union

if TYPE_CHECKING:
    import numpy as np

    from ._camera import Camera
    from ._lighting import Light, Lighting
    from ._transfer_function import Color, TransferFunction

    Vector = Union[Sequence[float], np.ndarray]

# The keys of scene files that keyword arguments set.
KEYWORDS: dict[str, tuple[str, ...]] = {
    "volume": ("volume",),
    "mesh": ("mesh",),
    "scalar": ("scalar",),
    "nan": ("nan",),
    "camera": ("camera",),
    "clip": ("clip",),
    "lighting": ("lighting",),
    "width": ("image", "width"),
    "height": ("image", "height"),
    "color_space": ("image", "color_space"),
    "background": ("image", "background"),
    "transparent": ("image", "transparent"),
    "png_bits": ("image", "png_bits"),
    "annotations": ("image", "annotations"),
    "method": ("render", "method"),
    "target": ("render", "target"),
    "emulate": ("render", "emulate"),
    "max_error": ("render", "max_error"),
    "slice": ("render", "slice"),
    "project": ("render", "project"),
    "trace": ("render", "trace"),
}


class VolumeKeys(TypedDict, total=False):
    """Keys of ``volume``.

    - ``generate``
    - ``type``: Default: "uint8".
    - ``size``: Samples of a file without a header.
    - ``lookup``: Between samples: linear is trilinear; nearest is constant in each sample's voxel. If a file's
      samples are labels (docs/scene.md), nearest unless given. Default: "linear".
    - ``path``
    - ``array``: By its name; the first unless given.
    - ``level``: Of a pyramid. Default: 0.
    - ``channel``: Default: 0.
    - ``time``: Default: 0.
    - ``spacing``: In place of the file's.
    - ``origin``: The first sample, in place of the file's.
    - ``offset``: Bytes before the first sample. Default: 0.
    - ``endian``: Default: "little".
    """

    generate: Literal["ramp", "constant", "marschner-lobb", "gaussians", "sheets", "mixing"]
    type: Union[Literal["uint8", "uint16", "float"], Literal["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
                "uint64", "float", "double"]]
    size: Vector
    lookup: Literal["linear", "nearest"]
    path: Union[str, os.PathLike[str]]
    array: str
    level: int
    channel: int
    time: int
    spacing: Vector
    origin: Vector
    offset: int
    endian: Literal["little", "big"]


class MeshKeys(TypedDict, total=False):
    """Keys of ``mesh``.

    - ``path``
    - ``time``: Step of a .pvd, counted from 0 in the order of time. Default: 0.
    - ``join``: Points this near to an earlier one are moved to its place (world units). Default: 0.
    - ``tolerance``: Largest difference from the trilinear field, of the volume's range of values. Default: 0.02.
    - ``max_tets``: The making of the mesh stops at so many. Default: 5000000.
    - ``kuhn``: Every sample, six tets a cell. Default: false.
    """

    path: Union[str, os.PathLike[str]]
    time: int
    join: float
    tolerance: float
    max_tets: int
    kuhn: bool


class CameraKeys(TypedDict, total=False):
    """Keys of ``camera``.

    - ``projection``: Default: "perspective".
    - ``eye``
    - ``center``
    - ``up``: Default: [0, 1, 0].
    - ``fov_y``: Degrees, perspective. Default: 40.
    - ``height``: World units, orthographic (required there).
    """

    projection: Literal["perspective", "orthographic"]
    eye: Vector
    center: Vector
    up: Vector
    fov_y: float
    height: float


class ClipKeys(TypedDict, total=False):
    """Keys of ``clip``.

    - ``planes``
    - ``box``: World; min at most max on each axis.
    """

    planes: Sequence[ClipPlaneKeys]
    box: ClipBoxKeys


class ClipPlaneKeys(TypedDict, total=False):
    """Keys of ``clip.plane``.

    - ``point``: Of the plane, world.
    - ``normal``: Towards what is kept; any length but 0.
    """

    point: Vector
    normal: Vector


class ClipBoxKeys(TypedDict, total=False):
    """Keys of ``clip.box``.

    - ``min``
    - ``max``
    """

    min: Vector
    max: Vector


class LightingKeys(TypedDict, total=False):
    """Keys of ``lighting``.

    - ``ambient``: Default: 0.1.
    - ``diffuse``: Default: 0.7.
    - ``specular``: Default: 0.2.
    - ``power``: Of the specular highlight. Default: 10.
    - ``smallest_gradient``: In scalar units per world unit: what is less steep fades into the unlit picture. auto:
      .01 of the range of values over the smallest distance of samples (meshes: over the mean edge). Default: "auto".
    - ``lights``: Default: [{"direction": "headlight", "color": [1, 1, 1]}].
    """

    ambient: float
    diffuse: float
    specular: float
    power: float
    smallest_gradient: Union[Literal["auto"], float]
    lights: Sequence[Union[LightingLightKeys, Light]]


class LightingLightKeys(TypedDict, total=False):
    """Keys of ``lighting.light``.

    - ``direction``: Towards the light, in world space; headlight: towards the eye, along every ray. Default:
      "headlight".
    - ``color``: Components 0..1000. Default: [1, 1, 1].
    """

    direction: Union[Literal["headlight"], Vector]
    color: Color


class AnnotationsKeys(TypedDict, total=False):
    """Keys of ``annotations``.

    - ``colorbar``: The transfer function's colours and opacities. With "labels" beside it: the one that fits the
      data. Default: false.
    - ``labels``: A legend of the labels that show, by their names or numbers. Default: false.
    - ``scale_bar``: A length of the world; in perspective that of the plane through the camera's center. Default:
      false.
    - ``axes``: Arrows along the world's axes. Default: false.
    - ``box``: The edges of the data's box, with numbers. The volume does not hide them. Default: false.
    - ``title``: Above the picture's middle.
    - ``texts``: Further texts.
    """

    colorbar: Union[bool, AnnotationsColorbarKeys]
    labels: Union[bool, AnnotationsLabelsKeys]
    scale_bar: Union[bool, AnnotationsScaleBarKeys]
    axes: Union[bool, AnnotationsAxesKeys]
    box: Union[bool, AnnotationsBoxKeys]
    title: Union[str, AnnotationsTitleKeys]
    texts: Sequence[AnnotationsTextKeys]


class AnnotationsColorbarKeys(TypedDict, total=False):
    """Keys of ``annotations.colorbar``.

    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    - ``text``: Stands above; the data's name and unit if it is left out.
    - ``format``: Of numbers: one {}, {:.Nf}, {:.Ne} or {:.Ng} with text around it.
    """

    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float
    text: str
    format: str


class AnnotationsLabelsKeys(TypedDict, total=False):
    """Keys of ``annotations.labels``.

    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    - ``text``: Stands above; the data's name and unit if it is left out.
    """

    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float
    text: str


class AnnotationsScaleBarKeys(TypedDict, total=False):
    """Keys of ``annotations.scale_bar``.

    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    - ``format``: Of numbers: one {}, {:.Nf}, {:.Ne} or {:.Ng} with text around it.
    """

    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float
    format: str


class AnnotationsAxesKeys(TypedDict, total=False):
    """Keys of ``annotations.axes``.

    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    """

    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float


class AnnotationsBoxKeys(TypedDict, total=False):
    """Keys of ``annotations.box``.

    - ``size``: Factor on lines and numbers. Default: 1.
    - ``format``: Of numbers: one {}, {:.Nf}, {:.Ne} or {:.Ng} with text around it.
    """

    size: float
    format: str


class AnnotationsTitleKeys(TypedDict, total=False):
    """Keys of ``annotations.title``.

    - ``text``: Lines are parted by \n.
    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    """

    text: str
    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float


class AnnotationsTextKeys(TypedDict, total=False):
    """Keys of ``annotations.text``.

    - ``text``: Lines are parted by \n.
    - ``position``: A corner, or the middle of an edge; auto: each annotation has its own place. Default: "auto".
    - ``size``: Factor on the size, which follows the picture's height. Default: 1.
    """

    text: str
    position: Literal["auto", "top_left", "top", "top_right", "left", "right", "bottom_left", "bottom", "bottom_right"]
    size: float


class EmulateKeys(TypedDict, total=False):
    """Keys of ``emulate``.

    - ``bits``: Of a code. Default: 8.
    - ``alpha``: Default: "truncate".
    - ``over``: Default: "separate".
    - ``seed``: Default: 1.
    """

    bits: int
    alpha: Literal["truncate", "nearest", "stochastic"]
    over: Literal["separate", "fused"]
    seed: int


class SliceKeys(TypedDict, total=False):
    """Keys of ``slice``.

    - ``samples``: Slabs N, or auto: the fewest that keep render.max_error. Default: "auto".
    - ``classification``: Default: "auto".
    - ``order``: Default: "back_to_front".
    - ``filter``: Default: "exact".
    - ``dither``: Along depth, of the codes of fixed-point slabs.
    - ``tree``
    - ``table``: Pre-integration table; auto: the plan chooses it for the view.
    """

    samples: Union[Literal["auto"], int]
    classification: Literal["auto", "post", "preintegrated", "exact"]
    order: Literal["back_to_front", "front_to_back"]
    filter: Literal["exact", "hardware", "auto"]
    dither: SliceDitherKeys
    tree: Union[Literal["auto"], TreeKeys]
    table: Union[Literal["auto"], SliceTableKeys]


class SliceDitherKeys(TypedDict, total=False):
    """Keys of ``slice.dither``.

    - ``seed``: Default: 1.
    - ``color``: Default: false.
    - ``increment``: Between the two codes. Default: 1.
    - ``period``: Slabs after which the pattern repeats; auto: N. Default: 16.
    """

    seed: int
    color: bool
    increment: int
    period: Union[Literal["auto"], int]


class TreeKeys(TypedDict, total=False):
    """Keys of ``tree``.

    - ``factors``: Bifurcation factors from the root to the leaves.
    - ``nodes``: Default: "shader".
    - ``code``: Default: "minimax".
    - ``alpha_bits``: Default: 8.
    """

    factors: Union[Sequence[int], int, str]
    nodes: Literal["shader", "fixed"]
    code: Literal["minimax", "phi", "alpha"]
    alpha_bits: Literal[8, 16]


class SliceTableKeys(TypedDict, total=False):
    """Keys of ``slice.table``.

    - ``scalar``: Default: 256.
    - ``length``: Default: 1.
    - ``max_length``: Longest segment, world units. Default: 0.
    """

    scalar: int
    length: int
    max_length: float


class ProjectKeys(TypedDict, total=False):
    """Keys of ``project``.

    - ``coloring``: Default: "preintegrated".
    - ``interpolation``: Default: "perspective".
    - ``thickness``: Default: "exact".
    - ``order``: Default: "auto".
    - ``geometry``: Default: "auto".
    - ``dither``: Default: "none".
    - ``table``: Pre-integration table; auto: the cheapest that keeps its error under max_error / 2 and .5 / 255.
    - ``tree``: Of nodes fixed.
    """

    coloring: Literal["preintegrated", "attenuation", "vertex", "analytic"]
    interpolation: Literal["perspective", "linear"]
    thickness: Literal["exact", "dz"]
    order: Literal["auto", "mpvo", "exact", "centroid", "none"]
    geometry: Literal["auto", "silhouette", "triangles"]
    dither: Literal["none", "alpha", "after_blend"]
    table: Union[Literal["auto"], ProjectTableKeys]
    tree: Union[Literal["auto"], TreeKeys]


class ProjectTableKeys(TypedDict, total=False):
    """Keys of ``project.table``.

    - ``scalar``: Default: 256.
    - ``length``: Default: 16.
    - ``mapping``: Default: "octave".
    - ``store``: Default: "mean_extinction".
    - ``format``: Default: "fixed16".
    - ``construction``: Default: "exact".
    """

    scalar: int
    length: int
    mapping: Literal["octave", "log2", "linear"]
    store: Literal["mean_extinction", "opacity"]
    format: Literal["fixed16", "fixed8", "float16", "float32"]
    construction: Literal["exact", "incremental"]


class TraceKeys(TypedDict, total=False):
    """Keys of ``trace``.

    - ``of``: The volume if the scene has one.
    - ``tolerance``: Error bound, of full scale. Default: 1e-05.
    """

    of: Literal["volume", "mesh"]
    tolerance: float


class TransferFunctionKeys(TypedDict, total=False):
    """Keys of ``transfer_function``.

    - ``unit_length``: World length that opacity refers to. Default: 1.
    - ``interpolation``: linear: opacity between two points given by opacity, else extinction; extinction: extinction
      everywhere; nearest: the nearest point. Default: "linear".
    - ``codes``: Values are the codes of labels that do not fit 16 bits (docs/scene.md, "Labels"), in place of the
      file's numbers. Default: false.
    - ``codes_of``: Which labels the codes are of, as lamina writes it: a volume of others is refused.
    - ``colormap``: Path of a ParaView colour map (JSON preset), or the name of a shipped one: cividis, cool-warm,
      ct-angio, ct-bone, ct-lung, ct-soft-tissue, greys, inferno, viridis. Points then give no colour.
    - ``colormap_range``: Scalars that the map is stretched to; a shipped one else to the data's range, if it is not
      in HU.
    - ``points``: In order of value; two points at one value make a step.
    """

    unit_length: float
    interpolation: Literal["linear", "extinction", "nearest"]
    codes: bool
    codes_of: str
    colormap: Union[str, os.PathLike[str]]
    colormap_range: Vector
    points: Sequence[TransferFunctionPointKeys]


class TransferFunctionPointKeys(TypedDict, total=False):
    """Keys of ``transfer_function.point``.

    - ``value``
    - ``color``: Not associated. Default: [1, 1, 1].
    - ``extinction``: Per world unit.
    - ``smooth``: With extinction: the straight pieces on both sides stand for a smooth curve, which may be followed
      instead, within 1.3e-3 of their extinction. Default: false.
    - ``opacity``: Over unit_length; in place of extinction.
    """

    value: float
    color: Color
    extinction: float
    smooth: bool
    opacity: float


class Keywords(TypedDict, total=False):
    """Keywords of ``render``, ``trace`` and ``Session``: keys of the scene. One that is None is as if it were left out.

    - ``volume``: Path of a file or folder (relative to the scene; ${LAMINA_DATA} expands), with what of it is drawn,
      or a generated volume.
    - ``mesh``: Path of a mesh (.vtu, .pvtu, .pvd, legacy .vtk, TetGen .node with its .ele; relative to the scene;
      ${LAMINA_DATA} expands), or one made from the volume.
    - ``scalar``: Array of the mesh file, of points or (averaged to points) of cells; the first one of points if
      nothing is said.
    - ``nan``: What NaN and infinite values do: refuse the volume or mesh, or make the cells and tets around them
      transparent. Default: "error".
    - ``camera``: auto: chosen from the data (docs/first-picture.md). Default: "auto".
    - ``clip``: What is drawn of the data: what lies on the kept side of all planes and in the box. Words add planes:
      "x:10:" (from 10 on), "x::10" (up to 10), "x>10", "x<10".
    - ``lighting``: Emission is lit by the gradient of the scalar, on both of its sides; true: with all defaults;
      auto: if that shows surfaces of the data; absent or false: colours are shown as they are.
    - ``width``: Default: 800.
    - ``height``: Default: 600.
    - ``color_space``: What triples and colour maps are given in, and pictures composited in: linear light, or display
      values as VTK and ParaView do. Default: "linear".
    - ``background``: Default: [0, 0, 0].
    - ``transparent``: PNG files and films have straight alpha and no background. Default: false.
    - ``png_bits``: Of each code in PNG files. Default: 8.
    - ``annotations``: What is drawn beside the picture, in PNG files and on screens (docs/annotations.md).
    - ``method``: Left out: slice for scenes with a volume, project for others.
    - ``target``: Default: "float32".
    - ``emulate``: Fixed-point compositing step by step, for target emulated.
    - ``max_error``: Bound for what is automatic, in 1/255 of full scale. Default: 1.
    - ``slice``: Slices of a volume.
    - ``project``: Projected tetrahedra.
    - ``trace``: The reference tracer.
    - ``size``: (width, height) in pixels, in place of width and height.
    - ``set``: Any key, named by its path: {"render.slice.samples": 64}.
    - ``crop``: The box that is left, which an automatic camera then shows: ((x0, x1), (y0, y1), (z0, z1)) with None
      for open ends, or x0:x1,y0:y1,z0:z1.
    - ``up``: The axis that is up; the camera is chosen anew.
    - ``view``: The side that is seen; the camera is chosen anew.
    - ``azimuth``: Degrees by which the eye goes to the right around what shows.
    - ``elevation``: Degrees by which it goes up.
    - ``zoom``: Factor on the size of things in the picture.
    - ``light``: Lights; True is a headlight.
    - ``opacity``: How opacity grows over the values that show: linear, geom, sigmoid, sigmoid_1 to sigmoid_20,
      foreground, linear_r, geom_r; numbers from 0 to 1 spread evenly; or pairs (value, number).
    - ``preset``: Colours, opacity and light for a kind of data: ct-bone, ct-soft-tissue, ct-lung, ct-angio, mr,
      microscopy.
    - ``cmap``: Colours: a map's name or file, or a matplotlib colormap or its name.
    - ``clim``: (low, high): the values that show.
    - ``density``: Factor on the extinction.
    """

    volume: Union[str, os.PathLike[str], VolumeKeys, None]
    mesh: Union[str, os.PathLike[str], MeshKeys, None]
    scalar: Union[str, None]
    nan: Union[Literal["error", "transparent"], None]
    camera: Union[Literal["auto"], CameraKeys, Camera, None]
    clip: Union[ClipKeys, None, str, Sequence[str]]
    lighting: Union[Literal["auto"], LightingKeys, Lighting, bool, None]
    width: Union[int, None]
    height: Union[int, None]
    color_space: Union[Literal["linear", "display"], None]
    background: Union[Color, None]
    transparent: Union[bool, None]
    png_bits: Union[Literal[8, 16], None]
    annotations: Union[AnnotationsKeys, None]
    method: Union[Literal["slice", "project", "trace"], None]
    target: Union[Literal["float32", "float16", "fixed16", "fixed8", "emulated", "auto"], None]
    emulate: Union[EmulateKeys, None]
    max_error: Union[float, None]
    slice: Union[SliceKeys, None]
    project: Union[ProjectKeys, None]
    trace: Union[TraceKeys, None]
    size: Union[Vector, None]
    set: Union[Mapping[str, Any], None]
    crop: Union[str, Sequence[Any], None]
    up: Union[Literal["+x", "-x", "+y", "-y", "+z", "-z"], None]
    view: Union[Literal["iso", "front", "back", "left", "right", "top", "bottom"], None]
    azimuth: Union[float, None]
    elevation: Union[float, None]
    zoom: Union[float, None]
    light: Union[Literal[True, "headlight", "left", "right", "two"], None]
    opacity: Union[str, Sequence[Any], np.ndarray, None]
    preset: Union[str, None]
    cmap: Union[Any, None]
    clim: Union[Vector, None]
    density: Union[float, None]


class Changes(Keywords, total=False):
    """Keywords of ``Session.set``: those of ``render``, and the transfer function.

    - ``transfer_function``: As ``TransferFunction.to_scene()`` has it.
    """

    transfer_function: Union[Literal["auto"], TransferFunctionKeys, TransferFunction, None]
