# SPDX-License-Identifier: Apache-2.0
"""HDF5 files whose attributes say what arrays are, as ilastik, xarray, NeXus, MATLAB and PyTables write them, by h5py;
those with layouts of their own (hdf5_layouts.py); and classic NetCDF, by SciPy (CDF-1, CDF-2) and by its specification
(CDF-5)."""
import json
import os
import struct

import numpy as np

from .cases import SHAPE, diagonal, ramp
from .hdf5_layouts import big_data_viewer, geometries, imaris, itk, vtk_images

def hdf5_files(cases):
    import h5py

    def add(file, stored, steps=None, origin=(0, 0, 0), unit="", contents=None, **more):
        cases.add(file, stored, np.eye(3) if steps is None else steps, origin, **more)
        cases.cases[-1].update({"unit": unit, "contents": contents or {}})

    def bad(file, *words, **request):
        cases.cases.append({"file": file, "request": request, "error": list(words)})

    def write(file, array, attributes=None, name="v", **how):
        with h5py.File(cases.path(file), "w") as out:
            data = out.create_dataset(name, data=array, **how)
            for key, value in (attributes or {}).items():
                data.attrs[key] = value

    for part in (labels, lengths, geometries, packed, others, imaris, big_data_viewer, vtk_images, itk, linked, refused):
        part(h5py, cases, write, add, bad)
    classic(cases, add, bad)


def labels(h5py, cases, write, add, bad):
    """Every order of labelled axes gives the same volume; channels and times are where the labels say."""
    array = ramp()

    def tags(word, resolution=0):
        return json.dumps({"axes": [{"key": letter, "typeFlags": 2, "resolution": resolution, "description": ""}
                                    for letter in word]})
    for word in ("zyx", "xyz", "yzx", "zxy", "xzy", "yxz"):
        turned = np.transpose(array, ["zyx".index(letter) for letter in word])
        write(f"tags_{word}.h5", turned, {"axistags": tags(word, .5)}, chunks=(2, 3, 2))
        add(f"tags_{word}.h5", array, diagonal(.5, .5, .5))
        write(f"names_{word}.h5", turned, {"_ARRAY_DIMENSIONS": list(word.upper())})
        add(f"names_{word}.h5", array)
        write(f"axes_{word}.h5", turned, {"axes": word})
        add(f"axes_{word}.h5", array)
        with h5py.File(cases.path(f"labels_{word}.h5"), "w") as file:
            file["v"] = turned
            for axis, letter in enumerate(word):
                file["v"].dims[axis].label = letter
        add(f"labels_{word}.h5", array)
    partly = json.loads(tags("zyx"))
    for axis, resolution in zip(partly["axes"], (0, .7, .9)):
        axis["resolution"] = resolution
    write("tags_partly.h5", array, {"axistags": json.dumps(partly)})
    add("tags_partly.h5", array, diagonal(.9, .7, 1), warnings=["axistags: the resolution 0 of z is unknown: 1 is taken"])
    five = ramp("<u2", (2, 4, 5, 6, 3))  # t z y x c
    for word in ("tzyxc", "xyzct", "tczyx", "cxtzy"):
        write(f"five_{word}.h5", np.transpose(five, ["tzyxc".index(letter) for letter in word]),
              {"axistags": tags(word)})
        add(f"five_{word}.h5", five[1, ..., 2], time=1, channel=2, contents={"channels": ["", "", ""],
                                                                              "times": ["", ""]})
        add(f"five_{word}.h5", five[0, ..., 1], channel=1, warnings=["time 0 of 2 is taken"])
    write("last.h5", array[..., None], {"axistags": tags("zyxc")})
    add("last.h5", array)
    write("component.h5", array[..., None])
    add("component.h5", array)
    write("unnamed.h5", ramp("<u2", (3, *SHAPE)))
    add("unnamed.h5", ramp("<u2", (3, *SHAPE))[0], warnings=["the axis of 3 has no name and is taken for channels"])
    add("unnamed.h5", ramp("<u2", (3, *SHAPE))[2], channel=2)
    add("unnamed.h5", ramp("<u2", (3, *SHAPE))[1], time=1)
    write("many.h5", ramp("<u2", (7, *SHAPE)))
    add("many.h5", ramp("<u2", (7, *SHAPE))[0], warnings=["the axis of 7 has no name and is taken for times"])
    # "height" is y in images, z in the atmosphere.
    movie = ramp("<u2", (7, 5, 6))
    for word in ("time", "frame", "batch"):
        write(f"{word}.h5", movie, {"_ARRAY_DIMENSIONS": [word, "height", "width"]})
        add(f"{word}.h5", movie[3:4], time=3)
        add(f"{word}.h5", movie[:1], warnings=["time 0 of 7 is taken"])
    picture = ramp("<u2", (5, 6, 3))
    write("picture.h5", picture, {"_ARRAY_DIMENSIONS": ["height", "width", "channel"]})
    add("picture.h5", picture[None, ..., 2], channel=2)
    for word in ("depth", "slice", "z", "lev", "plane"):
        write(f"height_{word}.h5", array.transpose(1, 2, 0), {"_ARRAY_DIMENSIONS": ["height", "width", word]})
        add(f"height_{word}.h5", array)
    batch = ramp("<u2", (7, 3, 5, 6))
    write("batch_four.h5", batch, {"_ARRAY_DIMENSIONS": ["batch", "channel", "height", "width"]})
    add("batch_four.h5", batch[4:5, 1], time=4, channel=1)
    for word, others in (("lat", ["lat", "lon"]), ("y", ["y", "x"]), ("rows", ["rows", "columns"])):
        write(f"air_{word}.h5", array, {"_ARRAY_DIMENSIONS": ["height", *others]})
        add(f"air_{word}.h5", array)
    # Numbers that tell axes of one word apart.
    write("numbered.h5", array.transpose(2, 1, 0), {"_ARRAY_DIMENSIONS": ["x1", "x2", "x3"]})
    add("numbered.h5", array)
    write("one_number.h5", array.transpose(2, 1, 0), {"_ARRAY_DIMENSIONS": ["x1", "y1", "z1"]})
    add("one_number.h5", array)
    write("levels.h5", array, {"_ARRAY_DIMENSIONS": ["lat1", "lat2", "lat3"]})
    add("levels.h5", array, warnings=["\"lat3\" of 6 is taken for x", "\"lat2\" of 5 is taken for y",
                                      "\"lat1\" of 4 is taken for z"])
    colours = ramp("<u2", (7, 5, 6, 3))
    write("colours.h5", colours)
    add("colours.h5", colours[..., 0], warnings=["z, y, x and channel, because the last has 3", "channel 0 of 3 is taken"])
    add("colours.h5", colours[..., 2], channel=2, warnings=["because the last has 3: \"time\" in the volume takes the first"],
        contents={"channels": ["", "", ""]})
    add("colours.h5", colours[4], time=4)
    write("both_few.h5", colours[:2])
    add("both_few.h5", colours[1], channel=1)
    write("tags_bad.h5", array, {"axistags": tags("zyxc")})
    bad("tags_bad.h5", "axistags", "3 times a \"key\"")
    write("six.h5", np.zeros((2, 2, 2, *SHAPE), "u1"))
    bad("six.h5", "no meaning of it")

    # CF: longitude, latitude, level and time by attributes; other orders; units that differ.
    with h5py.File(cases.path("cf.nc"), "w") as file:
        file.attrs["_NCProperties"] = "version=2,netcdf=4.9.0"
        order = (("d0", {"axis": "X", "units": "degrees_east"}, np.arange(6) * .5),
                 ("d1", {"units": "hours since 2000-01-01"}, [0, 6]),
                 ("d2", {"positive": "up", "units": "m"}, np.arange(4) * 10. + 5),
                 ("d3", {"standard_name": "latitude"}, 50 - np.arange(5.)))
        data = np.stack([array, array + 1000]).astype("f4")  # time z y x
        data[0, 0, 0, 0] = 9.969209968386869e36
        file["v"] = np.transpose(data, (3, 0, 1, 2))
        file["v"].attrs["units"] = "K"
        for axis, (name, attributes, numbers) in enumerate(order):
            file[name] = np.asarray(numbers, "f8")
            file[name].attrs.update(attributes)
            file[name].make_scale(name)
            file["v"].dims[axis].attach_scale(file[name])
    first = array.astype("f4")
    first[0, 0, 0] = np.nan
    add("cf.nc", first, diagonal(.5, -1, 10), (0, 50, 5), "degrees_east", time=0,
        contents={"times": ["0 hours since 2000-01-01", "6 hours since 2000-01-01"]},
        warnings=["1 samples are NaN", "have the units degrees_east, none, m"])
    add("cf.nc", array + 1000., diagonal(.5, -1, 10), (0, 50, 5), "degrees_east", time=1)
    with h5py.File(cases.path("nexus.h5"), "w") as file:
        group = file.create_group("entry/data")
        group["counts"] = array.transpose(2, 1, 0)
        group.attrs.update({"signal": "counts", "axes": ["x", "y", "z"]})
        for name, count, step, unit in (("x", 6, .5, "mm"), ("y", 5, 250, "um"), ("z", 4, .002, "m")):
            group[name] = np.arange(count) * step
            group[name].attrs["units"] = unit
    add("nexus.h5", array, diagonal(.5, .25, 2), unit="mm")
    # LZF: runs, repetitions near and far, chunks that it does not make smaller, and damaged ones.
    long = (np.arange(64 * 65 * 66) // 37 % 300 + 1000 * (np.arange(64 * 65 * 66) % 1979 == 0)).astype("<i2")
    noise = np.random.default_rng(5).integers(-30000, 30000, (8, 9, 10)).astype("<i2")
    long = long.reshape(64, 65, 66)
    for file, values, how in (("lzf", long, {}), ("lzf_shuffle", long, {"shuffle": True}), ("lzf_noise", noise, {}),
                              ("lzf_zeros", noise * 0, {"chunks": (5, 4, 7)})):
        write(f"{file}.h5", values, compression="lzf", **how)
        add(f"{file}.h5", values)
    stored = bytearray(open(cases.path("lzf_zeros.h5"), "rb").read())
    with h5py.File(cases.path("lzf_zeros.h5")) as file:
        place = file["v"].id.get_chunk_info(0).byte_offset
    stored[place + 1:place + 4] = b"\xff\xff\xff"
    open(cases.path("lzf_damaged.h5"), "wb").write(stored)
    bad("lzf_damaged.h5", "lzf_damaged.h5:/v")
    # A chunk that ends early, and a filter that promises chunks of another size.
    with h5py.File(cases.path("lzf_short.h5"), "w") as file:
        file.create_dataset("v", shape=SHAPE, chunks=SHAPE, dtype="<i2", compression="lzf")
        file["v"].id.write_direct_chunk((0, 0, 0), b"\x03\1\2\3\4")
    bad("lzf_short.h5", "lzf_short.h5:/v")
    stored = open(cases.path("lzf_short.h5"), "rb").read()
    promise = 2 * int(np.prod(SHAPE))
    assert stored.count(promise.to_bytes(4, "little")) == 1
    changed = stored.replace(promise.to_bytes(4, "little"), (8).to_bytes(4, "little"))
    open(cases.path("lzf_promise.h5"), "wb").write(changed)
    bad("lzf_promise.h5", f"LZF: found chunks of 8 bytes, expected {promise}")
    with h5py.File(cases.path("shuffled.h5"), "w") as file:
        how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        how.set_chunk(SHAPE)
        how.set_filter(32008, h5py.h5z.FLAG_OPTIONAL, (0, 0, 0, 0, 2))
        data = h5py.h5d.create(file.id, b"v", h5py.h5t.NATIVE_INT16, h5py.h5s.create_simple(SHAPE), how)
        data.write_direct_chunk((0, 0, 0), b"x" * 100)
    bad("shuffled.h5", "found the filter 32008 (bitshuffle)", "h5repack", "hdf5plugin")
    with h5py.File(cases.path("signal.nxs"), "w") as file:
        for word in ("counts", "errors"):
            file[f"entry/data/{word}"] = array + (word == "errors")
        file["entry/data"].attrs["signal"] = "counts"
    add("signal.nxs", array, warnings=["array /entry/data/counts of 2 is taken, the signal of its group (NeXus)"],
        contents={"arrays": ["/entry/data/counts", "/entry/data/errors"]})
    add("signal.nxs", array + 1, array="/entry/data/errors")
    # gridUnitSI is a word for mm, or makes metres; values lie in the middles of cells along x.
    for file, unit, length, word in (("openpmd", 1e-3, 1, "mm"), ("openpmd_metres", 2, 2, "m")):
        with h5py.File(cases.path(f"{file}.h5"), "w") as out:
            out.attrs["openPMD"] = "1.1.0"
            out["data/100/meshes/rho"] = array
            out["data/100/meshes/rho"].attrs.update({
                "axisLabels": [b"z", b"y", b"x"], "gridSpacing": [2.5, .75, .5], "gridGlobalOffset": [3., 2., 1.],
                "gridUnitSI": unit, "unitSI": 4., "position": [0., 0., .5]})
        add(f"{file}.h5", array, diagonal(.5, .75, 2.5) * length, (1.25 * length, 2 * length, 3 * length), word,
            warnings=["unitSI 4: values are as they are stored"])
    with h5py.File(cases.path("a.emd"), "w") as file:
        group = file.create_group("data/raw")
        group.attrs["emd_group_type"] = 1
        group["data"] = array.transpose(2, 1, 0)
        for i, (word, count, step) in enumerate((("x", 6, .9), ("y", 5, .7), ("z", 4, 2.5))):
            group[f"dim{i + 1}"] = np.arange(count) * step
            group[f"dim{i + 1}"].attrs.update({"name": word, "units": "[n_m]"})
    add("a.emd", array, diagonal(.9, .7, 2.5), unit="[n_m]")
    with h5py.File(cases.path("nearly.h5"), "w") as file:
        file["v"] = array
        file["z"] = [0., 1.03, 1.98, 3]
        file["z"].make_scale("z")
        file["v"].dims[0].attach_scale(file["z"])
    add("nearly.h5", array, warnings=["of z are taken as equally spaced", "by up to 0.03 of their distance"])
    with h5py.File(cases.path("uneven.h5"), "w") as file:
        file["v"] = array
        file["z"] = [0., 1, 3, 4]
        file["z"].make_scale("z")
        file["v"].dims[0].attach_scale(file["z"])
    add("uneven.h5", array, warnings=["the coordinates of z are not equally spaced"])


def lengths(h5py, cases, write, add, bad):
    """Distances and places under the names of several programs, in the order of the array's axes."""
    array = ramp()
    steps = diagonal(.9, .7, 2.5)
    for key, unit in (("element_size_um", "um"), ("resolution", ""), ("voxel_size", ""), ("spacing", ""),
                      ("pixelSize", ""), ("VoxelSize", ""), ("voxel_size_nm", "nm")):
        write("length.h5", array, {key: [2.5, .7, .9]})
        os.rename(cases.path("length.h5"), cases.path(f"length_{key}.h5"))
        add(f"length_{key}.h5", array, steps, unit=unit,
            warnings=[] if key == "element_size_um" else [f"{key} (2.5, 0.7, 0.9) is taken in the order of"])
    write("offset.h5", array.transpose(2, 1, 0), {"axes": "xyz", "resolution": [.9, .7, 2.5], "offset": [1., 2., 3.],
                                                  "resolution_unit": "nm"})
    add("offset.h5", array, steps, (1, 2, 3), unit="nm")
    # A slice is as thick as the shorter side of a pixel, or as three numbers say.
    for number, (given, spacing) in enumerate((([.7, .9], (.9, .7, .7)), ([2.5, .7, .9], (.9, .7, 2.5)))):
        write(f"flat{number}.h5", array[0], {"element_size_um": given})
        add(f"flat{number}.h5", array[:1], diagonal(*spacing), unit="um", array="/v")
    write("one.h5", array, {"voxel_size": .25})
    add("one.h5", array, diagonal(.25, .25, .25))
    write("zero.h5", array, {"resolution": [0., 1, 1]})
    add("zero.h5", array, warnings=["resolution: found 0, 1, 1", "it is not used"])
    with h5py.File(cases.path("parent.h5"), "w") as file:
        file["volumes/raw"] = array
        file["volumes"].attrs["element_size_um"] = [2.5, .7, .9]
        file.attrs["origin"] = [3., 2., 1.]
    add("parent.h5", array, steps, (1, 2, 3), unit="um")


def packed(h5py, cases, write, add, bad):
    """scale_factor, fill values, valid ranges, _Unsigned."""
    array = ramp()
    array[0, 0, 1] = -32768
    want = array * .5 + 10
    want[0, 0, 1] = np.nan
    write("packed.nc", array, {"scale_factor": .5, "add_offset": 10., "_FillValue": np.int16(-32768)})
    add("packed.nc", want, drawn="float", warnings=["1 samples are NaN: the file calls them missing (_FillValue -32768)"])
    want = array.astype("f4")
    want[(array < 10) | (array > 900)] = np.nan
    write("range.nc", array, {"valid_range": np.array([10, 900], "i2")}, chunks=(2, 2, 2))
    add("range.nc", want, drawn="float", warnings=["valid_range 10, to 900"])
    write("range_text.nc", ramp(), {"valid_range": "0 to 500"})
    add("range_text.nc", ramp(), warnings=["valid_range: found \"0 to 500\", expected 2 numbers: it is not used"])
    write("least.nc", array.astype("f8"), {"valid_min": 10., "valid_max": 900.})
    add("least.nc", want.astype("f8"))
    several = array.astype("f4")
    several[several % 5 == 0] = np.nan
    write("several.nc", array, {"missing_value": np.unique(array[array % 5 == 0]).astype("i2")[:50]})
    # Limits are packed, unless they have the type of the scale.
    scaled = {"scale_factor": np.float32(.01), "add_offset": np.float32(-2)}
    for name, attributes, low, high in (
            ("packed", {"valid_range": np.array([10, 500], "i2")}, 10, 500),
            ("unpacked", {"valid_range": np.array([-1.9, 3], "f4")}, 10, 500),
            ("wider", {"valid_range": np.array([10, 500], "f8")}, 10, 500),
            ("least", {"valid_min": np.float32(-1.9)}, 10, 2000),
            ("falling", {"valid_min": np.float32(-7), "scale_factor": np.float32(-.01)}, -40000, 500)):
        write(f"range_{name}.nc", array, {**scaled, **attributes})
        factor, shift = (float(np.float32({**scaled, **attributes}[key])) for key in ("scale_factor", "add_offset"))
        add(f"range_{name}.nc", np.where((array < low) | (array > high), np.nan, array * factor + shift), drawn="float",
            warnings=["samples are NaN: the file calls them missing (valid_"])
    for number, text in enumerate(("-32768", "-3.2768e4")):
        want = array.astype("f4")
        want[0, 0, 1] = np.nan
        write(f"fill_text{number}.nc", array, {("_FillValue", "missing_value")[number]: text})
        add(f"fill_text{number}.nc", want, drawn="float", warnings=["1 samples are NaN"])
    # NetCDF's own fill values: only where NetCDF has written the file, filled it, and no _FillValue is told.
    for name, attributes, fill_time, kinds in (
            ("own", {"missing_value": 5}, h5py.h5d.FILL_TIME_IFSET, "i2 u2 i4 u4 i8 u8 f4 f8"), ("told", {"_FillValue": 5}, h5py.h5d.FILL_TIME_IFSET, "i4"),
            ("never", {"missing_value": 5}, h5py.h5d.FILL_TIME_NEVER, "i4"),
            ("bytes", {"missing_value": 5}, h5py.h5d.FILL_TIME_IFSET, "i1 u1")):
        for kind in kinds.split():
            fill = {"i2": -32767, "u2": 65535, "i4": -2147483647, "u4": 4294967295, "i8": -9223372036854775806,
                    "u8": 18446744073709551614, "i1": -127, "u1": 255}.get(kind, 9.969209968386869e36)
            stored = ramp(kind) if kind not in ("i1", "u1") else ramp(kind) % 100
            stored[0, 0, 2] = 5
            stored[1, 2, 3] = fill
            with h5py.File(cases.path(f"{name}_{kind}.nc"), "w") as file:
                file.attrs["_NCProperties"] = "version=2,netcdf=4.9.0"
                properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
                properties.set_fill_time(fill_time)
                h5py.h5d.create(file.id, b"v", h5py.h5t.py_create(stored.dtype), h5py.h5s.create_simple(SHAPE), properties)
                file["v"][...] = stored
                file["v"].attrs.update({key: np.dtype(kind).type(value) for key, value in attributes.items()})
            want = stored.astype("f8")
            want[stored == 5] = np.nan
            if name == "own":
                want[1, 2, 3] = np.nan
            add(f"{name}_{kind}.nc", want.astype("f4"), drawn="float")
    data = ramp("i1")
    write("unsigned.nc", data, {"_Unsigned": "true", "missing_value": np.int8(-1)})
    want = data.view("u1").astype("f4")
    want[want == 255] = np.nan
    add("unsigned.nc", want, drawn="float")
    write("signed.nc", data, {"_Unsigned": "true"})
    add("signed.nc", data.view("u1"))
    write("fill_signed.nc", ramp("u1"), {"_Unsigned": "false", "missing_value": np.uint8(255)})  # -1
    want = ramp("u1").view("i1").astype("f4")
    want[want == -1] = np.nan
    add("fill_signed.nc", want, drawn="float")
    for name, attributes in (("scaled", {}), ("hole", {"_FillValue": np.int16(-1)})):
        with h5py.File(cases.path(f"{name}_places.nc"), "w") as file:
            file["v"] = ramp()
            for axis, (word, size) in enumerate(zip("zyx", SHAPE)):
                file[word] = np.arange(-1, size - 1).astype("i2")
                file[word].attrs.update({"scale_factor": .1 * (axis + 1), "add_offset": 10., "units": "m", **attributes})
                file[word].make_scale(word)
                file["v"].dims[axis].attach_scale(file[word])
    add("scaled_places.nc", ramp("<f4"), diagonal(.3, .2, .1), (9.7, 9.8, 9.9), "m")
    add("hole_places.nc", ramp("<f4"), warnings=["the coordinates of z are not equally spaced"])
    for word in ("True", "TRUE", "FALSE", "False"):
        write(f"word_{word}.nc", ramp("i1"), {"_Unsigned": word})
        add(f"word_{word}.nc", ramp("u1" if word.lower() == "true" else "i1"))
    for number, (key, value, *words) in enumerate((
            ("_Unsigned", "yes", "found \"yes\", expected \"true\" or \"false\""), ("_Unsigned", 1, "found 1, expected"),
            ("scale_factor", ".5", "found \".5\", expected one number"), ("add_offset", np.nan, "found nan, expected"),
            ("scale_factor", [.5, 2.], "found 0.5, 2, expected one number"), ("add_offset", np.zeros(70), "neither text nor"),
            ("add_offset", "ten", "found \"ten\""))):
        write(f"unusable{number}.nc", ramp("i1"), {key: value})
        bad(f"unusable{number}.nc", f"{key}: ", *words)
    write("zero_scale.nc", array, {"scale_factor": 0.})
    bad("zero_scale.nc", "scale_factor: found 0")


def others(h5py, cases, write, add, bad):
    """Truth values, float16, bits, colour images, soft links."""
    truth = ramp() % 3 == 0
    write("matlab.mat", ramp(), {"MATLAB_class": np.bytes_("int16")})
    add("matlab.mat", ramp(), warnings=["MATLAB has written it: its first axis (rows) is taken for x"])
    write("bool.h5", truth)
    add("bool.h5", truth.astype("u1"))
    write("half.h5", ramp("<f2"))
    add("half.h5", ramp("<f2").astype("f4"))
    with h5py.File(cases.path("bits.h5"), "w") as file:  # as PyTables stores truth values
        space = h5py.h5s.create_simple(SHAPE)
        data = h5py.h5d.create(file.id, b"v", h5py.h5t.STD_B8LE, space)
        data.write(h5py.h5s.ALL, h5py.h5s.ALL, truth.astype("u1"), h5py.h5t.STD_B8LE)
    add("bits.h5", truth.astype("u1"))
    colours = ramp("u1", (5, 6, 3))
    for mode, order in (("INTERLACE_PIXEL", (0, 1, 2)), ("INTERLACE_LINE", (0, 2, 1)), ("INTERLACE_PLANE", (2, 0, 1))):
        write(f"{mode}.h5", colours.transpose(order), {"CLASS": np.bytes_("IMAGE"), "INTERLACE_MODE": np.bytes_(mode),
                                                       "IMAGE_SUBCLASS": np.bytes_("IMAGE_TRUECOLOR")})
        add(f"{mode}.h5", colours[None, :, :, 1], channel=1, contents={"is_colour": True})
    for order in "<>":  # 512 bytes of another program before the file, from which its places count
        name = f"user_block_{'little' if order == '<' else 'big'}.h5"
        with h5py.File(cases.path(name), "w", userblock_size=512) as file:
            file["v"] = ramp(order + "i2")
        with open(cases.path(name), "r+b") as file:
            file.write(b"x" * 512)
        add(name, ramp("<i2"))
    with h5py.File(cases.path("soft.h5"), "w") as file:
        file["group/v"] = ramp()
        file["link"] = h5py.SoftLink("/group/v")
        file["group/inner"] = h5py.SoftLink("v")
        file["again"] = file["group/v"]  # a second hard link is no second array
    for array in ("", "/link", "/group/inner", "/again"):
        add("soft.h5", ramp(), array=array)


def linked(h5py, cases, write, add, bad):
    """External links, virtual data sets and external storage, also in folders and of one another."""
    array = ramp()
    os.makedirs(cases.path("parts"), exist_ok=True)
    for i in range(4):
        with h5py.File(cases.path(f"parts/{i}.h5"), "w") as file:
            file["deep/v"] = array[i]
            file["link"] = h5py.SoftLink("/deep/v")
    layout = h5py.VirtualLayout(array.shape, array.dtype)
    for i in range(4):
        layout[i] = h5py.VirtualSource(f"parts/{i}.h5", "link" if i % 2 else "deep/v", array[i].shape, array.dtype)
    with h5py.File(cases.path("virtual.h5"), "w") as file:
        file.create_virtual_dataset("v", layout)
        file["v"].attrs["element_size_um"] = [2.5, .7, .9]
    with h5py.File(cases.path("parts/outer.h5"), "w") as file:
        file["v"] = h5py.ExternalLink("../virtual.h5", "/v")
        file["group"] = h5py.ExternalLink("../soft.h5", "/group")
    with h5py.File(cases.path("twice.h5"), "w") as file:
        file["v"] = h5py.ExternalLink("parts/outer.h5", "/v")
        file["group"] = h5py.ExternalLink("parts/outer.h5", "/group")
    array.tofile(cases.path("parts/samples.raw"))
    with h5py.File(cases.path("storage.h5"), "w") as file:
        file.create_dataset("v", array.shape, array.dtype, external=[("parts/samples.raw", 0, array.nbytes)])
    (np.arange(4) * 2.5 + 1).tofile(cases.path("parts/scale.raw"))
    for name, raw in (("scale.h5", "parts/scale.raw"), ("lost_scale.h5", "parts/no.raw"), ("parts/up_scale.h5", "../up.raw")):
        with h5py.File(cases.path(name), "w") as file:
            file["v"] = array
            file.create_dataset("z", (4,), "f8", external=[(raw, 0, 32)])
            file["z"].make_scale("z")
            file["v"].dims[0].attach_scale(file["z"])
    (np.arange(4) * 2.5 + 1).tofile(cases.path("up.raw"))
    add("scale.h5", array, diagonal(1, 1, 2.5), (0, 0, 1), array="/v")
    bad("lost_scale.h5", "parts/no.raw: no such file", "lost_scale.h5 names it", array="/v")
    files = ["virtual.h5"] + [f"parts/{i}.h5" for i in range(4)]
    for name, more, belong in (("virtual.h5", {}, files), ("storage.h5", {}, ["storage.h5", "parts/samples.raw"]),
                               ("twice.h5", {"array": "/v"}, ["twice.h5", "parts/outer.h5", "soft.h5"] + files),
                               ("twice.h5", {"array": "/group/v"}, ["twice.h5"])):
        size = diagonal(.9, .7, 2.5) if "v" == more.get("array", "")[1:] or name == "virtual.h5" else None
        add(name, array, size, unit="um" if size is not None else "", **more)
        cases.cases[-1]["files"] = belong
    with h5py.File(cases.path("lost.h5"), "w") as file:
        file["v"] = h5py.ExternalLink("parts/none.h5", "/v")
    bad("lost.h5", "parts/none.h5: no such file", "lost.h5 names it")
    layout[0] = h5py.VirtualSource("parts/gone.h5", "v", array[0].shape, array.dtype)
    with h5py.File(cases.path("hole.h5"), "w") as file:
        file.create_virtual_dataset("v", layout)
    bad("hole.h5", "parts/gone.h5: no such file", "hole.h5 names it")
    with h5py.File(cases.path("ring.h5"), "w") as file:
        file["v"] = h5py.SoftLink("/w")
        file["w"] = h5py.SoftLink("/v")
    bad("ring.h5", "links that lead to links", array="/v")
    with open(cases.path("parts/no.h5"), "w", encoding="utf-8") as file:
        file.write("no HDF5 file")
    with h5py.File(cases.path("wrong.h5"), "w") as file:
        file["v"] = h5py.ExternalLink("parts/no.h5", "/v")
    bad("wrong.h5", "parts/no.h5", "no signature of HDF5")


def refused(h5py, cases, write, add, bad):
    write("complex.h5", np.zeros(SHAPE, "c8"))
    for request in ({}, {"array": "/v"}):
        bad("complex.h5", "complex numbers of r, i", **request)
    write("words.h5", np.full(SHAPE, b"word"))
    bad("words.h5", "found text of 4 bytes", array="/v")
    with h5py.File(cases.path("beyond.h5"), "w") as file:
        file["v"] = ramp()
        # Data Layout message, version 3: class 1 (contiguous), address.
        place = struct.pack("<BBQ", 3, 1, file["v"].id.get_offset())
    for far in (1 << 20, (1 << 62) - 8):  # samples that begin behind the end of their file
        name = f"beyond_{far.bit_length()}.h5"
        with open(cases.path("beyond.h5"), "rb") as file, open(cases.path(name), "wb") as out:
            data = file.read()
            assert data.count(place) == 1
            out.write(data.replace(place, struct.pack("<BBQ", 3, 1, far)))
        bad(name, name, "240 bytes", "holds 0 bytes")
    with h5py.File(cases.path("minc.mnc.h5"), "w") as file:
        file["minc-2.0/image/0/image"] = ramp()
    for request in ({}, {"array": "/minc-2.0/image/0/image"}, {"array": "minc-2.0/image/0/image"}):
        bad("minc.mnc.h5", "found MINC", "mnc2nii", **request)


def classic(cases, add, bad):
    """Classic NetCDF; `wild` is interleaved with a record variable of another type."""
    from scipy.io import netcdf_file
    array = ramp(">i2")
    data = np.stack([array, array + 1000])
    for version in (1, 2):
        name = f"classic{version}.nc"
        with netcdf_file(cases.path(name), "w", version=version) as file:
            file.title = "a title"
            for word, size in (("time", None), ("lev", 4), ("lat", 5), ("lon", 6)):
                file.createDimension(word, size)
            for word, numbers, unit in (("lev", [5, 3, 1, -1], "m"), ("lat", [50, 49, 48, 47, 46], "degrees_north"),
                                        ("lon", np.arange(6) * .5, "degrees_east")):
                variable = file.createVariable(word, "f", (word,))
                variable[:] = numbers
                variable.units = unit
            time = file.createVariable("time", "d", ("time",))
            time.units = "days since 2000-01-01"
            odd = file.createVariable("odd", "b", ("time", "lat"))  # padded to 4 bytes a record
            v = file.createVariable("v", "h", ("time", "lev", "lat", "lon"))
            turned = file.createVariable("turned", "f", ("lon", "lat", "lev"))
            movie = file.createVariable("movie", "i", ("time", "lat", "lon"))
            v.scale_factor, v.add_offset, v._FillValue = .5, 10., np.int16(7)
            turned[:] = array.transpose(2, 1, 0)
            for i in range(2):
                time[i], odd[i], v[i], movie[i] = i * 2, i, data[i], array[0] + i * 1000
        steps, origin = diagonal(.5, -1, -2), (0, 50, 5)
        contents = {"arrays": ["turned", "v", "movie"], "times": ["0 days since 2000-01-01", "2 days since 2000-01-01"]}
        for i in range(2):
            want = data[i] * .5 + 10
            want[data[i] == 7] = np.nan
            add(name, want, steps, origin, "degrees_east", contents, drawn="float", array="v", time=i)
            add(name + ":/movie", (array[:1] + i * 1000).astype("f4"), diagonal(.5, -1, 1), (0, 50, 0), "degrees_east", time=i)
        add(name, array.astype("f4"), steps, origin, "degrees_east", array="/turned", warnings=["units degrees_east, degrees_north, m"])
        bad(name, "found the arrays turned, v, movie", f"{name}:/turned")
        bad(name, "named \"none\"", array="none")
        with open(cases.path(name), "rb") as file:
            whole = file.read()
        with open(cases.path("cut_" + name), "wb") as file:
            file.write(whole[:-600])
        bad("cut_" + name, "truncated", array="v")
    with netcdf_file(cases.path("places.nc"), "w") as file:
        for word, size in zip("zyx", SHAPE):
            file.createDimension(word, size)
            variable = file.createVariable(word, "h", (word,))
            variable[:] = np.arange(size)
            variable.scale_factor, variable.add_offset, variable.units = .25, 10., "m"
        file.createVariable("v", "h", ("z", "y", "x"))[:] = array
    add("places.nc", array.astype("f4"), diagonal(.25, .25, .25), (10, 10, 10), "m")
    # Each order of dimensions, as records or not, of which the first may be taken; fill values.
    for word in ("tzyx", "zyx", "xyz", "yzx", "ztyx", "zyxt", "xtyz"):
        for records in (False, True):
            name = f"order_{word}{int(records)}.nc"
            turned = np.stack([array, array + 1000]) if "t" in word else array[None].copy()
            turned[-1, 1, 2, 3] = -32767
            with netcdf_file(cases.path(name), "w") as file:
                for axis, letter in enumerate(word):
                    file.createDimension(letter, None if records and axis == 0 else dict(zip("tzyx", turned.shape))[letter])
                v = file.createVariable("v", "h", tuple(word))
                file.createVariable("odd", "b", (word[0],))[:] = np.zeros(dict(zip("tzyx", turned.shape))[word[0]], "b")
                v[:] = turned.transpose(["tzyx".index(letter) for letter in ("t" * ("t" not in word) + word)]).reshape(
                    [dict(zip("tzyx", turned.shape))[letter] for letter in word])
            want = turned[-1].astype("f4")
            want[1, 2, 3] = np.nan
            add(name, want, warnings=["1 samples are NaN: the file calls them missing (NetCDF's fill value -32767)"],
                **({"time": 1} if "t" in word else {}))
    for number, (text, kind) in enumerate((("7", "f"), ("7.", "f"), ("seven", ""), ("7, 8", ""))):
        with netcdf_file(cases.path(f"text{number}.nc"), "w") as file:
            for word, size in zip("zyx", SHAPE):
                file.createDimension(word, size)
            v = file.createVariable("v", "h", ("z", "y", "x"))
            v[:] = array
            v.missing_value = text
        if kind:
            add(f"text{number}.nc", np.where(array == 7, np.nan, array).astype("f4"), warnings=["missing_value 7"])
        else:
            bad(f"text{number}.nc", f"missing_value: found \"{text}\", expected a number")
    with netcdf_file(cases.path("minc1.mnc"), "w") as file:
        for word, size in zip("zyx", SHAPE):
            file.createDimension(f"{word}space", size)
        file.createVariable("image", "h", ("zspace", "yspace", "xspace"))[:] = array
        file.createVariable("image-max", "d", ("zspace",))[:] = np.arange(4)
    bad("minc1.mnc", "found MINC", "mnc2nii")
    with netcdf_file(cases.path("single.nc"), "w") as file:  # a single record variable is not padded
        for word, size in (("z", None), ("y", 3), ("x", 3)):
            file.createDimension(word, size)
        v = file.createVariable("v", "b", ("z", "y", "x"))
        for i in range(4):
            v[i] = np.arange(9).reshape(3, 3) + 10 * i
    add("single.nc", (np.arange(9).reshape(1, 3, 3) + 10 * np.arange(4)[:, None, None]).astype("i1"), drawn="int16")

    def name_of(text):  # CDF-5: counts have 8 bytes
        return struct.pack(">q", len(text)) + text.encode() + b"\0" * (-len(text) % 4)

    def header(begin):
        dims = b"".join(name_of(word) + struct.pack(">q", size) for word, size in (("c", 3), ("z", 4), ("y", 5), ("x", 6)))
        return (b"CDF\5" + struct.pack(">q", 0) + struct.pack(">iq", 10, 4) + dims + struct.pack(">iq", 0, 0) +
                struct.pack(">iq", 11, 1) + name_of("v") + struct.pack(">q4q", 4, 1, 2, 3, 0) + struct.pack(">iq", 0, 0) +
                struct.pack(">iqq", 10, 8 * 360, begin))
    big = (ramp("i8", (4, 5, 6, 3)) - 500).astype(">i8")
    with open(cases.path("big.nc"), "wb") as file:
        file.write(header(len(header(0))) + big.tobytes())
    add("big.nc", big[..., 2].astype("f4"), channel=2, contents={"channels": ["", "", ""]})
    with open(cases.path("none.nc"), "wb") as file:
        file.write(b"no file of NetCDF")
    bad("none.nc", "neither classic NetCDF nor HDF5")
    with open(cases.path("endless.nc"), "wb") as file:
        file.write(b"CDF\1" + b"\0\0\0\0" + struct.pack(">ii", 10, 2**31 - 1))
    bad("endless.nc", "truncated")
