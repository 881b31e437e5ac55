# SPDX-License-Identifier: Apache-2.0
"""A writer of Zarr version 3, after zarr-specs.readthedocs.io: core specification 3.0 and its codecs. Debian's zarr
knows version 2 only."""
import itertools
import json
import math
import os
import struct

import numcodecs
import numpy as np


def crc32c(data):
    """RFC 3720, B.4: the remainder of the polynomial 0x1edc6f41, with reflected bits."""
    rest = 0xffffffff
    for byte in data:
        rest ^= byte
        for _ in range(8):
            rest = rest >> 1 ^ (0x82f63b78 if rest & 1 else 0)
    return struct.pack("<I", rest ^ 0xffffffff)


assert crc32c(b"123456789") == struct.pack("<I", 0xe3069283)  # the check value of CRC-32C


def codec(name, **configuration):
    return {"name": name, "configuration": configuration} if configuration else {"name": name}


def shard(chunk_shape, codecs, index_codecs=None, **how):
    index = index_codecs or [codec("bytes", endian="little"), codec("crc32c")]
    return codec("sharding_indexed", chunk_shape=list(chunk_shape), codecs=codecs, index_codecs=index, **how)


PACKERS = {
    "gzip": lambda how, data: numcodecs.GZip(how.get("level", 5)).encode(data),
    "zstd": lambda how, data: numcodecs.Zstd(how.get("level", 3)).encode(data),
    "blosc": lambda how, data: numcodecs.Blosc(how["cname"], how["clevel"], {
        "noshuffle": 0, "shuffle": 1, "bitshuffle": 2}[how["shuffle"]]).encode(data),
    "crc32c": lambda how, data: data + crc32c(data),
}


def encoded(chunk, codecs, fill):
    """The bytes of a chunk; `fill`: inner chunks of nothing but this are left out."""
    for one in codecs:
        name, how = one["name"], one.get("configuration", {})
        if name == "transpose":
            chunk = chunk.transpose(how["order"])  # axis i of the result is axis order[i]
        elif name == "bytes":
            order = {"little": "<", "big": ">"}.get(how.get("endian"), "=")
            chunk = np.ascontiguousarray(chunk).astype(chunk.dtype.newbyteorder(order)).tobytes()
        elif name == "sharding_indexed":
            chunk = shard_of(chunk, how, fill)
        else:
            chunk = PACKERS[name](how, bytes(chunk))
    return bytes(chunk)


def shard_of(array, how, fill):
    counts = [size // edge for size, edge in zip(array.shape, how["chunk_shape"])]
    index = np.full([*counts, 2], 2**64 - 1, "u8")
    at_start = how.get("index_location") == "start"
    place = len(encoded(index, how["index_codecs"], fill)) if at_start else 0
    parts = []
    places = list(itertools.product(*(range(count) for count in counts)))
    for one in reversed(places):  # chunks may lie in any order
        inner = array[tuple(slice(i * edge, (i + 1) * edge) for i, edge in zip(one, how["chunk_shape"]))]
        if np.array_equal(inner, np.full_like(inner, fill), equal_nan=inner.dtype.kind == "f"):
            continue
        parts.append(encoded(inner, how["codecs"], fill))
        index[one] = place, len(parts[-1])
        place += len(parts[-1])
    index = encoded(index, how["index_codecs"], fill)
    return (index if at_start else b"") + b"".join(parts) + (b"" if at_start else index)


def write(folder, array, chunks, codecs=None, fill=0, fill_json=None, keys=None, **more):
    """`keys`: the chunk key encoding; `more`: members of zarr.json."""
    codecs = codecs or [codec("bytes", endian="little")]
    keys = keys or codec("default", separator="/")
    document = {"zarr_format": 3, "node_type": "array", "shape": list(array.shape), "data_type": array.dtype.name,
                "chunk_grid": codec("regular", chunk_shape=list(chunks)), "chunk_key_encoding": keys,
                "codecs": codecs, "fill_value": fill if fill_json is None else fill_json, **more}
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/zarr.json", "w") as out:
        json.dump(document, out)
    separator = keys.get("configuration", {}).get("separator", "/" if keys["name"] == "default" else ".")
    for place in itertools.product(*(range(math.ceil(size / edge)) for size, edge in zip(array.shape, chunks))):
        chunk = np.full(chunks, fill, array.dtype)
        part = array[tuple(slice(i * edge, (i + 1) * edge) for i, edge in zip(place, chunks))]
        chunk[tuple(slice(0, size) for size in part.shape)] = part
        if np.array_equal(chunk, np.full_like(chunk, fill), equal_nan=array.dtype.kind == "f"):
            continue
        name = separator.join((["c"] if keys["name"] == "default" else []) + [str(i) for i in place])
        os.makedirs(os.path.dirname(f"{folder}/{name}"), exist_ok=True)
        with open(f"{folder}/{name}", "wb") as out:
            out.write(encoded(chunk, codecs, fill))


def write_group(folder, **attributes):
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/zarr.json", "w") as out:
        json.dump({"zarr_format": 3, "node_type": "group", "attributes": attributes}, out)
