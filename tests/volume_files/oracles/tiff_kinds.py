# SPDX-License-Identifier: Apache-2.0
"""TIFF files whose pages mean something: descriptions by OME, ImageJ and tifffile."""
import os
import re
import struct

import numpy as np

from .cases import values_of

OME = '<?xml version="1.0" encoding="UTF-8"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"{}>{}</OME>'


def tiff_kinds(cases):
    import tifffile
    ome_units(cases, tifffile)
    ome_planes(cases, tifffile)
    ome_sets(cases, tifffile)
    imagej(cases, tifffile)
    shaped(cases, tifffile)
    others(cases, tifffile)
    folders(cases, tifffile)


def pixels(content, sizes=(12, 10, 8, 1, 1), order="XYZCT", more=""):
    """An image's XML; `sizes` along x, y, z, c and t."""
    x, y, z, c, t = sizes
    return (f'<Image ID="Image:0" Name="one"><Pixels ID="Pixels:0" DimensionOrder="{order}" Type="uint16" SizeX="{x}" '
            f'SizeY="{y}" SizeZ="{z}" SizeC="{c}" SizeT="{t}" {more}>{content}</Pixels></Image>')


def write(cases, tifffile, file, planes, xml, root=""):
    tifffile.imwrite(cases.path(file), planes, photometric="minisblack", metadata=None,
                     description=OME.format(root, xml).encode())


def ome_units(cases, tifffile):
    stack = values_of("uint16", (8, 10, 12), seed=41)
    for file, sizes, steps, unit in (
            ("dm", 'PhysicalSizeX="0.9" PhysicalSizeXUnit="µm" PhysicalSizeY="0.7" PhysicalSizeZ="2.5e-05" '
             'PhysicalSizeZUnit="dm"', (.9, .7, 2.5), "µm"),
            ("nm", 'PhysicalSizeX="0.9" PhysicalSizeXUnit="mm" PhysicalSizeY="700" PhysicalSizeZ="2.5E6" '
             'PhysicalSizeZUnit="nm"', (.9, .7, 2.5), "mm"),
            ("none", "", (1, 1, 1), ""),
            ("in", 'PhysicalSizeX="1" PhysicalSizeXUnit="in" PhysicalSizeY="25.4" PhysicalSizeYUnit="mm" '
             'PhysicalSizeZ="1000" PhysicalSizeZUnit="thou"', (1, 1, 1), "in")):
        write(cases, tifffile, f"unit_{file}.ome.tif", stack, pixels('<TiffData IFD="0" PlaneCount="8"/>', more=sizes))
        cases.add(f"unit_{file}.ome.tif", stack, np.diag(steps), unit=unit)
    write(cases, tifffile, "unit_odd.ome.tif", stack, pixels(
        "<TiffData/>", more='PhysicalSizeX="2" PhysicalSizeY="3" PhysicalSizeZ="4" PhysicalSizeZUnit="pixel"'))
    cases.add("unit_odd.ome.tif", stack, np.diag([2, 3, 4]), unit="µm", warnings=["the unit of z is 'pixel'"])
    write(cases, tifffile, "unit_z.ome.tif", stack, pixels("<TiffData/>", more='PhysicalSizeX="2" PhysicalSizeY="3"'))
    cases.add("unit_z.ome.tif", stack, np.diag([2, 3, 1]), warnings=["PhysicalSizeX, Y or Z is missing"])


def ome_planes(cases, tifffile):
    stack = values_of("uint16", (8, 10, 12), seed=42)
    backwards = "".join(f'<TiffData FirstZ="{7 - i}" IFD="{i}" PlaneCount="1"/>' for i in range(8))
    channels = "".join(f'<Channel ID="Channel:0:{i}" Name="dye {i}" SamplesPerPixel="1"/>' for i in range(2))
    write(cases, tifffile, "backwards.ome.tif", stack[::-1], pixels(channels + backwards))
    cases.add("backwards.ome.tif", stack, warnings=["2 Channel elements have 2 channels, SizeC is 1"])
    # Two times and two channels in an order that is not that of the pages.
    both = values_of("uint16", (2, 2, 8, 10, 12), seed=43)  # t, c, z
    parts = "".join(f'<TiffData FirstT="{t}" FirstC="{c}" IFD="{8 * (2 * c + t)}" PlaneCount="8"/>'
                    for t in range(2) for c in range(2))
    pages = np.moveaxis(both, 0, 1).reshape(32, 10, 12)
    write(cases, tifffile, "order.ome.tif", pages, pixels(channels + parts, (12, 10, 8, 2, 2), "XYZTC"))
    for t in range(2):
        for c in range(2):
            cases.add("order.ome.tif", both[t, c], time=t, channel=c)
    prefixed = re.sub(r"<(/?)(\w)", r"<\1ns0:\2", OME.format("", pixels(backwards)))
    tifffile.imwrite(cases.path("prefix.ome.tif"), stack[::-1], photometric="minisblack", metadata=None,
                     description=prefixed.encode())
    cases.add("prefix.ome.tif", stack)
    # Without an IFD all pages in a row, from FirstZ on.
    write(cases, tifffile, "rest.ome.tif", stack[[6, 7, 0, 1, 2, 3, 4, 5]], pixels(
        '<TiffData FirstZ="6" IFD="0" PlaneCount="2"/><TiffData IFD="2" PlaneCount="6"/>'))
    cases.add("rest.ome.tif", stack)
    write(cases, tifffile, "missing.ome.tif", stack, pixels('<TiffData IFD="0" PlaneCount="5"/>'))
    cases.refuse("missing.ome.tif", "slice 5 of channel 0, time 0 has no page: TiffData does not mention it")
    write(cases, tifffile, "beyond.ome.tif", stack[:4], pixels('<TiffData IFD="0" PlaneCount="8"/>'))
    cases.refuse("beyond.ome.tif", "IFD: found 4, expected up to 3")
    for part, words in (('<TiffData FirstZ="8" IFD="0"/>', "FirstZ: found 8, expected a number from 0 to 7"),
                        ('<TiffData IFD="0" PlaneCount="9"/>', "PlaneCount: found 9")):
        write(cases, tifffile, f"wrong{len(words)}.ome.tif", stack, pixels(part))
        cases.refuse(f"wrong{len(words)}.ome.tif", words)
    many = '<TiffData IFD="0" PlaneCount="1000000"/>' * 11
    write(cases, tifffile, "many.ome.tif", stack, pixels(many, (12, 10, 1000000, 1, 1)))
    cases.refuse("many.ome.tif", "TiffData: found more than 10000000 planes")
    write(cases, tifffile, "sizes.ome.tif", stack, pixels("<TiffData/>", (13, 10, 8, 1, 1)))
    cases.refuse("sizes.ome.tif", "found pages of 12 x 10 pixels", "13 x 10")
    two = pixels("<TiffData IFD='0' PlaneCount='8'/>") + pixels('<TiffData IFD="8" PlaneCount="4"/>', (12, 10, 4, 1, 1)).replace(
        "one", "two")
    write(cases, tifffile, "images.ome.tif", np.concatenate([stack, stack[:4] // 2]), two)
    cases.add("images.ome.tif", stack, warnings=['image "one" of 2 is taken'])
    cases.add("images.ome.tif", stack[:4] // 2, array="two")
    cases.refuse("images.ome.tif", 'array: found "three", expected one of "one", "two"', array="three")
    rgb = values_of("uint8", (4, 10, 12, 3), seed=44)
    tifffile.imwrite(cases.path("rgb.ome.tif"), rgb, photometric="rgb", metadata={"axes": "ZYXS"})
    cases.add("rgb.ome.tif", rgb[..., 1], channel=1, warnings=["its pixels are colours"])


def ome_sets(cases, tifffile):
    """A file for each channel, whose XML names both; metadata in a file of its own; a file that was renamed."""
    both = values_of("uint16", (2, 8, 10, 12), seed=45)

    def parts(names):
        return "".join(f'<TiffData FirstC="{c}" FirstZ="{z}" IFD="{z}" PlaneCount="1"><UUID FileName="{name}">urn:uuid:{c}</UUID>'
                       "</TiffData>" for c, name in enumerate(names) for z in range(8))

    sizes = (12, 10, 8, 2, 1)
    names = ["mf_c0.ome.tif", "mf_c1.ome.tif"]
    for c, name in enumerate(names):
        write(cases, tifffile, name, both[c], pixels(parts(names), sizes), f' UUID="urn:uuid:{c}"')
    for name in names:
        cases.add(name, both[0], warnings=["channel 0 of 2 is taken"])
        cases.add(name, both[1], channel=1)
    lost = ["lost_c0.ome.tif", "lost_c1.ome.tif", "lost_c2.ome.tif"]
    write(cases, tifffile, lost[0], both[0], pixels(parts(lost), (12, 10, 8, 3, 1)))
    cases.add(lost[0], both[0], warnings=["lost_c1.ome.tif: no such file: 2 of the 3 files that"])
    cases.refuse(lost[0], "lost_c1.ome.tif: file of the OME data set", "no such file", channel=1)
    write(cases, tifffile, "renamed.ome.tif", both[0], pixels(parts(["old.ome.tif"]), (12, 10, 8, 1, 1)), ' UUID="urn:uuid:0"')
    cases.add("renamed.ome.tif", both[0])
    only = ["only_c0.ome.tif", "only_c1.ome.tif"]
    for c, name in enumerate(only):
        write(cases, tifffile, name, both[c], '<BinaryOnly MetadataFile="only.companion.ome" UUID="urn:uuid:9"/>', f' UUID="urn:uuid:{c}"')
    cases.refuse(only[0], "only.companion.ome: metadata file of", "no such file")
    named = ["meta_c0.ome.tif", "meta_c1.ome.tif"]
    for c, name in enumerate(named):
        write(cases, tifffile, name, both[c], '<BinaryOnly MetadataFile="meta.companion.ome"/>')
    with open(cases.path("meta.companion.ome"), "w", encoding="utf-8") as out:
        out.write(OME.format("", pixels(parts(named), sizes)))
    for c, name in enumerate(named):
        cases.add(name, both[c], channel=c)
    os.makedirs(cases.path("set"))
    for c, name in enumerate(names):
        write(cases, tifffile, "set/" + name, both[c], pixels(parts(names), sizes))
    cases.add("set", both[1], channel=1)


def imagej(cases, tifffile):
    # A slice is as thick as the shorter side of a pixel, unless the file says more.
    flat = values_of("uint16", (10, 12), seed=45)
    for file, thickness, more in (("one_slice.tif", .25, {}), ("thick.tif", 3, {"spacing": 3})):
        tifffile.imwrite(cases.path(file), flat, imagej=True, resolution=(4, 2), metadata={"unit": "um", **more})
        cases.add(file, flat[None], np.diag([.25, .5, thickness]), unit="um")
    tifffile.imwrite(cases.path("flat.ome.tif"), flat, metadata={"axes": "YX", "PhysicalSizeX": .25, "PhysicalSizeY": .5})
    cases.add("flat.ome.tif", flat[None], np.diag([.25, .5, .25]), unit="µm")
    stack = values_of("uint16", (3, 8, 2, 10, 12), seed=46)  # t, z, c
    for order in "<>":
        file = f"truncated{order == '<'}.tif"
        tifffile.imwrite(cases.path(file), stack.astype(stack.dtype.newbyteorder(order)), imagej=True, resolution=(4, 2),
                         byteorder=order, metadata={"spacing": 2.5, "unit": "um", "axes": "TZCYX"})
        data = open(cases.path(file), "rb").read()
        # As ImageJ writes files above 4 GB: one page, and all samples behind it.
        with tifffile.TiffFile(cases.path(file)) as tiff:
            pages, link = len(tiff.pages), tiff.pages[0].offset + 2 + 12 * len(tiff.pages[0].tags)
            end = tiff.pages[0].dataoffsets[0] + stack.nbytes
        assert pages == 48
        data = data[:link] + bytes(4) + data[link + 4:]
        with open(cases.path(file), "wb") as out:
            out.write(data)
        for t, c in ((0, 0), (2, 1)):
            cases.add(file, stack[t, :, c], np.diag([.25, .5, 2.5]), unit="um", time=t, channel=c)
        with open(cases.path("cut_" + file), "wb") as out:
            out.write(data[:end - 1])
        cases.refuse("cut_" + file, "the description promises 12 x 10 x 2 x 8 x 3 uint16 samples")
    volume = values_of("uint16", (8, 10, 12), seed=47)

    def described(file, lines, resolution=(4, 2), planes=volume, **options):
        text = "ImageJ=1.53t\nimages=8\nslices=8\n" + "".join(line + "\n" for line in lines)
        tifffile.imwrite(cases.path(file), planes, photometric="minisblack", metadata=None, description=text,
                         resolution=resolution, **options)

    described("units.tif", ["unit=mm", "yunit=um", "zunit=nm", "spacing=3000000"], (4, .002))
    cases.add("units.tif", volume, np.diag([.25, .5, 3]), unit="mm")
    described("escaped.tif", ["unit=\\u00B5m", "spacing=2.0", "xorigin=3", "yorigin=-2", "zorigin=1.5"])
    cases.add("escaped.tif", volume, np.diag([.25, .5, 2]), (-.75, 1, -3), unit="µm")
    described("odd.tif", ["unit=mm", "zunit=sec", "spacing=2.0"])
    cases.add("odd.tif", volume, np.diag([.25, .5, 2]), warnings=["the unit of z is 'sec'"])
    described("flat.tif", ["unit=mm"])
    cases.add("flat.tif", volume, np.diag([.25, .5, 1]), warnings=["no spacing of slices"])
    described("signed.tif", ["cf=0", "c0=-32768.0", "c1=1.0", "spacing=2.0"])
    cases.add("signed.tif", (volume.astype(np.int32) - 32768).astype(np.int16), np.diag([.25, .5, 2]))
    described("line.tif", ["cf=0", "c0=10", "c1=0.5", "spacing=2.0"])
    cases.add("line.tif", 10 + .5 * volume, np.diag([.25, .5, 2]))
    described("curve.tif", ["cf=7", "c0=10", "c1=0.5", "spacing=2.0"])
    cases.add("curve.tif", volume, np.diag([.25, .5, 2]), warnings=["calibration function 7"])


def shaped(cases, tifffile):
    """tifffile's JSON: axes with and without names."""
    few, many = values_of("uint16", (3, 8, 10, 12), seed=48), values_of("uint16", (5, 8, 10, 12), seed=49)
    for name, array in (("few", few), ("many", many)):
        for truncate in (False, True):
            tifffile.imwrite(cases.path(f"{name}{truncate}.tif"), array, photometric="minisblack", truncate=truncate)
    for truncate in (False, True):
        cases.add(f"few{truncate}.tif", few[0], warnings=["the axis of 3 has no name and is taken for channels"])
        cases.add(f"few{truncate}.tif", few[2], channel=2)
        cases.add(f"few{truncate}.tif", few[2], time=2)
        cases.add(f"many{truncate}.tif", many[0], warnings=["the axis of 5 has no name and is taken for times"])
        cases.add(f"many{truncate}.tif", many[4], time=4)
    for axes in ("TZYX", "ZTYX", "CZYX", "ZCYX", "ZQYX"):
        array = values_of("uint16", tuple({"T": 3, "Z": 8, "C": 2, "Q": 5, "Y": 10, "X": 12}[axis] for axis in axes), seed=50)
        tifffile.imwrite(cases.path(f"{axes}.tif"), array, photometric="minisblack", metadata={"axes": axes})
        other = axes.replace("Z", "")[0]
        request = {"T": "time", "C": "channel", "Q": "time"}[other]
        cases.add(f"{axes}.tif", np.take(array, 1, axes.index(other)), **{request: 1})
    five = values_of("uint16", (2, 3, 8, 10, 12), seed=51)
    tifffile.imwrite(cases.path("five.tif"), five, photometric="minisblack")
    cases.add("five.tif", five[1, 2], time=1, channel=2, warnings=["taken for time, channel, z, y and x"])
    volume = values_of("uint16", (8, 20, 30), seed=52)
    tifffile.imwrite(cases.path("lengths.tif"), volume, photometric="minisblack", resolution=(4, 2), resolutionunit=1,
                     metadata={"axes": "ZYX", "spacing": 2.5, "unit": "um"})
    cases.add("lengths.tif", volume, np.diag([.25, .5, 2.5]), unit="um")
    # Slices as samples of a pixel, in planes of their own; as the depth of a page, in strips and in tiles.
    tifffile.imwrite(cases.path("separate.tif"), volume, photometric="minisblack", planarconfig="separate",
                     metadata={"axes": "ZYX"})
    cases.add("separate.tif", volume)
    tifffile.imwrite(cases.path("depth.tif"), volume, photometric="minisblack", volumetric=True)
    cases.add("depth.tif", volume)
    with tifffile.TiffWriter(cases.path("depth_twice.tif")) as out:
        for _ in range(2):
            out.write(volume, photometric="minisblack", volumetric=True)
    cases.refuse("depth_twice.tif", "page 1: found 8 images in strips")
    tifffile.imwrite(cases.path("far.tif"), volume, photometric="minisblack", bigtiff=True, truncate=True)
    with open(cases.path("far.tif"), "r+b") as file:
        file.seek(file.read().index(b"\x11\1\x10\0\1\0\0\0\0\0\0\0") + 12)  # the value of StripOffsets
        file.write(b"\xff" * 8)
    cases.refuse("far.tif", "whose samples are not in one piece")
    for order in "<>":
        file = f"depth_tiles{order == '<'}.tif"
        tifffile.imwrite(cases.path(file), volume, photometric="minisblack", tile=(4, 16, 16), byteorder=order)
        cases.add(file, volume)
    tifffile.imwrite(cases.path("depth_zlib.tif"), volume, photometric="minisblack", tile=(4, 16, 16), compression="zlib")
    cases.refuse("depth_zlib.tif", "found compressed tiles of 4 images each")
    rgb = values_of("uint8", (4, 10, 12, 3), seed=53)
    tifffile.imwrite(cases.path("shaped_rgb.tif"), rgb, photometric="rgb")
    cases.add("shaped_rgb.tif", rgb[..., 2], channel=2, warnings=["its pixels are colours"])
    planar = np.moveaxis(rgb, 3, 1)
    tifffile.imwrite(cases.path("shaped_planar.tif"), planar, photometric="rgb", planarconfig="separate")
    cases.add("shaped_planar.tif", rgb[..., 2], channel=2)
    with tifffile.TiffWriter(cases.path("series.tif")) as out:
        out.write(volume, photometric="minisblack")
        out.write(volume[:3], photometric="minisblack")
    cases.add("series.tif", volume, warnings=["found 11 pages, of which tifffile's description has 8"])


def others(cases, tifffile):
    volume = values_of("uint8", (4, 10, 12), seed=54)

    def plain(file, words, **options):
        tifffile.imwrite(cases.path(file), volume, metadata=None, **({"photometric": "minisblack"} | options))
        cases.add(file, volume, warnings=words)

    plain("white.tif", ["it says that 0 is white"], photometric="miniswhite")
    plain("palette.tif", ["indices of a palette"], photometric="palette",
          colormap=np.arange(768, dtype=np.uint16).reshape(3, 256))
    plain("inches.tif", ["its resolution, 1234.5 x 617.25 pixels an inch, is not used"], resolution=(1234.5, 617.25),
          resolutionunit=2)
    plain("turned.tif", ["its Orientation 3"], extratags=[(274, "H", 1, 3, True)])
    plain("words.tif", ["its description is in no form that lamina reads"], description="Voxel size 2 um")
    plain("scan.tif", ["its description is in no form that lamina reads"],
          description="frameNumbers = 1\nacquisitionNumbers = 1\nframeTimestamps_sec = 0.0\n")  # ScanImage
    plain("lsm.tif", ["what Zeiss (LSM) says"], extratags=[(34412, "B", 8, bytes(8), True)])
    plain("manager.tif", ["what Micro-Manager says"], extratags=[(51123, "s", 0, '{"Slices": 4, "Channels": 2}', True)])
    plain("nodata.tif", ["it says that -9999 is no data (GDAL_NODATA)"], extratags=[(42113, "s", 0, "-9999", True)])
    plain("geo.tif", ["GeoTIFF (ModelPixelScale)"], extratags=[(33550, "d", 3, (2., 2., 0.), True)])
    tifffile.imwrite(cases.path("stk.tif"), volume[0], metadata=None, extratags=[(33629, "I", 8, tuple(range(8)), True)])
    cases.refuse("stk.tif", "MetaMorph (STK)", "its slices lie behind its page")
    tifffile.imwrite(cases.path("slide.tif"), volume, photometric="minisblack", metadata=None, description="Aperio Image Library v1")
    cases.refuse("slide.tif", "Aperio (SVS)")
    with tifffile.TiffWriter(cases.path("levels.tif")) as out:
        out.write(volume, photometric="minisblack", subifds=2, metadata=None)
        for step in (2, 4):
            out.write(volume[:, ::step, ::step], photometric="minisblack", subfiletype=1, metadata=None)
    cases.add("levels.tif", volume, warnings=["2 smaller copies of its first page (SubIFDs) are not used"])
    half = values_of("float32", (4, 20, 30), seed=55).astype(np.float16)
    for order in "<>":
        for label, options in (("strips", {}), ("tiles", {"tile": (16, 16)}), ("behind", {"truncate": True}),
                               ("zlib", {"compression": "zlib", "predictor": True})):
            file = f"half_{label}{order == '<'}.tif"
            try:
                tifffile.imwrite(cases.path(file), half, byteorder=order, photometric="minisblack", **options)
            except (ImportError, ValueError, KeyError):  # predictors of imagecodecs
                os.remove(cases.path(file))
                continue
            cases.add(file, half.astype(np.float32))
    bitwise(cases, tifffile)
    cut_links(cases, tifffile, volume)
    tifffile.imwrite(cases.path("complex.tif"), np.zeros((4, 10, 12), "c8"), photometric="minisblack")
    cases.refuse("complex.tif", "found samples that are complex numbers of 64 bits")


def cut_links(cases, tifffile, volume):
    """Files that end inside the place of the next page, which lies behind the directory that ends the file."""
    for order in "<>":
        for big in (False, True):
            file = f"link{order == '<'}{big}.tif"
            for page in volume[:2]:
                tifffile.imwrite(cases.path(file), page, append=os.path.exists(cases.path(file)), byteorder=order,
                                 bigtiff=big, photometric="minisblack", metadata=None, software=False)
            with tifffile.TiffFile(cases.path(file)) as tiff:
                page, code = tiff.pages[0], order + ("Q" if big else "H")
                head = page.offset + struct.calcsize(code)
                link = head + (20 if big else 12) * len(page.tags)
            data = open(cases.path(file), "rb").read()
            cases.add(file, volume[:2])
            with open(cases.path("cut_" + file), "wb") as out:
                out.write(data[:link + 2])
            cases.refuse("cut_" + file, "page 1: the file ends before the place of the next page")


def bitwise(cases, tifffile):
    """Samples of 1 to 31 bits, whose rows begin with a byte, in strips and tiles; and compressions by name."""
    for bits, kind in ((1, "uint8"), (3, "uint8"), (4, "uint8"), (10, "uint16"), (12, "uint16"), (14, "uint16")):
        values = values_of("uint16", (2, 7, 13), seed=bits) % (1 << bits)

        def packed(rows):
            digits = (rows[..., None] >> np.arange(bits)[::-1] & 1).reshape(*rows.shape[:-1], -1)
            return np.packbits(digits.astype(np.uint8), axis=-1)
        for label in ("strips", "tiles"):
            pages = np.zeros((2, 16, 16), "uint16")
            pages[:, :7, :13] = values
            stored = packed(pages if label == "tiles" else values)
            file = cases.path(f"bits{bits}_{label}.tif")
            tags = {256: 13, 257: 7, 258: bits, 259: 1, 262: 1, 277: 1}
            tags.update({322: 16, 323: 16} if label == "tiles" else {278: 7})
            write_pages(file, tags, [page.tobytes() for page in stored])
            cases.add(f"bits{bits}_{label}.tif", values.astype(kind))
    for number, name in ((34712, "JPEG 2000"), (34887, "LERC"), (50002, "JPEG XL"), (60001, "unknown")):
        write_pages(cases.path(f"code{number}.tif"), {256: 2, 257: 2, 258: 8, 259: number, 262: 1, 277: 1, 278: 2},
                    [b"1234"] * 2)
        if number != 34887:  # some builds of libtiff have it
            cases.refuse(f"code{number}.tif", f"compressed as {name} (compression {number})", "Fiji or tifffile")


def write_pages(file, tags, pages):
    """Writes pages of one strip or tile each, all with the same tags, by TIFF 6.0."""
    places = (324, 325) if 322 in tags else (273, 279)
    out = bytearray(struct.pack("<2sHI", b"II", 42, 0))
    before = 4
    for page in pages:
        begin = len(out)
        out += page + b"\0" * (len(page) % 2)
        struct.pack_into("<I", out, before, len(out))
        entries = {**tags, places[0]: begin, places[1]: len(page)}
        out += struct.pack("<H", len(entries))
        for tag in sorted(entries):
            out += struct.pack("<HHII", tag, 4 if tag in places else 3, 1, entries[tag])
        before = len(out)
        out += struct.pack("<I", 0)
    with open(file, "wb") as stream:
        stream.write(out)


def folders(cases, tifffile):
    pages = values_of("uint16", (6, 10, 12), seed=56)

    def folder(name, files, **options):
        os.makedirs(cases.path(name))
        for file, page in files:
            tifffile.imwrite(cases.path(f"{name}/{file}.tif"), page, photometric="minisblack", **options)

    folder("gap", [(f"s{number:03d}", pages[i]) for i, number in enumerate((8, 9, 12, 13, 14, 20))])
    cases.add("gap", pages, warnings=["the numbers 10 to 11, 15 to 19 are missing"])
    folder("dyes_tiff", [(f"s{z}_ch0{c}", pages[3 * c + z]) for c in range(2) for z in range(3)])
    cases.refuse("dyes_tiff", "found 2 numbers that change in the names 's#_ch#.tif'")
    folder("stray", [("s1", pages[0]), ("s2", pages[1]), ("mask", pages[2])])
    cases.refuse("stray", "found 2 series of files")
    folder("cases", [("s1", pages[0]), ("s2", pages[1]), ("s3", pages[2])])
    os.rename(cases.path("cases/s2.tif"), cases.path("cases/s2.TIF"))
    cases.add("cases", pages[:3])
    open(cases.path("cases/notes.txt"), "w").close()
    open(cases.path("cases/s4.png"), "wb").write(b"\x89PNG")
    cases.add("cases", pages[:3], warnings=["2 of 5 files are no TIFF, and not used"])
    folder("letters", [("a", pages[0]), ("b", pages[1])])
    cases.add("letters", pages[:2], warnings=["alphabetical order"])
    # A stack in each file: times.
    stacks = values_of("uint16", (6, 3, 10, 12), seed=57)
    folder("stacks", [(f"t{t}", stacks[t]) for t in range(6)], metadata={"axes": "ZYX"})
    cases.add("stacks", stacks[4], time=4)
    folder("bare_stacks", [(f"t{t}", stacks[t]) for t in range(6)], metadata=None)
    cases.add("bare_stacks", stacks[0], warnings=["the axis of 6 has no name and is taken for times"])
    cases.add("bare_stacks", stacks[4], time=4)
    folder("few_stacks", [(f"c{c}", stacks[c]) for c in range(3)], metadata=None)
    cases.add("few_stacks", stacks[0], warnings=["the axis of 3 has no name and is taken for channels"])
    cases.add("few_stacks", stacks[2], channel=2)
    # As many pages as three stacks of three, but in other files.
    parts = [stacks[0], stacks[1, :2], np.concatenate([stacks[1, 2:], stacks[2]])]
    folder("split_stack", [(f"s{i}", part) for i, part in enumerate(parts)], metadata=None)
    cases.add("split_stack", np.concatenate(parts), warnings=["all are taken for slices"])
