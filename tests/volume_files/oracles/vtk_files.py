# SPDX-License-Identifier: Apache-2.0
"""Image data in all forms of VTK, and TIFF files by it."""
import numpy as np

from .cases import TYPES, rotation, values_of


def vtk_files(cases):
    import vtkmodules.vtkCommonCore as core
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkTIFFWriter
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    def image_of(array, origin=(1, 2, 3), spacing=(.5, .75, 2), matrix=None, first=(0, 0, 0), of_cells=False, name="v"):
        image = vtkImageData()
        size = array.shape[2::-1]
        last = [first[i] + size[i] - (0 if of_cells else 1) for i in range(3)]
        image.SetExtent(first[0], last[0], first[1], last[1], first[2], last[2])
        image.SetOrigin(origin)
        image.SetSpacing(spacing)
        if matrix is not None:
            image.SetDirectionMatrix(*np.asarray(matrix).flat)
        components = array.shape[3] if array.ndim == 4 else 1
        values = numpy_to_vtk(np.ascontiguousarray(array).reshape(-1, components) if components > 1 else array.ravel(),
                              deep=True)
        values.SetName(name)
        (image.GetCellData() if of_cells else image.GetPointData()).SetScalars(values)
        return image

    def write(image, file, mode, compressor, big, header64):
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(cases.path(file))
        writer.SetInputData(image)
        {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary,
         "appended": writer.SetDataModeToAppended, "base64": writer.SetDataModeToAppended}[mode]()
        writer.SetEncodeAppendedData(mode == "base64")
        {"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib,
         "lz4": writer.SetCompressorTypeToLZ4, "lzma": writer.SetCompressorTypeToLZMA}[compressor]()
        (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
        (writer.SetHeaderTypeToUInt64 if header64 else writer.SetHeaderTypeToUInt32)()
        writer.Write()

    number = 0
    steps = np.diag([.5, .75, 2])
    for kind in TYPES:
        array = values_of(kind, (4, 5, 6), seed=1)
        for mode in ("ascii", "binary", "appended", "base64"):
            for compressor in ("none", "zlib", "lz4", "lzma"):
                if mode == "ascii" and (compressor != "none" or kind.startswith("float")):
                    continue  # numbers as text have fewer digits
                number += 1
                file = f"{kind}_{mode}_{compressor}.vti"
                write(image_of(array), file, mode, compressor, number % 2 == 0, number % 3 == 0)
                cases.add(file, array, steps, (1, 2, 3))
    array = values_of("int16", (4, 5, 6), seed=2)
    for turn, label in ((rotation(.3, .2, .1), "turned"), (rotation(.3, .2, .1) @ np.diag([1, -1, 1]), "mirrored")):
        for of_cells in (False, True):
            first = np.array((2, -1, 4))
            image = image_of(array, matrix=turn, first=first, of_cells=of_cells)
            file = f"{label}{of_cells}.vti"
            write(image, file, "appended", "zlib", False, True)
            world = (turn * (.5, .75, 2)).T
            origin = np.array((1, 2, 3)) + (first + (.5 if of_cells else 0)) @ world
            cases.add(file, array, world, origin, cell=of_cells)
    vectors = values_of("float32", (4, 5, 6, 3), seed=3)
    image = image_of(vectors, name="velocity")
    other = numpy_to_vtk(array.ravel(), deep=True)
    other.SetName("pressure")
    image.GetPointData().AddArray(other)
    write(image, "several.vti", "binary", "zlib", False, False)
    cases.add("several.vti", vectors[..., 0], steps, (1, 2, 3),
              warnings=['array "velocity" of 2 is taken', "channel 0 of 3 is taken"])
    cases.add("several.vti", vectors[..., 2], steps, (1, 2, 3), array="velocity", channel=2)
    cases.add("several.vti", array, steps, (1, 2, 3), array="pressure")

    for kind in TYPES[:6] + TYPES[8:]:
        for compressed in (False, True):
            array = values_of(kind, (4, 5, 6), seed=4)
            writer = vtkMetaImageWriter()
            suffix = "mha" if compressed else "mhd"
            writer.SetFileName(cases.path(f"{kind}.{suffix}"))
            if not compressed:
                writer.SetRAWFileName(cases.path(f"{kind}.raw"))
            writer.SetCompression(compressed)
            writer.SetInputData(image_of(array))
            writer.Write()
            cases.add(f"{kind}.{suffix}", array, steps, (1, 2, 3))
    for kind in ("uint8", "uint16", "float32"):
        for compression in ("NoCompression", "PackBits", "Deflate"):
            page = values_of(kind, (1, 30, 40), seed=5)
            writer = vtkTIFFWriter()
            writer.SetFileName(cases.path(f"{kind}_{compression}.tif"))
            getattr(writer, f"SetCompressionTo{compression}")()
            writer.SetInputData(image_of(page[:, ::-1]))  # VTK's rows run upwards
            writer.Write()
            cases.add(f"{kind}_{compression}.tif", page)
    del core
