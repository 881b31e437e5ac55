#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""array_oracle.py FOLDER: writes Zarr arrays and OME-Zarr images, HDF5 files and folders of DICOM slices to
FOLDER with their own libraries (zarr, h5py, pydicom), and to FOLDER/cases.json a list of what should be read:
path, request, size, origin, steps, and the values as FOLDER/NAME.values (float64, x fastest). A case with "error"
should be refused with those words. Exits with 77 where a library is not installed.
"""
import base64
import json
import os
import struct
import sys
import zipfile

try:
    import h5py
    import numcodecs
    import numpy as np
    import pydicom  # noqa: F401
    import zarr
    from pydicom.dataset import Dataset, FileMetaDataset
    from pydicom.uid import (ExplicitVRBigEndian, ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless,
                             generate_uid)

    from dicom_kinds import kinds_of_dicom
except ImportError:
    sys.exit(77)
from oracles import zarr3
from oracles.zarr3 import codec, shard

FOLDER = sys.argv[1]
CASES = []
RNG = np.random.default_rng(3)
UNIT = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def case(name, path, values, steps=None, origin=(0, 0, 0), **request):
    """`values`: what should be read, in the order z, y, x."""
    values = np.asarray(values)
    values.astype("<f8").tofile(f"{FOLDER}/{name}.values")
    CASES.append({"name": name, "path": path, "size": list(values.shape[::-1]), "origin": [float(v) for v in origin],
                  "steps": [[float(v) for v in step] for step in (steps or UNIT)], "request": request})


def bad(name, path, *words, **request):
    CASES.append({"name": name, "path": path, "error": list(words), "request": request})


def samples(dtype, shape=(5, 6, 7)):
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return RNG.normal(size=shape).astype("f4").astype(dtype)
    if dtype.kind == "b":
        return RNG.integers(0, 2, shape).astype(dtype)
    info = np.iinfo(dtype)
    # Values that float32 holds, in all bits of the type.
    return (RNG.integers(max(info.min, -2**20), min(info.max, 2**20), shape, endpoint=True)).astype(dtype)


def save_zarr(name, array, **how):
    how.setdefault("chunks", (2, 4, 3))
    stored = zarr.open(f"{FOLDER}/{name}.zarr", mode="w", shape=array.shape, dtype=array.dtype, **how)
    stored[...] = array
    return f"{name}.zarr"


def zarr_cases():
    for dtype in ("|b1", "|u1", "|i1", "<u2", ">u2", "<i2", ">i2", "<u4", ">u4", "<i4", ">i4", "<u8", ">u8", "<i8",
                  ">i8", "<f4", ">f4", "<f8", ">f8"):
        array = samples(dtype)
        name = "type_" + dtype.replace("|", "n").replace("<", "l").replace(">", "b")
        case(name, save_zarr(name, array), array)
    codecs = {"none": None, "zlib": numcodecs.Zlib(5), "gzip": numcodecs.GZip(5), "zstd": numcodecs.Zstd(3),
              "lz4": numcodecs.LZ4()}
    for inner in ("blosclz", "lz4", "lz4hc", "zlib", "zstd"):
        for shuffle in (0, 1, 2):
            codecs[f"blosc_{inner}_{shuffle}"] = numcodecs.Blosc(cname=inner, clevel=5, shuffle=shuffle)
    ramp = np.arange(40 * 30 * 20, dtype="<u2").reshape(20, 30, 40)
    for word, codec in codecs.items():
        for order in "CF":
            name = f"codec_{word}_{order}"
            case(name, save_zarr(name, ramp, compressor=codec, order=order, chunks=(8, 16, 32)), ramp)
    name = "slashes"
    case(name, save_zarr(name, ramp, chunks=(20, 7, 40), dimension_separator="/"), ramp)
    # Chunks that were never written have the fill value.
    for fill, dtype in ((7, "<i2"), (-1.5, ">f4"), (0, "|u1")):
        name = f"fill_{dtype[1:]}"
        stored = zarr.open(f"{FOLDER}/{name}.zarr", mode="w", shape=(6, 7, 8), dtype=dtype, chunks=(4, 4, 4),
                           fill_value=fill)
        stored[:3, :3, :5] = samples(dtype, (3, 3, 5))
        case(name, name + ".zarr", stored[...])
    flat = samples("<u2", (6, 7))
    case("flat", save_zarr("flat", flat, chunks=(4, 4)), flat[None])
    five = samples("<i2", (3, 2, 4, 5, 6))
    path = save_zarr("five", five, chunks=(2, 2, 3, 3, 3))
    case("five", path, five[0, 0])
    behind = samples("<i2", (3, 7, 5, 6, 2))  # channels
    case("behind", save_zarr("behind", behind, chunks=(2, 3, 3, 3, 2)), behind[2, ..., 1], time=2, channel=1)
    case("five_told", path, five[2, 1], time=2, channel=1)
    bad("five_beyond", path, "time", "found 3", "0 to 2", time=3)
    four = samples("<i2", (3, 4, 5, 6))
    case("four", save_zarr("four", four, chunks=(1, 4, 5, 6)), four[1], channel=1)
    colours = samples("<u2", (7, 5, 6, 3))
    path = save_zarr("colours", colours, chunks=(2, 4, 3, 2))
    case("colours", path, colours[..., 2], channel=2)
    case("colours_time", path, colours[4], time=4)

    group = zarr.open_group(f"{FOLDER}/group.zarr", mode="w")
    group.create_dataset("a/one", data=ramp[:5, :5, :5], chunks=(2, 2, 2))
    alone = zarr.open_group(f"{FOLDER}/alone.zarr", mode="w")
    alone.create_dataset("a/one", data=ramp[:5, :5, :5], chunks=(2, 2, 2))
    case("group", "alone.zarr", ramp[:5, :5, :5])
    case("group_path", "group.zarr/a/one", ramp[:5, :5, :5])
    group.create_dataset("a/two", data=ramp[:3, :3, :3], chunks=(2, 2, 2))
    case("group_told", "group.zarr", ramp[:3, :3, :3], array="a/two")
    bad("group_several", "group.zarr", "a/one, a/two", "expected one")
    bad("group_none", "group.zarr", "b/one", array="b/one")
    case("bz2", save_zarr("bz2", ramp, compressor=numcodecs.BZ2()), ramp)
    save_zarr("lzma", ramp, compressor=numcodecs.LZMA())
    bad("lzma", "lzma.zarr", "compressor", "lzma", "blosc")
    save_zarr("scaled", ramp, filters=[numcodecs.FixedScaleOffset(0, 1, "<u2")])
    bad("scaled", "scaled.zarr", "filters", "fixedscaleoffset", "shuffle, delta")
    for dtype in ("|u1", "<i2", ">u2", "<i8", ">f4", "<f8"):
        array = samples(dtype)
        name = f"filters_{dtype[0] == '>'}{dtype[1:]}"
        # Both filters, of which shuffle sees what delta has made, and an array with a last chunk that is cut.
        filters = [numcodecs.Delta(dtype), numcodecs.Shuffle(np.dtype(dtype).itemsize)]
        if dtype[1] == "f":
            filters = filters[1:]  # sums of differences are rounded
        path = save_zarr(name, array, chunks=(2, 4, 3), filters=filters, order="F" if dtype == "<i2" else "C")
        case(name, path, array)
    whole = np.arange(5 * 6 * 7, dtype="<f4").reshape(5, 6, 7) * 3
    case("filters_sums", save_zarr("filters_sums", whole, chunks=(2, 4, 3), filters=[numcodecs.Delta("<f4")]), whole)
    rounded = save_zarr("quantized", samples("<f4"), filters=[numcodecs.Quantize(2, "<f4")])
    case("quantized", rounded, zarr.open(f"{FOLDER}/{rounded}")[...])
    for dtype in ("<f2", ">f2"):
        half = samples(dtype)
        # Subnormal, infinite and no numbers, too.
        half[0, 0, :4] = np.array([6e-8, -6e-5, -np.inf, np.nan], "f2")
        name = "half_" + ("little" if dtype[0] == "<" else "big")
        case(name, save_zarr(name, half), half)

    image = zarr.open_group(f"{FOLDER}/image.zarr", mode="w")
    fine = samples("<u2", (2, 3, 4, 8, 10))
    image.create_dataset("0", data=fine, chunks=(1, 1, 2, 8, 8), dimension_separator="/")
    image.create_dataset("1", data=fine[..., ::2, ::2], chunks=(1, 1, 4, 4, 4), dimension_separator="/")
    axes = [{"name": "t", "type": "time"}, {"name": "c", "type": "channel"}] + [
        {"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"]
    image.attrs["multiscales"] = [{"version": "0.4", "axes": axes, "datasets": [
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 2, .5, .25]}]},
        {"path": "1", "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 2, 1, .5]},
                                                    {"type": "translation", "translation": [0, 0, 3, 4, 5]}]}],
        "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 10, 10, 10]}]}]
    case("image", "image.zarr", fine[0, 0], [[2.5, 0, 0], [0, 5, 0], [0, 0, 20]])
    case("image_level", "image.zarr", fine[1, 2, :, ::2, ::2], [[5, 0, 0], [0, 10, 0], [0, 0, 20]],
         (50, 40, 30), level=1, time=1, channel=2)
    bad("image_beyond", "image.zarr", "level", "found 2", "0 to 1", level=2)
    zyx = zarr.open_group(f"{FOLDER}/zyx.zarr", mode="w")
    zyx.create_dataset("s0", data=ramp, chunks=(10, 10, 10))
    zyx.attrs["multiscales"] = [{"version": "0.3", "axes": ["z", "y", "x"], "datasets": [{"path": "s0"}]}]
    case("zyx", "zyx.zarr", ramp)
    # A slice is as thick as the shorter side of a pixel.
    flat = zarr.open_group(f"{FOLDER}/slice.zarr", mode="w")
    flat.create_dataset("s0", data=ramp[:2])
    flat.attrs["multiscales"] = [{"version": "0.4", "axes": axes[1:2] + axes[3:], "datasets": [
        {"path": "s0", "coordinateTransformations": [{"type": "scale", "scale": [1, .5, .25]}]}]}]
    case("slice", "slice.zarr", ramp[1:2], [[.25, 0, 0], [0, .5, 0], [0, 0, .25]], channel=1)


def zarr3_cases():
    def save(name, array, chunks=(2, 4, 3), codecs=None, values=None, request=None, **how):
        zarr3.write(f"{FOLDER}/{name}.zarr", array, chunks, codecs, **how)
        case(name, f"{name}.zarr", array if values is None else values, **(request or {}))

    for kind in ("bool", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"):
        for endian in ("little", "big"):
            save(f"3_{kind}_{endian}", samples(kind), codecs=[codec("bytes", endian=endian)])
    save("3_no_endian", samples("u1"), codecs=[codec("bytes")])
    packers = {"gzip": codec("gzip", level=5), "zstd": codec("zstd", level=3, checksum=False),
               "lz4": codec("blosc", cname="lz4", clevel=5, shuffle="shuffle", typesize=2, blocksize=0),
               "bits": codec("blosc", cname="zstd", clevel=5, shuffle="bitshuffle", typesize=2, blocksize=0),
               "crc": codec("crc32c")}
    ramp = np.arange(40 * 30 * 20, dtype="<u2").reshape(20, 30, 40)
    words = codec("bytes", endian="little")
    for name, packer in packers.items():
        save("3_" + name, ramp, (8, 16, 32), [words, packer])
    save("3_crc_last", ramp, (8, 16, 32), [words, packers["zstd"], codec("crc32c")])
    save("3_crc_first", ramp, (8, 16, 32), [words, codec("crc32c"), packers["gzip"], codec("crc32c")])
    # Neither order is its own inverse.
    turn = codec("transpose", order=[2, 0, 1])
    save("3_turned", ramp, (8, 16, 32), [turn, words])
    save("3_turned_twice", ramp, (8, 16, 32), [turn, codec("transpose", order=[0, 2, 1]), words])
    for name, keys in (("slash", codec("default", separator="/")), ("dot", codec("default", separator=".")),
                       ("default", codec("default")), ("v2", codec("v2")), ("v2_slash", codec("v2", separator="/"))):
        save("3_keys_" + name, ramp, (8, 16, 32), keys=keys)

    inner = [words, packers["zstd"]]
    some = ramp.copy()
    some[4:12, :8, 8:24] = 7  # inner chunks and whole shards of the fill value
    some[:, 16:, :16] = 7
    for name, how in (("end", {}), ("start", {"index_location": "start"}),
                      ("plain", {"index_codecs": [words]}),
                      ("big", {"index_codecs": [codec("bytes", endian="big"), codec("crc32c")]})):
        save("3_shard_" + name, some, (8, 16, 16), [shard((4, 8, 8), inner, **how)], fill=7)
    save("3_shard_crc", some, (8, 16, 16), [shard((4, 8, 8), [words, packers["lz4"], codec("crc32c")])], fill=7)
    save("3_shard_inner_turn", some, (8, 16, 16), [shard((4, 8, 8), [turn, *inner])], fill=7)
    # The shard's axes are those of the transposed chunk: (16, 8, 16).
    save("3_shard_turn", some, (8, 16, 16), [turn, shard((4, 4, 8), inner)], fill=7)
    save("3_shard_turns", some, (8, 16, 16), [turn, shard((4, 4, 8), [turn, *inner])], fill=7)
    five = samples("<i2", (3, 2, 4, 5, 6))
    save("3_shard_five", five, (2, 2, 4, 4, 4), [shard((1, 1, 2, 2, 4), inner)], values=five[2, 1],
         request={"time": 2, "channel": 1})

    for kind, fill, word in (("f4", np.nan, "NaN"), ("f8", np.inf, "Infinity"), ("f2", -np.inf, "-Infinity"),
                             ("f4", -1.5, -1.5), ("f4", np.inf, "0x7f800000"), ("f8", -2.5, "0xc004000000000000"),
                             ("f2", 1.5, "0x3e00"), ("bool", True, True), ("i1", -128, -128),
                             ("u8", 2**40 + 2**20, 2**40 + 2**20), ("u1", 255, 255)):
        holes = samples(kind, (6, 7, 8))
        holes[:4, :4, :4] = fill
        save(f"3_fill_{kind}_{word}", holes, (4, 4, 4), fill=fill, fill_json=word)

    save("3_xyz", ramp, (8, 16, 32), values=ramp.transpose(), dimension_names=["x", "y", "z"])
    save("3_named_time", ramp, (8, 16, 32), values=ramp[None, 3], dimension_names=["time", "y", "x"],
         request={"time": 3})
    save("3_null_names", ramp, (8, 16, 32), dimension_names=[None, "y", None])
    save("3_ignored", ramp, (8, 16, 32), storage_transformers=[],
         consolidated_metadata=None, odd={"must_understand": False})

    zarr3.write_group(f"{FOLDER}/3_group.zarr")
    zarr3.write_group(f"{FOLDER}/3_group.zarr/a")
    zarr3.write(f"{FOLDER}/3_group.zarr/a/one", ramp, (8, 16, 32))
    zarr3.write(f"{FOLDER}/3_group.zarr/a/flat", ramp[0], (16, 32))  # no volume beside one
    case("3_group", "3_group.zarr", ramp)
    case("3_group_told", "3_group.zarr", ramp[:1], array="a/flat")


def ome_cases():
    def axes(*units):
        kinds = {"t": "time", "c": "channel"}
        return [{"name": n, "type": kinds.get(n, "space"), **({"unit": u} if u else {})} for n, u in units]

    def scaled(path, scale, *shift):
        return {"path": path, "coordinateTransformations": [
            {"type": "scale", "scale": scale}, *({"type": "translation", "translation": list(s)} for s in shift)]}

    fine = samples("<u2", (2, 3, 4, 8, 10))
    tczyx = axes(("t", "second"), ("c", ""), ("z", "nanometer"), ("y", "micrometer"), ("x", "micrometer"))
    image = f"{FOLDER}/ome5.zarr"
    zarr3.write_group(image, ome={"version": "0.5", "multiscales": [{
        "axes": tczyx, "datasets": [scaled("0", [2, 1, 2000, .5, .25]),
                                    scaled("1", [2, 1, 2000, 1, .5], (0, 0, 3000, 4, 5))],
        "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 10, 10, 10]},
                                      {"type": "translation", "translation": [0, 0, 1000, 2, 3]}]}],
        "omero": {"channels": [{"label": "DAPI"}, {"label": "GFP"}, {"label": "RFP"}]}})
    sharded = [shard((1, 1, 2, 4, 4), [codec("bytes", endian="little"), codec("zstd", level=1)])]
    zarr3.write(image + "/0", fine, (1, 1, 4, 8, 8), sharded)
    zarr3.write(image + "/1", fine[..., ::2, ::2], (1, 1, 4, 4, 8), sharded)
    # z is in nanometers, x in micrometers.
    case("ome5", "ome5.zarr", fine[0, 0], [[2.5, 0, 0], [0, 5, 0], [0, 0, 20]], (3, 2, 1))
    case("ome5_level", "ome5.zarr", fine[1, 2, :, ::2, ::2], [[5, 0, 0], [0, 10, 0], [0, 0, 20]],
         (53, 42, 31), level=1, time=1, channel=2)
    case("ome5_array", "ome5.zarr", fine[0, 0, :, ::2, ::2], [[5, 0, 0], [0, 10, 0], [0, 0, 20]], (53, 42, 31),
         array="1")
    zarr3.write_group(image + "/labels", ome={"version": "0.5", "labels": ["cells"]})
    zarr3.write_group(image + "/labels/cells", ome={"version": "0.5", "multiscales": [{
        "axes": axes(("z", ""), ("y", ""), ("x", "")), "datasets": [scaled("0", [3, 2, 1])]}], "image-label": {}})
    cells = samples("u1", (4, 8, 10))
    zarr3.write(image + "/labels/cells/0", cells, (4, 8, 10))
    case("ome5_labels", "ome5.zarr", cells, [[1, 0, 0], [0, 2, 0], [0, 0, 3]], array="labels/cells")
    # Axes in another order than the convention's.
    turned = zarr.open_group(f"{FOLDER}/turned.zarr", mode="w")
    turned.create_dataset("0", data=fine[0].transpose(3, 2, 0, 1), chunks=(4, 4, 1, 2))
    turned.attrs["multiscales"] = [{"version": "0.4", "axes": axes(("x", "mm"), ("y", ""), ("c", ""), ("z", "mm")),
                                    "datasets": [scaled("0", [1, 2, 1, 3])]}]
    case("ome_turned", "turned.zarr", fine[0, 1], [[1, 0, 0], [0, 2, 0], [0, 0, 3]], channel=1)

    def several(name, **attributes):
        group = zarr.open_group(f"{FOLDER}/{name}.zarr", mode="w")
        group.attrs.update(attributes)
        for path in ("A/1/0", "A/1/1") if "plate" in attributes else ("0", "1"):
            inner = group.create_group(path)
            inner.create_dataset("s0", data=fine[0, 0], chunks=(4, 8, 8))
            inner.attrs["multiscales"] = [{"version": "0.4", "axes": axes(("z", ""), ("y", ""), ("x", "")),
                                           "datasets": [scaled("s0", [4, 3, 2])]}]
    several("series", **{"bioformats2raw.layout": 3})
    bad("ome_series", "series.zarr", "0, 1", "expected one, as in", "series.zarr/0")
    case("ome_series_1", "series.zarr", fine[0, 0], [[2, 0, 0], [0, 3, 0], [0, 0, 4]], array="1")
    several("plate", plate={"wells": [{"path": "A/1"}]})
    bad("ome_plate", "plate.zarr", "is a plate", "A/1/0, A/1/1")
    case("ome_field", "plate.zarr", fine[0, 0], [[2, 0, 0], [0, 3, 0], [0, 0, 4]], array="A/1/1")


def xarray_cases():
    """Groups as xarray writes them: names of axes, coordinates beside the array, packed and missing values."""
    group = zarr.open_group(f"{FOLDER}/xarray.zarr", mode="w")
    values = samples("<i2", (2, 4, 5, 6))
    values[0, 0, 0, :3] = -999

    def add(name, data, axes, **attributes):
        stored = group.create_dataset(name, data=data, fill_value=attributes.pop("fill", None))
        stored.attrs.update(_ARRAY_DIMENSIONS=axes, **attributes)
    add("lon", np.arange(6) * .5 + 10, ["lon"], units="degrees_east")
    add("lat", 40 - np.arange(5) * 2., ["lat"], units="degrees_north")
    add("level", np.array([1000, 900, 700, 500]), ["level"], units="hPa")  # uneven
    add("time", np.array([0, 6]), ["time"], units="hours since 2000-01-01")
    add("air", values, ["time", "level", "lat", "lon"], scale_factor=.5, add_offset=-3.)
    steps = [[.5, 0, 0], [0, -2, 0], [0, 0, 1]]
    case("xarray", "xarray.zarr", values[0] * .5 - 3, steps, (10, 40, 0), array="air")
    case("xarray_time", "xarray.zarr", values[1] * .5 - 3, steps, (10, 40, 0), array="air", time=1)
    floats = samples("<f4", (5, 4, 6))
    floats[1] = -9999.25
    marked = np.where(floats == -9999.25, np.nan, floats)
    add("fill", floats, ["lat", "level", "lon"], fill=-9999.25)
    bad("xarray_several", "xarray.zarr", "the arrays air, fill")
    case("xarray_fill", "xarray.zarr", marked.transpose(1, 0, 2), steps, (10, 40, 0), array="fill")
    # Version 3: xarray writes a float's fill value as base64 of a float64.
    third = f"{FOLDER}/xarray3.zarr"
    zarr3.write_group(third)
    zarr3.write(third + "/lon", np.arange(6) * .5 + 10, (6,), dimension_names=["lon"],
                attributes={"units": "degrees_east"})
    zarr3.write(third + "/air", floats, (2, 2, 6), dimension_names=["lat", "level", "lon"],
                attributes={"_FillValue": base64.b64encode(struct.pack("<d", -9999.25)).decode()})
    case("xarray3", "xarray3.zarr", marked.transpose(1, 0, 2), [[.5, 0, 0], [0, 1, 0], [0, 0, 1]], (10, 0, 0))
    # Packed coordinates, of which a chunk may be missing.
    places = zarr.open_group(f"{FOLDER}/packed_places.zarr", mode="w")
    for axis, (word, size) in enumerate(zip(("lev", "lat", "lon"), (4, 5, 6))):
        stored = places.create_dataset(word, data=np.arange(size, dtype="<i2"), chunks=(3,), fill_value=None)
        stored.attrs.update(_ARRAY_DIMENSIONS=[word], scale_factor=.25 * (axis + 1), add_offset=10. * axis, units="m")
    ramp = samples("<i2", (4, 5, 6))
    stored = places.create_dataset("v", data=ramp, fill_value=None)
    stored.attrs["_ARRAY_DIMENSIONS"] = ["lev", "lat", "lon"]
    case("xarray_packed_places", "packed_places.zarr", ramp, [[.75, 0, 0], [0, .5, 0], [0, 0, .25]], (20, 10, 0))
    CASES[-1]["unit"] = "m"
    # Valid ranges are packed if they are whole numbers, and unpacked if they and the scale are not.
    for name, limits in (("packed", [10, 500]), ("unpacked", [2.0, 247.0])):
        stored = zarr.open(f"{FOLDER}/range_{name}.zarr", mode="w", shape=ramp.shape, dtype="<i2", fill_value=None)
        stored[...] = ramp
        stored.attrs.update(scale_factor=.5, add_offset=-3., valid_range=limits)
        case(f"xarray_range_{name}", f"range_{name}.zarr",
             np.where((ramp >= 10) & (ramp <= 500), ramp * .5 - 3, np.nan))
    for name, attributes, *words in (("text", {"missing_value": "none"}, "missing_value: found \"none\", expected a number"),
                                     ("truth", {"_FillValue": True}, "_FillValue: found \"true\"")):
        stored = zarr.open(f"{FOLDER}/missing_{name}.zarr", mode="w", shape=ramp.shape, dtype="<i2", fill_value=None)
        stored[...] = ramp
        stored.attrs.update(attributes)
        bad(f"xarray_missing_{name}", f"missing_{name}.zarr", *words)
    # An image that names no axes, of fewer than the five of the first versions.
    bare = zarr.open_group(f"{FOLDER}/bare.zarr", mode="w")
    bare.create_dataset("s0", data=ramp, fill_value=None)
    bare.attrs["multiscales"] = [{"datasets": [{"path": "s0"}]}]
    case("bare_image", "bare.zarr", ramp)
    # Lengths and names of axes, as programs without a convention write them.
    for name, attributes, steps_of, origin in (
            ("element", {"element_size_um": [2.5, .75, .5]}, (.5, .75, 2.5), (0, 0, 0)),
            ("voxel", {"voxel_size": [25, 9, 7], "offset": [3, 2, 1]}, (7, 9, 25), (1, 2, 3)),
            ("one", {"resolution": 2, "resolution_unit": "nm"}, (2, 2, 2), (0, 0, 0))):
        stored = zarr.open(f"{FOLDER}/lengths_{name}.zarr", mode="w", shape=ramp.shape, dtype="<i2", fill_value=None)
        stored[...] = ramp
        stored.attrs.update(attributes)
        case(f"lengths_{name}", f"lengths_{name}.zarr", ramp, np.diag(steps_of).astype(float).tolist(), origin)
        CASES[-1]["unit"] = {"element": "um", "voxel": "", "one": "nm"}[name]
    stored = zarr.open(f"{FOLDER}/named.zarr", mode="w", shape=ramp.T.shape, dtype="<i2", fill_value=None)
    stored[...] = ramp.T
    stored.attrs["axis_names"] = ["x", "y", "z"]
    case("axis_names", "named.zarr", ramp)
    # Integers with missing samples become floating-point numbers.
    whole = values[0].copy()
    add("whole", whole, ["level", "lat", "lon"], _FillValue=-999)
    case("xarray_whole", "xarray.zarr", np.where(whole == -999, np.nan, whole), steps, (10, 40, 0), array="whole")


def zip_cases():
    def pack(name, source, inside="", method=zipfile.ZIP_STORED):
        with zipfile.ZipFile(f"{FOLDER}/{name}.zip", "w", method) as archive:
            if inside:
                archive.writestr("__MACOSX/._a.zarr", b"of the Finder")
            for folder, _, files in os.walk(f"{FOLDER}/{source}"):
                for one in files:
                    path = os.path.join(folder, one)
                    archive.write(path, os.path.join(inside, os.path.relpath(path, f"{FOLDER}/{source}")))

    for case_of in ("ome5", "codec_zlib_C", "3_shard_start", "group_told"):
        of = next(one for one in CASES if one["name"] == case_of)
        for name, how in (("zip", {}), ("deflated", {"method": zipfile.ZIP_DEFLATED}),
                          ("inside", {"inside": "a.zarr"})):
            pack(f"{case_of}_{name}", of["path"], **how)
            CASES.append({**of, "name": f"{case_of}_{name}", "path": f"{case_of}_{name}.zip"})
            os.link(f"{FOLDER}/{case_of}.values", f"{FOLDER}/{case_of}_{name}.values")
    one = next(one for one in CASES if one["name"] == "ome5_array")
    CASES.append({**one, "name": "zip_inside", "path": "./ome5.zarr/../ome5_zip.zip/1", "request": {}})
    os.link(f"{FOLDER}/ome5_array.values", f"{FOLDER}/zip_inside.values")
    with open(f"{FOLDER}/cut.zarr.zip", "wb") as out, open(f"{FOLDER}/ome5_zip.zip", "rb") as whole:
        out.write(whole.read()[:-30])
    bad("zip_cut", "cut.zarr.zip", "damaged or truncated ZIP")
    with open(f"{FOLDER}/file.zarr", "wb") as out:
        out.write(b"no folder")
    bad("file", "file.zarr", "expected a folder or a ZIP archive")


def hdf5_cases():
    with h5py.File(f"{FOLDER}/types.h5", "w") as file:
        for i, dtype in enumerate(("u1", "i1", "<u2", ">u2", "<i2", ">i2", "<u4", ">i4", "<u8", ">i8", "<f2", "<f4",
                                   ">f4", "<f8", ">f8")):
            array = samples(dtype)
            name = "set_" + dtype.replace("<", "l").replace(">", "b")
            how = [{}, {"chunks": (2, 3, 4)}, {"chunks": (2, 3, 4), "compression": "gzip", "shuffle": True},
                   {"chunks": True, "fletcher32": True}][i % 4]
            file.create_dataset("group/" + name, data=array, **how)
            case("h5_" + name, f"types.h5:/group/{name}", array)
        case("h5_array", "types.h5", file["group/set_u1"][...], array="/group/set_u1")
    bad("h5_several", "types.h5", "/group/set_bf4", "expected one")
    bad("h5_none", "types.h5:/group/none", "no data set")
    with h5py.File(f"{FOLDER}/one.nc", "w") as file:
        array = samples(">i2", (3, 4, 5, 6))
        one = file.create_dataset("temperature", data=array, chunks=(1, 2, 5, 6), compression="gzip")
        one.attrs["scale_factor"] = .5
        one.attrs["add_offset"] = 10.
        for axis, (word, numbers) in enumerate((("time", [0, 1, 2]), ("level", [5, 3, 1, -1]),
                                                ("lat", [10, 20, 30, 40, 50]), ("lon", [0, .1, .2, .3, .4, .5]))):
            file.create_dataset(word, data=np.array(numbers, "f4"))
            file[word].make_scale(word)
            one.dims[axis].attach_scale(file[word])
        file.create_dataset("flat", data=np.zeros((4, 5)))
        steps = [[float(np.float32(.5)) / 5, 0, 0], [0, 10, 0], [0, 0, -2]]
        case("nc", "one.nc", array[0] * .5 + 10, steps, (0, 10, 5))
        case("nc_time", "one.nc", array[2] * .5 + 10, steps, (0, 10, 5), time=2)
        case("nc_flat", "one.nc:/flat", np.zeros((1, 4, 5)))
    with h5py.File(f"{FOLDER}/fill.nc", "w") as file:
        array = samples("<f4", (3, 4, 5))
        array[1, 2, 3] = -9999
        file.create_dataset("v", data=array).attrs["_FillValue"] = np.float32(-9999)
        file["v"].attrs["element_size_um"] = [4, 2, 1]
        file.create_dataset("thin", data=array, chunks=(1, 4, 5), compression="gzip")
        several = np.stack([array + step for step in range(3)])
        file.create_dataset("several", data=several, chunks=(2, 2, 3, 4))
        file.create_dataset("pairs", data=several[None].repeat(2, 0).astype(">u2"))
        case("nc_thin", "fill.nc:/thin", array)
        case("nc_several", "fill.nc:/several", several[1], time=1)
        case("nc_pairs", "fill.nc:/pairs", several[2].astype("u2"), time=1, channel=2)
        array[1, 2, 3] = np.nan
        case("nc_fill", "fill.nc:/v", array, [[1, 0, 0], [0, 2, 0], [0, 0, 4]])
    with h5py.File(f"{FOLDER}/empty.h5", "w") as file:
        file.create_dataset("v", shape=(1000, 1000, 1000), chunks=(100, 100, 100), dtype="f8")
        packed = samples("<u2")
        file.create_dataset("lzf", data=packed, compression="lzf")
        file.create_dataset("words", data=np.full((2, 2, 2), b"word"))
    bad("h5_empty", "empty.h5:/v", "no samples", "8000000000")
    case("h5_lzf", "empty.h5:/lzf", packed)
    bad("h5_words", "empty.h5:/words", "type")
    deep = "/g" * 2000  # the library takes minutes to go through such groups
    with h5py.File(f"{FOLDER}/deep.h5", "w") as file:
        group = file
        for _ in range(2000):
            group = group.create_group("g")
        array = np.arange(210, dtype="u1").reshape(5, 6, 7)
        group.create_dataset("v", data=array)
    bad("h5_deep", "deep.h5", "more than 64 deep", "the name of an array")
    case("h5_deep_named", "deep.h5", array, array=f"{deep}/v")
    array = samples("<i2")
    array.tofile(f"{FOLDER}/samples.raw")
    with h5py.File(f"{FOLDER}/target.h5", "w") as file:
        file["v"] = array
    with h5py.File(f"{FOLDER}/linked.h5", "w") as file:
        file["link"] = h5py.ExternalLink("target.h5", "/v")
        file["soft"] = h5py.SoftLink("/link")
    with h5py.File(f"{FOLDER}/outer.h5", "w") as file:
        file.create_dataset("v", array.shape, array.dtype, external=[(f"{FOLDER}/samples.raw", 0, array.nbytes)])
    with h5py.File(f"{FOLDER}/virtual.h5", "w") as file:
        layout = h5py.VirtualLayout(array.shape, array.dtype)
        layout[...] = h5py.VirtualSource(f"{FOLDER}/target.h5", "v", array.shape, array.dtype)
        file.create_virtual_dataset("v", layout)
    for name, path in (("link", "linked.h5:/link"), ("soft", "linked.h5:/soft"), ("outer", "outer.h5:/v"),
                       ("virtual", "virtual.h5:/v")):
        case(f"h5_{name}", path, array)


def slice_of(array, series, number, position, orientation, spacing, syntax=ExplicitVRLittleEndian, slope=None,
             intercept=None):
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = syntax
    data.file_meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
    data.SOPClassUID = data.file_meta.MediaStorageSOPClassUID
    data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID = generate_uid()
    data.is_little_endian = syntax != ExplicitVRBigEndian
    data.is_implicit_VR = syntax == ImplicitVRLittleEndian
    data.Modality = "CT"
    data.SeriesInstanceUID, data.SeriesDescription = series, "series " + series[-1]
    data.InstanceNumber = number
    data.Rows, data.Columns = array.shape[-2:]
    if array.ndim == 3:
        data.NumberOfFrames = array.shape[0]
    data.ImagePositionPatient = [f"{v:.10g}" for v in position]
    data.ImageOrientationPatient = [f"{v:.10g}" for v in orientation]
    data.PixelSpacing = [spacing[1], spacing[0]]  # between rows first
    data.SliceThickness = spacing[2]
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.BitsAllocated = data.BitsStored = 8 * array.dtype.itemsize
    data.HighBit = data.BitsStored - 1
    data.PixelRepresentation = int(array.dtype.kind == "i")
    if slope is not None:
        data.RescaleSlope, data.RescaleIntercept = slope, intercept
    if syntax == RLELossless:
        data.PixelData = array.tobytes()
        data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
        data.compress(RLELossless)
    else:
        data.PixelData = array.astype(array.dtype.newbyteorder(">")).tobytes() if not data.is_little_endian \
            else array.tobytes()
        data["PixelData"].VR = "OB" if array.dtype.itemsize == 1 else "OW"
    return data


def save_slices(name, slices):
    os.makedirs(f"{FOLDER}/{name}", exist_ok=True)
    order = RNG.permutation(len(slices))
    for place, data in zip(order, slices):
        data.save_as(f"{FOLDER}/{name}/IM{place:03}-{len(os.listdir(FOLDER + '/' + name))}", write_like_original=False)


def stack(array, series, along_row, along_column, spacing, origin, rescale=lambda i: (None, None), **how):
    normal = np.cross(along_row, along_column)
    return [slice_of(image, series, i + 1, np.asarray(origin) + i * spacing[2] * normal,
                     [*along_row, *along_column], spacing, slope=rescale(i)[0], intercept=rescale(i)[1], **how)
            for i, image in enumerate(array)]


def dicom_cases():
    axial = ([1, 0, 0], [0, 1, 0])
    oblique = (np.array([2, 1, 2]) / 3, np.array([-2, 2, 1]) / 3)
    spacing, origin = (.5, .75, 2), (-10, 20, 30.5)

    def steps(axes):
        return [np.asarray(axes[0]) * spacing[0], np.asarray(axes[1]) * spacing[1],
                np.cross(*axes) * spacing[2]]

    for dtype in ("u1", "<u2", "<i2"):
        for word, syntax in (("explicit", ExplicitVRLittleEndian), ("implicit", ImplicitVRLittleEndian),
                             ("big", ExplicitVRBigEndian), ("rle", RLELossless)):
            for where, axes in (("axial", axial), ("oblique", oblique)):
                array = samples(dtype, (5, 6, 8))
                name = f"dcm_{dtype.strip('<')}_{word}_{where}"
                save_slices(name, stack(array, "1.2.1", *axes, spacing, origin, syntax=syntax))
                case(name, name, array, steps(axes), origin)
    array = samples("<u2", (4, 6, 8)) % 4096
    save_slices("dcm_ct", stack(array, "1.2.1", *axial, spacing, origin, lambda i: (1, -1024)))
    case("dcm_ct", "dcm_ct", array.astype("i4") - 1024, steps(axial), origin)
    save_slices("dcm_pet", stack(array, "1.2.1", *axial, spacing, origin, lambda i: (.5 + i, 0)))
    case("dcm_pet", "dcm_pet", array * (.5 + np.arange(4))[:, None, None], steps(axial), origin)
    # From feet to head or from head to feet: the same volume.
    save_slices("dcm_down", stack(array, "1.2.1", *axial, spacing, origin)[::-1])
    case("dcm_down", "dcm_down", array, steps(axial), origin)

    save_slices("dcm_two", stack(array, "1.2.1", *axial, spacing, origin))
    save_slices("dcm_two", stack(array[:2] + 1, "1.2.2", *axial, spacing, origin))
    with open(f"{FOLDER}/dcm_two/notes.txt", "w") as out:
        out.write("no image")
    case("dcm_two", "dcm_two", array, steps(axial), origin)
    case("dcm_two_uid", "dcm_two", array[:2] + 1, steps(axial), origin, array="1.2.2")
    case("dcm_two_word", "dcm_two", array[:2] + 1, steps(axial), origin, array="series 2")
    bad("dcm_two_none", "dcm_two", "array", "series 3", "series 1", array="series 3")

    later = stack(array + 5, "1.2.1", *axial, spacing, origin)
    for data in later:
        data.InstanceNumber += 100
    save_slices("dcm_time", stack(array, "1.2.1", *axial, spacing, origin) + later)
    case("dcm_time", "dcm_time", array, steps(axial), origin)
    case("dcm_time_1", "dcm_time", array + 5, steps(axial), origin, time=1)

    frames = slice_of(array, "1.2.1", 1, origin, [1, 0, 0, 0, 1, 0], spacing)
    save_slices("dcm_frames", [frames])
    case("dcm_frames", "dcm_frames", array, steps(axial), origin)

    gap = stack(samples("u1", (6, 4, 4)), "1.2.1", *axial, spacing, origin)
    save_slices("dcm_gap", gap[:2] + gap[3:])
    bad("dcm_gap", "dcm_gap", "found 4 mm", "expected 2", "missing")
    turned = stack(samples("u1", (3, 4, 4)), "1.2.1", *axial, spacing, origin)
    turned[1].ImageOrientationPatient = [0, 1, 0, 1, 0, 0]
    save_slices("dcm_turned", turned)
    bad("dcm_turned", "dcm_turned", "ImageOrientationPatient", "another")
    tilted = stack(samples("u1", (3, 4, 4)), "1.2.1", *axial, spacing, origin)
    for i, data in enumerate(tilted):
        data.ImagePositionPatient[1] = str(float(origin[1]) + i)
    save_slices("dcm_tilted", tilted)
    bad("dcm_tilted", "dcm_tilted", "tilted gantry")
    mixed = stack(samples("u1", (3, 4, 4)), "1.2.1", *axial, spacing, origin)
    mixed[2] = slice_of(samples("u1", (4, 5)), "1.2.1", 3, (-10, 20, 34.5), [1, 0, 0, 0, 1, 0], spacing)
    save_slices("dcm_mixed", mixed)
    bad("dcm_mixed", "dcm_mixed", "4 x 4", "5 x 4")


if __name__ == "__main__":
    zarr_cases()
    zarr3_cases()
    ome_cases()
    xarray_cases()
    zip_cases()
    hdf5_cases()
    dicom_cases()
    kinds_of_dicom(sys.modules["__main__"])
    with open(FOLDER + "/cases.json", "w") as list_file:
        json.dump(CASES, list_file)
