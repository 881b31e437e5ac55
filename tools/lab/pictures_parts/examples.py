# SPDX-License-Identifier: Apache-2.0
"""Pictures of README.md's first line, docs/gallery.md and docs/start/ten-tasks.md: what the pages' own commands draw."""
import pathlib
import shutil
import tempfile

from pictures_parts.learn import run_page

GALLERY = ("face", "labels", "jet", "flow", "cells")
TASKS = ("upright", "left", "half", "brighter", "colours", "scale", "transparent", "labels")
FILMS = ("turn", "jet")


def reduced(picture, path):
    """Writes a picture with 128 colours, unless it is transparent: few opacities make blots."""
    from PIL import Image
    image = Image.open(picture)
    if image.mode != "RGBA":
        image = image.convert("RGB").quantize(128, kmeans=2)
    image.save(path, optimize=True)


def gallery(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("gallery.md", lamina, folder)
        shutil.copyfile(folder / "head.png", images / "hero.png")
        for picture in GALLERY:
            reduced(folder / f"{picture}.png", images / f"gallery-{picture}.png")


def tasks(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("start/ten-tasks.md", lamina, folder)
        for picture in TASKS:
            reduced(folder / f"{picture}.png", images / f"task-{picture}.png")
        for film in FILMS:  # pages show an animated PNG under the name of a PNG
            shutil.copyfile(folder / f"{film}.apng", images / f"task-{film}.png")
