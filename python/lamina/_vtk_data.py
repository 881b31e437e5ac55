# SPDX-License-Identifier: Apache-2.0
"""Data of VTK's volumes."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import Error
from ._mesh import Mesh
from ._volume import Volume

CROP_TO_BOX = 0x2000  # VTK_CROP_SUBVOLUME
TETRA = 10


def volume_of(renderer: Any) -> Any:
    """The only visible prop of a renderer: a vtkVolume."""
    if not hasattr(renderer, "GetViewProps"):
        raise TypeError(f"renderer: found {type(renderer).__name__}, expected a vtkRenderer")
    props = renderer.GetViewProps()
    visible = [prop for prop in (props.GetItemAsObject(i) for i in range(props.GetNumberOfItems()))
               if prop.GetVisibility() and not prop.IsA("vtkProp2D") and not prop.IsA("vtkActor2D")]
    volumes = [prop for prop in visible if prop.IsA("vtkVolume")]
    if len(volumes) != 1 or len(visible) != 1:
        names = ", ".join(prop.GetClassName() for prop in visible) or "none"
        raise Error(f"renderer: found the visible props {names}, expected one vtkVolume alone")
    if volumes[0].GetMapper() is None:
        raise Error("volume: found no mapper, expected one with data")
    return volumes[0]


def drawn_data(volume: Any) -> Volume | Mesh:
    """The volume or mesh that a vtkVolume draws."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import reference
    from vtkmodules.vtkRenderingCore import vtkAbstractMapper
    mapper = volume.GetMapper()
    if mapper.GetInputAlgorithm() is not None:
        mapper.GetInputAlgorithm().Update()
    data = mapper.GetDataSetInput()
    if data is None or not (data.IsA("vtkImageData") or data.IsA("vtkUnstructuredGrid")):
        found = "nothing" if data is None else data.GetClassName()
        raise Error(f"mapper: found {found}, expected vtkImageData or a vtkUnstructuredGrid of tets")
    blend = getattr(mapper, "GetBlendMode", lambda: 0)()
    if blend != 0:
        raise Error(f"mapper: found the blend mode {blend}, expected composite blending (0)")
    cells = reference(0)
    scalars = vtkAbstractMapper.GetScalars(data, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                                           mapper.GetArrayId(), mapper.GetArrayName(), cells)
    if scalars is None or int(cells) != 0:
        raise Error(f"mapper: found {'no scalars' if scalars is None else 'scalars of cells'}, expected one array of "
                    "scalars at points")
    if scalars.GetNumberOfComponents() != 1:
        raise Error(f"scalars: found {scalars.GetNumberOfComponents()} components, expected one")
    values, matrix = vtk_to_numpy(scalars), _affine(volume.GetMatrix())
    if data.IsA("vtkImageData"):
        return _image(data, values, matrix)
    return _tets(data, values, matrix, scalars.GetName() or "scalar")


def _affine(matrix: Any) -> np.ndarray:
    rows = np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])
    if tuple(rows[3]) != (0, 0, 0, 1):
        raise Error("volume: found a matrix with perspective, expected rotation, scale and translation")
    return rows


def scale_of(volume: Any) -> float:
    """Returns the factor by which the volume's matrix enlarges it."""
    factors = np.linalg.norm(_affine(volume.GetMatrix())[:3, :3], axis=0)
    if np.ptp(factors) > 1e-6 * factors.max():
        raise Error(f"volume: found a matrix that scales x, y and z by {', '.join(f'{f:g}' for f in factors)}, expected one "
                    "factor: VTK's opacity then depends on the direction")
    return float(factors[0])


def _image(image: Any, values: np.ndarray, matrix: np.ndarray) -> Volume:
    x, y, z = image.GetDimensions()
    directions = image.GetDirectionMatrix()
    axes = np.array([[directions.GetElement(row, column) for column in range(3)] for row in range(3)])
    steps = matrix[:3, :3] @ axes * image.GetSpacing()  # columns
    first = image.GetExtent()[::2]
    origin = matrix[:3, 3] + matrix[:3, :3] @ np.array(image.GetOrigin()) + steps @ np.array(first)
    spacing = np.linalg.norm(steps, axis=0)
    try:
        return Volume(values.reshape(z, y, x), spacing.tolist(), origin.tolist(), directions=(steps / spacing).T,
                      lookup="linear")
    except ValueError as error:
        raise Error(f"image data: {error}") from None


def _tets(grid: Any, values: np.ndarray, matrix: np.ndarray, name: str) -> Mesh:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    kinds = vtk_to_numpy(grid.GetCellTypesArray()) if grid.GetNumberOfCells() else np.array([])
    if not len(kinds) or (kinds != TETRA).any():
        others = sorted(set(kinds.tolist()) - {TETRA})
        raise Error(f"unstructured grid: found {f'cells of the types {others}' if others else 'no cells'}, expected "
                    f"tetrahedra ({TETRA}) alone: vtkDataSetTriangleFilter makes them")
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64)
    return Mesh(points @ matrix[:3, :3].T + matrix[:3, 3], corners, {name: values})


def clip_keys(volume: Any) -> dict[str, Any]:
    """Returns clipping planes and a cropping box as a scene file has them."""
    mapper, keys = volume.GetMapper(), dict[str, Any]()
    planes = mapper.GetClippingPlanes()
    if planes is not None and planes.GetNumberOfItems():
        listed = [planes.GetItem(index) for index in range(planes.GetNumberOfItems())]
        keys["planes"] = [{"point": list(plane.GetOrigin()), "normal": list(plane.GetNormal())} for plane in listed]
    if getattr(mapper, "GetCropping", lambda: 0)():
        if mapper.GetCroppingRegionFlags() != CROP_TO_BOX or not np.array_equal(_affine(volume.GetMatrix()), np.eye(4)):
            raise Error("mapper: found cropping regions, expected the box in the middle (SetCroppingRegionFlagsToSubVolume) "
                        "of a volume that is not moved")
        planes = mapper.GetCroppingRegionPlanes()
        keys["box"] = {"min": list(planes[::2]), "max": list(planes[1::2])}
    return keys
