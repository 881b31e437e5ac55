#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""reader_oracles.py FOLDER TOOL: with NumPy, nibabel, tifffile or VTK, writes volumes to FOLDER in every form that these
know, and to FOLDER/cases.json what each holds, by the tool itself. Exits with 77 where the tool is not installed.

A case: {file, request, type, size [x, y, z], steps (three vectors), origin, cell, values}; `values` names a file of
float64, x fastest: the values that are drawn.
"""
import json
import math
import os
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(77)

TYPES = ["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64"]


def drawn_type(array):
    """The smallest type that draws integers; the others stay or become float."""
    if array.dtype in (np.uint8, np.int16, np.uint16):
        return str(array.dtype)
    if array.dtype == np.int8:
        return "int16"
    if array.dtype.kind not in "iu":
        return "float"
    lo, hi = int(array.min()), int(array.max())
    for name in ("uint8", "int16", "uint16"):
        if lo >= np.iinfo(name).min and hi <= np.iinfo(name).max:
            return name
    return "float"


def values_of(dtype, shape, seed=1):
    """Numbers over much of the type's range, with NaN among floats; [z, y, x]."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(dtype)
    if dtype.kind in "iu":
        info = np.iinfo(dtype)
        array = rng.integers(info.min, info.max, size=shape, dtype=dtype, endpoint=True)
        array.flat[0], array.flat[1] = info.min, info.max
        return array
    array = rng.normal(size=shape).astype(dtype) * dtype.type(1e3)
    array.flat[2] = np.nan
    array.flat[3] = -np.inf
    return array


class Cases:
    def __init__(self, folder):
        self.folder = folder
        self.cases = []

    def path(self, name):
        return os.path.join(self.folder, name)

    def add(self, name, stored, steps=((1, 0, 0), (0, 1, 0), (0, 0, 1)), origin=(0, 0, 0), cell=False, drawn=None,
            warnings=None, lps=None, **request):
        """`stored`: [z, y, x], as stored; `drawn`: the type where it does not follow from that."""
        kind = drawn or drawn_type(stored)
        values = stored.astype(np.float32) if kind == "float" else stored
        number = len(self.cases)
        np.ascontiguousarray(values, dtype="<f8").tofile(self.path(f"values{number}.raw"))
        self.cases.append({
            "file": name, "request": request, "type": kind, "size": list(stored.shape[::-1]),
            "steps": np.asarray(steps, float).tolist(), "origin": np.asarray(origin, float).tolist(), "cell": cell,
            "values": f"values{number}.raw", "warnings": warnings, "lps": lps})

    def write(self):
        with open(self.path("cases.json"), "w", encoding="utf-8") as file:
            json.dump(self.cases, file)


def rotation(a, b, c):
    """Of three angles about z, y, x."""
    def turn(i, j, angle):
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = math.cos(angle)
        matrix[i, j], matrix[j, i] = -math.sin(angle), math.sin(angle)
        return matrix
    return turn(0, 1, a) @ turn(0, 2, b) @ turn(1, 2, c)


def numpy_files(cases):
    for name in TYPES:
        array = values_of(name, (4, 5, 6))
        for order in "<>":
            for fortran in (False, True):
                file = f"{name}{'le' if order == '<' else 'be'}{'f' if fortran else 'c'}.npy"
                stored = array.astype(array.dtype.newbyteorder(order))
                np.save(cases.path(file), np.asfortranarray(stored) if fortran else stored)
                cases.add(file, array)
        # What the type promises is more than what is there.
        few = np.arange(120).reshape(4, 5, 6).astype(name)
        np.save(cases.path(f"few_{name}.npy"), few)
        cases.add(f"few_{name}.npy", few)
    truth = values_of("uint8", (3, 4, 5)) > 100
    np.save(cases.path("bool.npy"), truth)
    cases.add("bool.npy", truth.astype(np.uint8))
    for name in TYPES:  # raw files
        for order in "<>":
            array = values_of(name, (3, 4, 7), seed=2)
            file = f"{name}{'le' if order == '<' else 'be'}.bin"
            with open(cases.path(file), "wb") as out:
                out.write(b"0123456")
                out.write(array.astype(array.dtype.newbyteorder(order)).tobytes())
            kind = {"float32": "float", "float64": "double"}.get(name, name)
            cases.add(file, array, steps=np.diag([.5, 1.5, 2]), origin=(1, 2, 3),
                      raw=[7, 4, 3, kind, 7, order == ">"], spacing=[.5, 1.5, 2], where=[1, 2, 3])
    # Headers as ITK's writer makes them, which is not here; data by NumPy.
    metaimage_files(cases)


def metaimage_files(cases):
    turn = rotation(.3, -.2, .5)
    mirrored = turn @ np.diag([1, 1, -1])
    spacing = np.array([.5, .75, 2])

    def header(array, kind, matrix, more, data_file, dims=None):
        dims = dims or array.shape[::-1]
        n = len(dims)
        full = np.eye(n)
        full[:3, :3] = matrix.T  # rows are axes
        place = [10, -20, 30.5] + [0] * (n - 3)
        return ("ObjectType = Image\n" + f"NDims = {n}\nBinaryData = True\n" + more +
                "TransformMatrix = " + " ".join(repr(float(x)) for x in full.flat) + "\n" +
                "Offset = " + " ".join(map(str, place)) + "\nCenterOfRotation = " + "0 " * n + "\n" +
                "AnatomicalOrientation = RAI\n" +
                "ElementSpacing = " + " ".join(map(str, list(spacing) + [1] * (n - 3))) + "\n" +
                "DimSize = " + " ".join(map(str, dims)) + f"\nElementType = {kind}\nElementDataFile = {data_file}\n")

    import zlib
    for matrix, label in ((turn, "turned"), (mirrored, "mirrored")):
        steps = (matrix * spacing).T
        for big in (False, True):
            array = values_of("int16", (4, 5, 6), seed=3)
            data = array.astype(">i2" if big else "<i2").tobytes()
            order = f"BinaryDataByteOrderMSB = {big}\n"
            with open(cases.path(f"{label}{big}.mha"), "wb") as out:
                out.write(header(array, "MET_SHORT", matrix, order + "CompressedData = False\n", "LOCAL").encode() + data)
            cases.add(f"{label}{big}.mha", array, steps, (10, -20, 30.5))
            packed = zlib.compress(data)
            more = order + f"CompressedData = True\nCompressedDataSize = {len(packed)}\n"
            with open(cases.path(f"{label}{big}.mhd"), "w", encoding="ascii") as out:
                out.write(header(array, "MET_SHORT", matrix, more, f"{label}{big}.zraw"))
            with open(cases.path(f"{label}{big}.zraw"), "wb") as out:
                out.write(packed)
            cases.add(f"{label}{big}.mhd", array, steps, (10, -20, 30.5))
    steps = (turn * spacing).T
    place = (10, -20, 30.5)
    array = values_of("float32", (3, 4, 5, 6), seed=4)  # times
    with open(cases.path("times.mha"), "wb") as out:
        out.write(header(array, "MET_FLOAT", turn, "", "LOCAL").encode() + array.tobytes())
    cases.add("times.mha", array[0], steps, place, warnings=["time 0 of 3 is taken"])
    cases.add("times.mha", array[2], steps, place, time=2)
    colors = values_of("uint8", (4, 5, 6, 3), seed=5)
    with open(cases.path("colors.mha"), "wb") as out:
        out.write(header(colors, "MET_UCHAR_ARRAY", turn, "ElementNumberOfChannels = 3\n", "LOCAL",
                         dims=(6, 5, 4)).encode() + colors.tobytes())
    cases.add("colors.mha", colors[..., 0], steps, place, warnings=["channel 0 of 3 is taken"])
    cases.add("colors.mha", colors[..., 2], steps, place, channel=2)
    slices = values_of("uint16", (4, 5, 6), seed=6)
    for z in range(4):
        with open(cases.path(f"slice{z + 2:03d}.raw"), "wb") as out:
            out.write(b"head" + slices[z].tobytes())
    for file, field in (("pattern.mhd", "slice%03d.raw 2 5 1"),
                        ("list.mhd", "LIST\n" + "".join(f"slice{z:03d}.raw\n" for z in (2, 3, 4, 5)))):
        with open(cases.path(file), "w", encoding="ascii") as out:
            out.write(header(slices, "MET_USHORT", turn, "HeaderSize = 4\n", field))
        cases.add(file, slices, steps, place)
    with open(cases.path("behind.mhd"), "w", encoding="ascii") as out:
        out.write(header(slices[1:2], "MET_USHORT", turn, "HeaderSize = -1\n", "slice003.raw"))
    cases.add("behind.mhd", slices[1:2], steps, place)


def to_lps(affine):
    """Steps and origin of a RAS affine, in LPS."""
    turned = np.diag([-1, -1, 1]) @ affine[:3]
    return turned[:, :3].T, turned[:, 3]


def nibabel_files(cases):
    import nibabel as nib
    oblique = np.eye(4)
    oblique[:3, :3] = rotation(.4, .1, -.7) @ np.diag([1.5, .75, 3])
    oblique[:3, 3] = -40, 25, 7
    mirrored = oblique @ np.diag([-1, 1, 1, 1])
    number = 0
    for make, name in ((nib.Nifti1Image, "one"), (nib.Nifti2Image, "two"), (nib.Nifti1Pair, "pair"),
                       (nib.Nifti2Pair, "pair2")):
        for kind in TYPES:
            for endian in "<>":
                for affine in (oblique, mirrored):
                    array = values_of(kind, (6, 5, 4), seed=number)  # [x, y, z]
                    header = make.header_class(endianness=endian)
                    header.set_data_dtype(array.dtype.newbyteorder(endian))
                    image = make(array, affine, header)
                    image.header.set_slope_inter(1, 0)
                    suffix = ".img" if "pair" in name else ".nii"
                    file = f"{name}{number}{suffix}{'.gz' if number % 3 == 0 else ''}"
                    number += 1
                    nib.save(image, cases.path(file))
                    back = nib.load(cases.path(file))
                    steps, origin = to_lps(back.affine)
                    stored = np.asanyarray(back.dataobj.get_unscaled()).T
                    cases.add(file, stored.astype(stored.dtype.newbyteorder("=")), steps, origin)
                    if "pair" in name:
                        other = file.replace(".img", ".hdr")
                        cases.add(other, stored.astype(stored.dtype.newbyteorder("=")), steps, origin)
    one_head(cases, nib, oblique)
    # qform alone, sform alone, both (sform counts), neither.
    array = values_of("uint8", (6, 5, 4), seed=99)
    for sform, qform, name in ((0, 1, "q"), (1, 0, "s"), (2, 1, "both"), (0, 0, "none")):
        for affine, hand in ((oblique, "right"), (mirrored, "left")):
            image = nib.Nifti1Image(array, None)
            image.header.set_zooms((1.5, .75, 3))
            if qform:
                image.header.set_qform(affine @ np.diag([1, 1, 1, 1]), qform)
            if sform:
                moved = affine.copy()
                moved[:3, 3] += 5
                image.header.set_sform(moved, sform)
            file = f"{name}_{hand}.nii"
            nib.save(nib.Nifti1Image(array, None, image.header), cases.path(file))
            header = nib.load(cases.path(file)).header
            if sform:
                steps, origin = to_lps(header.get_sform())
            elif qform:
                steps, origin = to_lps(header.get_qform())
            else:
                steps, origin = np.diag([1.5, .75, 3]), (0, 0, 0)
            cases.add(file, array.T, steps, origin, lps=bool(sform or qform))
    # Scaled samples, by the tool's own arithmetic in double precision.
    for slope, inter, drawn in ((2, -1024, "int16"), (.1, 3.5, "float"), (1, 70000, "float"), (-1, 255, "uint8")):
        array = np.arange(120, dtype=np.uint8).reshape(6, 5, 4)
        image = nib.Nifti1Image(array, oblique)
        image.header.set_slope_inter(slope, inter)
        file = f"scaled_{drawn}_{slope}.nii.gz"
        image.to_filename(cases.path(file))
        raw = bytearray(__import__("gzip").open(cases.path(file)).read())
        raw[112:120] = np.array([slope, inter], "<f4").tobytes()  # nibabel resets them when it writes
        raw[352:] = array.tobytes(order="F")
        with __import__("gzip").open(cases.path(file), "wb") as out:
            out.write(bytes(raw))
        back = nib.load(cases.path(file))
        steps, origin = to_lps(back.affine)
        cases.add(file, back.get_fdata().T, steps, origin, drawn=drawn)
    times = values_of("int16", (6, 5, 4, 3), seed=7)
    nib.save(nib.Nifti1Image(times, oblique), cases.path("times.nii.gz"))
    steps, origin = to_lps(nib.load(cases.path("times.nii.gz")).affine)
    cases.add("times.nii.gz", times[..., 0].T, steps, origin, warnings=["time 0 of 3 is taken"])
    cases.add("times.nii.gz", times[..., 2].T, steps, origin, time=2)
    vectors = values_of("float32", (6, 5, 4, 1, 3), seed=8)
    nib.save(nib.Nifti1Image(vectors, oblique), cases.path("vectors.nii"))
    cases.add("vectors.nii", vectors[..., 0, 1].T, steps, origin, channel=1)
    rgb = np.zeros((6, 5, 4), dtype=[("R", "u1"), ("G", "u1"), ("B", "u1")])
    for i, key in enumerate("RGB"):
        rgb[key] = values_of("uint8", (6, 5, 4), seed=20 + i)
    nib.save(nib.Nifti1Image(rgb, oblique), cases.path("rgb.nii"))
    cases.add("rgb.nii", rgb["G"].T, steps, origin, channel=1)


def one_head(cases, nib, affine):
    """The same samples at the same places, as NIfTI (RAS), NRRD and MetaImage (LPS)."""
    array = values_of("int16", (6, 5, 4), seed=50)
    nib.save(nib.Nifti1Image(array, affine), cases.path("head.nii.gz"))
    steps, origin = to_lps(nib.load(cases.path("head.nii.gz")).affine)
    lengths = np.linalg.norm(steps, axis=1)

    def text(vector):
        return ",".join(repr(float(x)) for x in vector)

    with open(cases.path("head.nrrd"), "wb") as out:
        out.write(("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 6 5 4\nspace directions: " +
                   " ".join(f"({text(step)})" for step in steps) + "\nendian: little\nencoding: raw\nspace origin: (" +
                   text(origin) + ")\n\n").encode() + array.tobytes(order="F"))
    with open(cases.path("head.mha"), "wb") as out:
        rows = (steps / lengths[:, None]).ravel()
        out.write(("ObjectType = Image\nNDims = 3\nTransformMatrix = " + text(rows).replace(",", " ") + "\nOffset = " +
                   text(origin).replace(",", " ") + "\nAnatomicalOrientation = RAI\nElementSpacing = " +
                   text(lengths).replace(",", " ") + "\nDimSize = 6 5 4\nElementType = MET_SHORT\n" +
                   "ElementDataFile = LOCAL\n").encode() + array.tobytes(order="F"))
    for file in ("head.nii.gz", "head.nrrd", "head.mha"):
        cases.add(file, array.T, steps, origin, lps=True)


def tifffile_files(cases):
    import tifffile
    for kind in TYPES:
        for order in "<>":
            array = values_of(kind, (4, 35, 50), seed=1)
            for label, options in (("strips", {}), ("rows", {"rowsperstrip": 8}), ("tiles", {"tile": (16, 32)}),
                                   ("big", {"bigtiff": True}), ("zlib", {"compression": "zlib", "rowsperstrip": 7}),
                                   ("zlibtiles", {"compression": "zlib", "tile": (32, 16)}),
                                   ("lzma", {"compression": "lzma"})):
                bigtiff = options.get("bigtiff", False)
                rest = {key: value for key, value in options.items() if key != "bigtiff"}
                file = f"{kind}{'le' if order == '<' else 'be'}_{label}.tif"
                try:
                    with tifffile.TiffWriter(cases.path(file), byteorder=order, bigtiff=bigtiff) as out:
                        for page in array:
                            out.write(page, photometric="minisblack", metadata=None, contiguous=False, **rest)
                except (ImportError, ValueError, KeyError) as error:  # compressions of imagecodecs
                    print(f"{file}: {error}", file=sys.stderr)
                    os.remove(cases.path(file))
                    continue
                cases.add(file, tifffile.imread(cases.path(file)).astype(kind))
    rgb = values_of("uint16", (4, 20, 30, 3), seed=2)
    for planar, label in (("contig", "contig"), ("separate", "planar")):
        for tile in ({}, {"tile": (16, 16)}):
            file = f"rgb_{label}{len(tile)}.tif"
            with tifffile.TiffWriter(cases.path(file)) as out:
                for page in rgb:
                    stored = page if planar == "contig" else np.moveaxis(page, 2, 0)
                    out.write(stored, photometric="rgb", planarconfig=planar, metadata=None, contiguous=False, **tile)
            cases.add(file, rgb[..., 0], warnings=["channel 0 of 3 is taken"])
            cases.add(file, rgb[..., 2], channel=2)
    # ImageJ's hyperstack: times, slices, channels; pixels 0.25 wide and .5 high, slices 2 apart.
    stack = values_of("uint16", (3, 5, 2, 20, 30), seed=3)
    tifffile.imwrite(cases.path("imagej.tif"), stack, imagej=True, resolution=(4, 2),
                     metadata={"spacing": 2, "unit": "um", "axes": "TZCYX"})
    steps = np.diag([.25, .5, 2])
    cases.add("imagej.tif", stack[0, :, 0], steps, warnings=["channel 0 of 2 is taken", "time 0 of 3 is taken"])
    cases.add("imagej.tif", stack[2, :, 1], steps, channel=1, time=2)
    for axes in ("TCZYX", "ZCTYX"):
        shape = tuple({"T": 3, "C": 2, "Z": 5, "Y": 20, "X": 30}[axis] for axis in axes)
        stack = values_of("float32", shape, seed=4)
        file = f"{axes}.ome.tif"
        tifffile.imwrite(cases.path(file), stack, photometric="minisblack",
                         metadata={"axes": axes, "PhysicalSizeX": .25, "PhysicalSizeY": .5, "PhysicalSizeZ": 2.})
        index = {"T": 2, "C": 1}
        picked = stack[tuple(index.get(axis, slice(None)) for axis in axes)]
        cases.add(file, picked, steps, channel=1, time=2)
    os.makedirs(cases.path("folder"))
    pages = values_of("uint8", (12, 9, 8), seed=5)
    for z, page in enumerate(pages):
        tifffile.imwrite(cases.path(f"folder/slice_{z}.tif"), page)  # 10 comes after 9
    with open(cases.path("folder/notes.txt"), "w", encoding="ascii") as out:
        out.write("not a slice")
    cases.add("folder", pages)
    pillow_files(cases)


def pillow_files(cases):
    """Compressions of libtiff through Pillow, where it is there."""
    try:
        from PIL import Image
    except ImportError:
        return
    pages = values_of("uint8", (3, 40, 50), seed=6)
    for compression in ("raw", "tiff_lzw", "packbits", "tiff_deflate", "tiff_adobe_deflate", "lzma", "zstd"):
        file = f"pillow_{compression}.tif"
        images = [Image.fromarray(page) for page in pages]
        try:
            images[0].save(cases.path(file), save_all=True, append_images=images[1:], compression=compression)
        except (OSError, ValueError, KeyError, RuntimeError) as error:
            print(f"{file}: {error}", file=sys.stderr)
            if os.path.exists(cases.path(file)):
                os.remove(cases.path(file))
            continue
        cases.add(file, pages)


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


def main():
    folder, tool = sys.argv[1:]
    cases = Cases(folder)
    try:
        {"numpy": numpy_files, "nibabel": nibabel_files, "tifffile": tifffile_files, "vtk": vtk_files}[tool](cases)
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(77)
    cases.write()


main()
