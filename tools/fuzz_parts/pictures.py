# SPDX-License-Identifier: Apache-2.0
"""Pictures as arrays [row, column, RGBA]: OpenEXR files with ZIP compression, as lamina writes them, and NPY files."""
import struct
import zlib

import numpy


def read(path):
    if path.suffix == ".npy":
        return numpy.load(path)
    return read_exr(path.read_bytes())


def attributes(data):
    """By name, and the place after them."""
    found, place = {}, 8
    while data[place]:
        name_end = data.index(b"\0", place)
        kind_end = data.index(b"\0", name_end + 1)
        size, = struct.unpack_from("<i", data, kind_end + 1)
        found[data[place:name_end].decode()] = data[kind_end + 5:kind_end + 5 + size]
        place = kind_end + 5 + size
    return found, place + 1


def read_exr(data):
    header, place = attributes(data)
    if data[:4] != b"\x76\x2f\x31\x01" or header["compression"] != b"\x03":
        raise ValueError("expected an OpenEXR file with ZIP compression")
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    picture = numpy.empty((height, width, 4))
    for chunk, in struct.iter_unpack("<Q", data[place:place + 8 * ((height + 15) // 16)]):
        row, size = struct.unpack_from("<ii", data, chunk)
        first = row - top
        lines = min(16, height - first)
        packed = data[chunk + 8:chunk + 8 + size]
        plain = packed if size == lines * width * 16 else unpacked(packed)
        floats = numpy.frombuffer(plain, "<f4").reshape(lines, 4, width)  # channels A, B, G, R
        picture[first:first + lines] = floats.transpose(0, 2, 1)[..., ::-1]
    return picture


def unpacked(packed):
    steps = numpy.frombuffer(zlib.decompress(packed), "u1").astype(numpy.int64)
    steps[1:] -= 128
    halves = (numpy.cumsum(steps) & 255).astype("u1")
    plain = numpy.empty_like(halves)
    half = (len(halves) + 1) // 2
    plain[0::2], plain[1::2] = halves[:half], halves[half:]
    return plain.tobytes()
