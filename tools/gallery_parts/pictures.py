# SPDX-License-Identifier: Apache-2.0
"""One data set as two pictures, each by a program of its own."""
import dataclasses
import pathlib
import subprocess
import sys
import time


@dataclasses.dataclass
class Side:
    picture: str  # name of a PNG beside the page
    seconds: float
    said: str  # what the program says of its choices
    error: str


@dataclasses.dataclass
class Drawn:
    name: str
    ours: Side
    theirs: Side


def timed(command, picture):
    start = time.perf_counter()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    seconds = time.perf_counter() - start
    error = "" if done.returncode == 0 else done.stderr.strip().splitlines()[-1] if done.stderr else "failed"
    return Side(picture.name, seconds, done.stderr.strip(), error)


def draw(data_set, options):
    name, file = data_set
    ours, theirs = (options.output / f"{name}-{side}.png" for side in ("lamina", "vtk"))
    width, height = options.pixels
    mine = timed([options.lamina, "render", file, "-o", ours, "--size", options.size, *options.arguments], ours)
    if options.no_vtk:
        return Drawn(name, mine, Side(theirs.name, 0, "", "") if theirs.exists() else None)
    side = pathlib.Path(__file__).parent / "vtk_defaults.py"
    return Drawn(name, mine, timed(["xvfb-run", "-a", sys.executable, "-B", side, file, theirs, width, height], theirs))
