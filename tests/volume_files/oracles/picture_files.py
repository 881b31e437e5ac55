# SPDX-License-Identifier: Apache-2.0
"""Folders of PNG and JPEG files by Pillow: slices by the numbers in their names."""
import os

import numpy as np

from .cases import values_of


def picture_files(cases):
    try:
        from PIL import Image
    except ImportError:
        return

    def stack(name, pages, numbers=None, ending="png", mode=None, **options):
        os.makedirs(cases.path(name))
        for i, page in enumerate(pages):
            number = numbers[i] if numbers else i + 1
            picture = page if isinstance(page, Image.Image) else Image.fromarray(page, mode)
            picture.save(cases.path(f"{name}/scan_{number}.{ending}"), **options)

    grey, deep = values_of("uint8", (12, 9, 8), seed=31), values_of("uint16", (11, 9, 8), seed=32)
    stack("grey", grey)  # 10 comes after 9
    cases.add("grey", grey)
    cases.add("grey/scan_10.png", grey[9:10])
    stack("deep", deep, mode="I;16")
    cases.add("deep", deep)
    stack("gaps", grey[:4], [2, 3, 7, 12])
    cases.add("gaps", grey[:4], warnings=["the numbers 4 to 6, 8 to 11 are missing"])
    stack("tens", grey[:4], [10, 20, 30, 50])
    cases.add("tens", grey[:4], warnings=["the numbers 40 are missing"])
    for mode, channels in (("RGB", 3), ("RGBA", 4), ("LA", 2)):
        pages = values_of("uint8", (3, 9, 8, channels), seed=33)
        stack(mode, pages, mode=mode)
        cases.add(mode, pages[..., 0], warnings=[f"channel 0 of {channels} is taken"] +
                  (["its pixels are colours, which are read as channels"] if channels > 2 else []))
        cases.add(mode, pages[..., channels - 1], channel=channels - 1)
    palette = [Image.fromarray(page).quantize(16) for page in grey[:3]]
    stack("palette", palette)
    cases.add("palette", np.stack([np.asarray(page.convert("RGB"))[..., 1] for page in palette]), channel=1,
              warnings=["colours of a palette"])
    bits = [Image.fromarray(page > 100) for page in grey[:3]]
    stack("bits", bits)
    cases.add("bits", (grey[:3] > 100).astype(np.uint8) * np.uint8(255),
              warnings=["its 1 bits of grey are stretched to 0 to 255"])
    smooth = np.stack([np.uint8(128 + 90 * np.sin(np.arange(2000).reshape(40, 50) / (9 + i))) for i in range(3)])
    for ending, progressive in (("jpg", False), ("jpeg", True)):
        stack("grey_" + ending, smooth, ending=ending, progressive=progressive)
        read_back = [np.asarray(Image.open(cases.path(f"grey_{ending}/scan_{i}.{ending}"))) for i in (1, 2, 3)]
        cases.add("grey_" + ending, np.stack(read_back))
    stack("rgb_jpg", np.stack([smooth, smooth[:, ::-1], smooth[:, :, ::-1]], axis=3), ending="jpg", exif=b"Exif\0\0" + bytes(500))
    read_back = [np.asarray(Image.open(cases.path(f"rgb_jpg/scan_{i}.jpg"))) for i in (1, 2, 3)]
    cases.add("rgb_jpg", np.stack(read_back)[..., 2], channel=2, warnings=["its pixels are colours"])
    beside_pixels(cases, grey, smooth, stack)
    refused(cases, grey, smooth, stack)


def beside_pixels(cases, grey, smooth, stack):
    """Writes pictures that say what is not used: the distances of pixels, transparent colours, an orientation."""
    from PIL import Image
    turned = Image.Exif()
    turned[274] = 6
    words = ["its Orientation 6 says that the first pixel is not at the top left"]
    stack("uneven", grey[:3], dpi=(1000, 500))
    cases.add("uneven", grey[:3], warnings=["it says that pixels are 2 times as high as wide"])
    stack("uneven_jpg", smooth, ending="jpg", dpi=(100, 400))
    read_back = [np.asarray(Image.open(cases.path(f"uneven_jpg/scan_{i}.jpg"))) for i in (1, 2, 3)]
    cases.add("uneven_jpg", np.stack(read_back), warnings=["it says that pixels are 0.25 times as high as wide"])
    stack("transparent", grey[:3], transparency=0)
    cases.add("transparent", grey[:3], warnings=["its transparent colours (PNG's tRNS) are not used"])
    stack("turned_png", grey[:3], exif=turned)
    cases.add("turned_png", grey[:3], warnings=words)
    stack("turned_jpg", smooth, ending="jpg", exif=turned)
    read_back = [np.asarray(Image.open(cases.path(f"turned_jpg/scan_{i}.jpg"))) for i in (1, 2, 3)]
    cases.add("turned_jpg", np.stack(read_back), warnings=words)


def refused(cases, grey, smooth, stack):
    from PIL import Image
    stack("sizes", [grey[0], grey[1][:5]])
    cases.refuse("sizes", "scan_2.png: found 8 x 5 pixels of 1 8-bit samples, expected 8 x 9 pixels of", "as in scan_1.png")
    stack("types", [Image.fromarray(grey[0]), Image.fromarray(grey[0]).convert("RGB")])
    cases.refuse("types", "scan_2.png: found 8 x 9 pixels of 3 8-bit samples")
    for name, names in (("two", ["a_1", "a_2", "b_1", "b_2"]), ("dyes", ["z1_c1", "z2_c1", "z1_c2", "z2_c2"])):
        os.makedirs(cases.path(name))
        for i, file in enumerate(names):
            Image.fromarray(grey[i]).save(cases.path(f"{name}/{file}.png"))
    cases.refuse("two", "found 2 series of files, such as 2 of 'a_#.png' and 2 of 'b_#.png'")
    cases.refuse("dyes", "found 2 numbers that change in the names 'z#_c#.png'")
    stack("cmyk", [Image.fromarray(smooth[0]).convert("CMYK")], ending="jpg")
    cases.refuse("cmyk", "found 4 components of 8 bits")
    for file in ("grey/scan_1.png", "grey_jpg/scan_1.jpg", "grey_jpeg/scan_1.jpeg"):
        with open(cases.path(file), "rb") as stored:
            data = stored.read()
        for most in (20, len(data) * 2 // 3):
            cut = f"cut{most}_{os.path.basename(file)}"
            with open(cases.path(cut), "wb") as out:
                out.write(data[:most])
            cases.refuse(cut, cut)
