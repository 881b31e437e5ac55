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
        # The type promises more than what is there.
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
    unnamed_axes(cases)
    archives(cases)
    # Headers as ITK's writer makes them, which is not here; data by NumPy.
    metaimage_files(cases)


def unnamed_axes(cases):
    """Axes of arrays have no names: [n, z, y, x], where 2 to 4 are channels and more are times; n behind x if that fits."""
    half = values_of("float32", (4, 5, 6), seed=11).astype(np.float16)
    half.flat[4:10] = [65504, -65504, 6e-8, -6e-5, np.inf, -0.]  # largest, subnormal, normal, special
    for order in "<>":
        for fortran in (False, True):
            file = f"half{'le' if order == '<' else 'be'}{'f' if fortran else 'c'}.npy"
            stored = half.astype(half.dtype.newbyteorder(order))
            np.save(cases.path(file), np.asfortranarray(stored) if fortran else stored)
            cases.add(file, half.astype(np.float32))
    for fortran in (False, True):
        order = np.asfortranarray if fortran else np.ascontiguousarray
        letter = "f" if fortran else "c"
        few, many = values_of("uint16", (3, 4, 5, 6), seed=12), values_of("int16", (7, 4, 5, 6), seed=13)
        last, five = values_of("uint8", (7, 5, 6, 3), seed=14), values_of("uint8", (2, 3, 4, 5, 6), seed=15)
        behind = values_of("uint8", (2, 7, 5, 6, 3), seed=16)
        for name, array in (("few", few), ("many", many), ("last", last), ("five", five), ("behind", behind)):
            np.save(cases.path(f"{name}_{letter}4.npy"), order(array))
        cases.add(f"few_{letter}4.npy", few[0], warnings=["the axis of 3 has no name and is taken for channels"])
        cases.add(f"few_{letter}4.npy", few[2], channel=2)
        cases.add(f"few_{letter}4.npy", few[1], time=1)
        cases.add(f"many_{letter}4.npy", many[0], warnings=["the axis of 7 has no name and is taken for times"])
        cases.add(f"many_{letter}4.npy", many[6], time=6)
        cases.add(f"many_{letter}4.npy", many[6], channel=6)
        cases.add(f"last_{letter}4.npy", last[..., 0], warnings=["taken for z, y, x and channel, because the last has 3"])
        cases.add(f"last_{letter}4.npy", last[..., 2], channel=2)
        cases.add(f"five_{letter}4.npy", five[0, 0], warnings=["taken for time, channel, z, y and x"])
        cases.add(f"five_{letter}4.npy", five[1, 2], time=1, channel=2)
        cases.add(f"behind_{letter}4.npy", behind[1, ..., 2], time=1, channel=2,
                  warnings=["taken for time, z, y, x and channel, because the last has 3 and the second 7"])
    cases.refuse("few_c4.npy", "channel: found 3, expected a whole number from 0 to 2", channel=3)
    for name, array, found in (("complex", np.zeros((2, 3, 4), "c8"), "'<c8'"), ("six", np.zeros((1,) * 6), "(1, 1, 1"),
                               ("object", np.array([[[None, 1]]], dtype=object), "'|O'")):
        np.save(cases.path(f"{name}.npy"), array, allow_pickle=True)
        cases.refuse(f"{name}.npy", "found " + found)
    for name, array, *words in (("complex", None, "complex numbers"), ("object", None, "Python objects"),
                                ("text", np.full((2, 3, 4), "ab"), "this is text"),
                                ("date", np.zeros((2, 3, 4), "M8[s]"), "dates and times"),
                                ("record", np.zeros((2, 3, 4), [("a", "f4"), ("b", "i2")]), "records", '["NAME"]'),
                                ("long", np.zeros((2, 3, 4), np.longdouble), 'array.astype("f8")')):
        if array is not None:
            np.save(cases.path(f"{name}.npy"), array)
        cases.refuse(f"{name}.npy", *words)


def archives(cases):
    """.npz: stored and deflated members, one array or several, damaged ones."""
    import zipfile
    a, b = values_of("float32", (4, 5, 6), seed=21), values_of("uint16", (3, 4, 5, 6), seed=22)
    for save, file in ((np.savez, "stored.npz"), (np.savez_compressed, "packed.npz")):
        save(cases.path(file), a=a, b=np.asfortranarray(b), spacing=[.5, 1, 2], half=a.astype(np.float16), big=a.astype(">f4"))
        cases.add(file, a, warnings=['array "a" of "a", "b", "big", "half", "spacing" is taken'])
        cases.add(file, a, array="big")
        cases.add(file, b[1], array="b", channel=1)
        cases.add(file, a.astype(np.float16).astype(np.float32), array="half.npy")
        cases.refuse(file, 'array: found "c", expected one of "a", "b", "big", "half", "spacing"', array="c")
        cases.refuse(file, "spacing.npy: NPY header, 'shape': found (3,)", array="spacing")
        with open(cases.path(file), "rb") as stored:
            data = bytearray(stored.read())
        data[300] ^= 16  # in the samples of "a"
        with open(cases.path("damaged_" + file), "wb") as out:
            out.write(data)
        cases.refuse("damaged_" + file, "a.npy: damaged", array="a")
        with open(cases.path("cut_" + file), "wb") as out:
            out.write(data[:-100])
        cases.refuse("cut_" + file, "damaged or truncated ZIP archive")
    with zipfile.ZipFile(cases.path("wide.npz"), "w", zipfile.ZIP_DEFLATED) as out:
        with out.open("x.npy", "w", force_zip64=True) as member:
            np.lib.format.write_array(member, b)
    cases.add("wide.npz", b[2], channel=2)
    for method, label in ((zipfile.ZIP_BZIP2, "method 12"), (zipfile.ZIP_LZMA, "method 14")):
        with zipfile.ZipFile(cases.path(f"code{method}.npz"), "w", method) as out:
            out.write(cases.path("few_c4.npy"), "x.npy")
        cases.refuse(f"code{method}.npz", "x.npy: compressed by ZIP's " + label)
    with open(cases.path("stored.npz"), "rb") as stored:
        data = bytearray(stored.read())
    at = data.find(b"PK\1\2")
    data[at + 8] |= 1
    with open(cases.path("secret.npz"), "wb") as out:
        out.write(data)
    cases.refuse("secret.npz", "a.npy: encrypted", array="a")
    np.savez(cases.path("flat.npz"), a=np.zeros((3, 4)))
    cases.refuse("flat.npz", "found no array of three axes or more")


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
