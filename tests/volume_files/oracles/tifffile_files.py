# SPDX-License-Identifier: Apache-2.0
"""TIFF files by tifffile, and by Pillow those compressions that it has through libtiff."""
import os
import sys

import numpy as np

from .cases import TYPES, values_of
from .picture_files import picture_files
from .tiff_kinds import tiff_kinds


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
    tiff_kinds(cases)
    pillow_files(cases)
    picture_files(cases)


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
    # JPEG loses some: what Pillow reads back, with the same libjpeg.
    smooth = [Image.fromarray(np.uint8(128 + 90 * np.sin(np.arange(2000).reshape(40, 50) / (9 + i)))) for i in range(3)]
    smooth[0].save(cases.path("pillow_jpeg.tif"), save_all=True, append_images=smooth[1:], compression="jpeg")
    with Image.open(cases.path("pillow_jpeg.tif")) as stored:
        read_back = []
        for page in range(3):
            stored.seek(page)
            read_back.append(np.asarray(stored).copy())
    cases.add("pillow_jpeg.tif", np.stack(read_back))
