# SPDX-License-Identifier: Apache-2.0
"""npy files, and MetaImage files with the arrays of NumPy."""
import numpy as np

from .cases import TYPES, rotation, values_of


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
