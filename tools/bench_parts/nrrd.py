# SPDX-License-Identifier: Apache-2.0
"""Volumes of bytes, shorts or floats from NRRD files with the data in them, as lamina places them in the world."""
import gzip

import numpy

TYPES = {"uint8": "u1", "uchar": "u1", "unsigned char": "u1", "uint16": "<u2", "ushort": "<u2", "int16": "<i2",
         "short": "<i2", "float": "<f4"}


def spacings_of(fields):
    """Edges of a voxel; None if the axes are not those of the world."""
    if "space directions" not in fields:
        return [float(spacing) for spacing in fields.get("spacings", "1 1 1").split()]
    rows = [[float(x) for x in row.strip("()").split(",")] for row in fields["space directions"].split()
            if row != "none"]
    straight = all((rows[i][j] > 0) == (i == j) and rows[i][j] >= 0 for i in range(3) for j in range(3))
    return [rows[i][i] for i in range(3)] if straight else None


def read(path):
    """Samples (x fastest, flat), sizes and spacings; of several times the first."""
    header, _, data = path.read_bytes().partition(b"\n\n")
    fields = dict(line.split(": ", 1) for line in header.decode("ascii", "replace").splitlines()
                  if ": " in line and not line.startswith("#"))
    spacings = spacings_of(fields)
    if fields.get("type") not in TYPES or "data file" in fields or spacings is None \
            or fields.get("encoding") not in ("raw", "gzip", "gz") or fields.get("endian", "little") != "little":
        raise SystemExit(f"bench: {path}: expected an attached NRRD of {', '.join(TYPES)}, little endian, raw or gzip, "
                         "whose axes are the world's")
    if fields["encoding"] != "raw":
        data = gzip.decompress(data)
    sizes = [int(size) for size in fields["sizes"].split()][:3]
    return numpy.frombuffer(data, TYPES[fields["type"]], count=numpy.prod(sizes)), sizes, spacings
