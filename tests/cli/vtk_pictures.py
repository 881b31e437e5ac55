#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opacity and colours as VTK means them: the pictures of VTK's GPU ray caster beside those of lamina.

    vtk_pictures.py LAMINA FOLDER [VOLUME.nrrd ...]

Each volume is drawn twice with spacings of its own, by a transfer function of two points of opacity, once with
spacing 1 and once with another. lamina draws with color_space "display"; VTK samples each ray every .05 voxels.
Opacity ends below 1: VTK reads the opacity of a step, 1 - (1 - opacity)^(step / unit), from a table, in straight lines
between entries, so that values just below opacity 1 get much of what only opacity 1 has.
Prints the mean difference of the codes of both pictures over the pixels where either shows something, and exits with 1
where one is above 1.5, with 77 where VTK or a display is not there. Volumes: three that lamina generates, or those
that are named.
"""
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

SIZE = [96, 72]
STEPS_A_VOXEL = 20
MOST = 1.5  # codes
GENERATED = {"gaussians": ["--size", "40,36,32"], "marschner-lobb": ["--size", "41,41,41", "--type", "uint16"],
             "sheets": ["--size", "32,32,32", "--type", "float"]}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def ensure_vtk():
    if not importlib.util.find_spec("vtk"):
        skip("python3-vtk9 is not installed")
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("xvfb-run") or not shutil.which("xauth"):
        skip("no display, and xvfb or xauth is not installed")
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 640x480x24", sys.executable, *sys.argv])


def run(lamina, *arguments):
    subprocess.run([lamina, *map(str, arguments)], check=True)


def with_spacings(source, target, spacings):
    """The volume at the origin with other spacings; both read them from the file."""
    import numpy
    from bench_parts import nrrd
    samples, sizes, _ = nrrd.read(source)
    types = {"u1": "uint8", "<u2": "uint16", "<i2": "int16", "<f4": "float"}
    text = f"NRRD0004\ntype: {types[samples.dtype.str.lstrip('|')]}\ndimension: 3\nsizes: {' '.join(map(str, sizes))}\n" \
           f"spacings: {' '.join(map(str, spacings))}\nendian: little\nencoding: raw\n\n"
    target.write_bytes(text.encode() + samples.tobytes())
    return float(numpy.min(samples)), float(numpy.max(samples)), sizes


def scene_of(volume, low, high, box, opacity, unit_length):
    """Looks at the box from a corner; shows what is above a quarter of the range."""
    middle = [edge / 2 for edge in box]
    reach = max(box)
    return {"version": 1, "volume": str(volume),
            "transfer_function": {"unit_length": unit_length, "points": [
                {"value": low + 0.25 * (high - low), "color": [0.9, 0.2, 0.1], "opacity": 0},
                {"value": high, "color": [1, 0.9, 0.4], "opacity": opacity}]},
            "camera": {"eye": [middle[0] + 1.1 * reach, middle[1] + 0.6 * reach, middle[2] + 1.5 * reach],
                       "center": middle, "up": [0, 1, 0], "fov_y": 35},
            "image": {"width": SIZE[0], "height": SIZE[1], "color_space": "display"},
            "render": {"method": "trace"}}


def lamina_codes(lamina, scene_file, picture):
    """Reads a PNG of lamina's by VTK."""
    import vtk
    from vtk.util import numpy_support
    run(lamina, "render", scene_file, "-o", picture, "--quiet")
    reader = vtk.vtkPNGReader()
    reader.SetFileName(str(picture))
    reader.Update()
    pixels = numpy_support.vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(SIZE[1], SIZE[0], 3)[::-1]


def mean_difference(a, b):
    """Over the pixels where either is not black, and how many these are."""
    import numpy
    shows = (a.max(axis=2) > 0) | (b.max(axis=2) > 0)
    return float(numpy.abs(a.astype(int) - b.astype(int))[shows].mean()), int(shows.sum())


def compare(lamina, folder, source, spacings, opacity, unit_length):
    from bench_parts import scenes, vtk_side
    volume, scene_file = folder / "volume.nrrd", folder / "scene.json"
    low, high, sizes = with_spacings(source, volume, spacings)
    box = [(count - 1) * spacing for count, spacing in zip(sizes, spacings)]
    scene_file.write_text(json.dumps(scene_of(volume, low, high, box, opacity, unit_length)))
    window = vtk_side.volume_window(scenes.BenchScene("vtk", scene_file), SIZE, STEPS_A_VOXEL)
    theirs = window.codes()
    window.close()
    return mean_difference(theirs, lamina_codes(lamina, scene_file, folder / "lamina.png"))


def main():
    ensure_vtk()
    lamina, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    sources = [pathlib.Path(path) for path in sys.argv[3:]]
    for name, arguments in {} if sources else GENERATED.items():
        sources.append(folder / f"{name}.nrrd")
        run(lamina, "generate", name, "-o", sources[-1], *arguments)
    missed = False
    for source in sources:
        for spacings, opacity, unit_length in (([1, 1, 1], 0.9, 4), ([0.5, 0.7, 1.1], 0.99, 3)):
            mean, shown = compare(lamina, folder, source, spacings, opacity, unit_length)
            print(f"{source.stem:16} spacings {spacings}, opacity to {opacity}: mean {mean:.3f} codes over {shown} pixels",
                  flush=True)
            missed = missed or not mean <= MOST or shown < 400
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
