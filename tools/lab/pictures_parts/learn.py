# SPDX-License-Identifier: Apache-2.0
"""Pictures of docs/start and docs/learn. The pages' own commands draw them: their ```sh blocks are run in an empty folder,
and what they wrote is put side by side. The page about VTK needs Debian's python3-vtk9, xvfb and xauth."""
import csv
import os
import pathlib
import re
import subprocess
import tempfile

DOCS = pathlib.Path(__file__).resolve().parents[3] / "docs"
INK, GREY, PALE, ORANGE, BLUE = "#1a1a1a", "#707070", "#d0d0d0", "#d55e00", "#0072b2"
GAP = 8

# Measurements of `lamina study` from when docs/learn/a-study.md was written: name, ms a frame, L2, on the front.
STUDY = [("64", "post", 66.4, 2.95, True), ("256", "post", 95.8, .351, True), ("1024", "post", 210, .0235, False),
         ("64", "post, 8 bits", 66.7, 3.00, False), ("256", "post, 8 bits", 99.8, 4.20, False),
         ("1024", "post, 8 bits", 244, 14.2, False),
         ("64", "pre", 102, .970, False), ("256", "pre", 154, .0494, False), ("1024", "pre", 415, .00231, False),
         ("64", "pre, 8 bits", 97.7, 1.13, False), ("256", "pre, 8 bits", 174, 4.12, False),
         ("1024", "pre, 8 bits", 477, 14.1, False), ("", "exact", 112, 1.83e-3, True)]

LABELS = {("64", "post"): (-14, 8, "rm"), ("64", "post, 8 bits"): (14, -8, "lm"), ("64", "pre, 8 bits"): (-14, -8, "rm"),
          ("64", "pre"): (14, 10, "lm"), ("256", "post"): (-14, 0, "rm"), ("1024", "pre, 8 bits"): (0, 24, "mm")}


def font(size):
    from PIL import ImageFont
    return ImageFont.truetype("DejaVuSans.ttf", size)


def environment(lamina):
    """The page's programs find lamina, its module, and Debian's Python first."""
    programs = pathlib.Path(lamina).resolve().parent
    return {**os.environ, "PATH": f"/usr/bin:{programs}:{os.environ['PATH']}", "PYTHONPATH": str(programs / "python"),
            "PYTHONDONTWRITEBYTECODE": "1"}


def run_page(page, lamina, folder, first=0, last=None):
    """Runs a page's ```sh blocks, all of them or those from `first` up to `last`, in `folder`."""
    blocks = re.findall(r"^```sh\n(.*?)^```", (DOCS / page).read_text(encoding="utf-8"), re.S | re.M)
    for block in blocks[first:last]:
        subprocess.run(["bash", "-e", "-c", block], cwd=folder, env=environment(lamina), check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def sheet(panels, path, columns=2, colors=128):
    """Pictures with a line of words below each, on white, side by side."""
    from PIL import Image, ImageDraw
    pictures = [(Image.open(picture).convert("RGB") if isinstance(picture, pathlib.Path) else picture, words)
                for picture, words in panels]
    width, height = (max(size) for size in zip(*(picture.size for picture, _ in pictures)))
    letters = round(columns * width / 26)
    band = round(1.6 * letters)
    rows = -(-len(pictures) // columns)
    whole = Image.new("RGB", (columns * (width + GAP) - GAP, rows * (height + band)), "white")
    draw = ImageDraw.Draw(whole)
    for index, (picture, words) in enumerate(pictures):
        left, top = index % columns * (width + GAP), index // columns * (height + band)
        whole.paste(picture, (left, top))
        draw.text((left + 2, top + height + letters // 5), words, INK, font(letters))
    whole.quantize(colors, kmeans=3).save(path, optimize=True)


def start(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("start/first-five-minutes.md", lamina, folder)
        sheet([(folder / "head.png", "at first"), (folder / "face.png", "turned"),
               (folder / "bone.png", "bone alone")], images / "start-head.png", columns=3)
        sheet([(folder / "flow.png", "the flow past a cylinder")], images / "start-flow.png", columns=1)


def annotations(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        run_page("annotations.md", lamina, pathlib.Path(name))
        (images / "annotations.png").write_bytes((pathlib.Path(name) / "blobs.png").read_bytes())


def transfer_function(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("learn/transfer-function-and-camera.md", lamina, folder)
        sheet([(folder / "skin.png", "exact"), (folder / "missed.png", "64 samples a ray")],
              images / "learn-scene-peak.png", colors=32)
        sheet([(folder / "body.png", "body.png"), (folder / "turn_01.png", "turn_01.png"),
               (folder / "cut.png", "cut.png"), (folder / "lit.png", "lit.png")], images / "learn-scene-head.png")


def precision(lamina, images):
    from PIL import Image, ImageDraw
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("learn/a-precision-problem.md", lamina, folder)
        sheet([(folder / "right.png", "right"), (folder / "rough.png", "1024 slabs in 8 bits")],
              images / "learn-precision-rough.png")
        tree = Image.open(folder / "tree-difference.png").convert("RGB")
        words = "below 1 / 255:\nnothing to see"
        ImageDraw.Draw(tree).text((tree.width / 2, 110), words, INK, font(28), "mm", align="center")
        sheet([(folder / "rough-difference.png", "blended in 8 bits"), (tree, "by a tree")],
              images / "learn-precision-difference.png")


def meshes(lamina, images):
    """A part of the flow, three times as large as on the page, so that the wrong stripes can be seen."""
    from PIL import Image, ImageDraw
    part = (230, 200, 550, 440)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("learn/meshes.md", lamina, folder, last=2)
        for order in "exact", "none":
            for suffix in "png", "exr":
                subprocess.run([lamina, "render", "flow.json", "-o", f"{order}.{suffix}", "--quiet", "--set=image.width=960",
                                "--set=image.height=720", f"--set=render.project.order={order}"], cwd=folder, check=True)
        subprocess.run([lamina, "compare", "none.exr", "exact.exr", "--diff", "difference.png", "--range", "25"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        exact, none, difference = (Image.open(folder / f"{what}.png").convert("RGB").crop(part)
                                   for what in ("exact", "none", "difference"))
        whole = Image.open(folder / "flow.png").convert("RGB")
        ImageDraw.Draw(whole).rectangle([round(edge / 3) for edge in part], outline="white", width=2)
        sheet([(whole, "the whole picture"), (exact, "right order"), (none, "the file's order"),
               (difference, "its difference")], images / "learn-meshes-order.png", colors=256)


def strip(codes):
    """Codes 0..255 of a ramp as a picture, 2 pixels a column."""
    from PIL import Image
    row = Image.new("L", (len(codes), 1))
    row.putdata([max(0, min(255, round(code))) for code in codes])
    return row.resize((2 * len(codes), 48), Image.Resampling.NEAREST).convert("RGB")


def papers(lamina, images):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("learn/the-two-papers.md", lamina, folder, last=1)
        columns = {}
        for item in "figure2", "figure9":
            with open(folder / f"lamar/{item}.csv", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            columns.update({f"{item} {key}": [float(row[key]) for row in rows] for key in rows[0]})
        panels = [("figure2 software", "as it should be"), ("figure2 N=16", "16 slabs, 8 bits"),
                  ("figure2 N=64", "64 slabs, 8 bits"), ("figure2 N=256", "256 slabs, 8 bits"),
                  ("figure9 16x16", "256 slabs, tree 16x16"), ("figure9 4x4x4x4", "256 slabs, tree 4x4x4x4")]
        sheet([(strip(columns[key]), words) for key, words in panels], images / "learn-papers-ramp.png", columns=1)


def study(images):
    """Error against time of STUDY, both logarithmic, with the Pareto front."""
    import math
    from PIL import Image, ImageDraw
    width, height, left, right, top, bottom = 720, 560, 104, 20, 20, 70
    whole = Image.new("RGB", (width, height), "white")
    draw = ImageDraw.Draw(whole)

    def place(ms, error):
        return (left + (width - left - right) * math.log(ms / 50) / math.log(600 / 50),
                height - bottom - (height - top - bottom) * math.log(error / 5e-4) / math.log(60 / 5e-4))

    for exponent in range(-3, 2):
        x, y = place(50, 10.0 ** exponent)
        draw.line([(x, y), (width - right, y)], PALE)
        draw.text((left - 8, y), f"{10.0 ** exponent:.{max(0, -exponent)}f}", INK, font(20), anchor="rm")
    for ms in 50, 100, 200, 500:
        x, y = place(ms, 5e-4)
        draw.line([(x, y), (x, top)], PALE)
        draw.text((x, y + 6), f"{ms}", INK, font(20), anchor="mt")
    draw.text(((left + width - right) / 2, height - 8), "ms a frame", INK, font(22), anchor="mb")
    draw.text((left + 8, height - bottom - 8), "L2 in 1/255", INK, font(22), anchor="lb")
    front = sorted((ms, error) for *_, ms, error, on in STUDY if on)
    draw.line([place(*point) for point in front], INK, 2)
    for slabs, kind, ms, error, _ in STUDY:
        study_point(draw, place(ms, error), slabs, kind)
    study_legend(draw, *place(200, 1.0))
    whole.quantize(32).save(images / "learn-study-front.png", optimize=True)


def study_point(draw, at, slabs, kind):
    """8 bits are hollow; squares are pre-integrated, circles post-classified; exact is a diamond."""
    x, y = at
    color = ORANGE if kind.startswith("post") else BLUE if kind.startswith("pre") else INK
    shape = {"post": draw.ellipse, "pre,": draw.rectangle, "pre": draw.rectangle}.get(kind[:4])
    if shape is None:
        draw.polygon([(x - 10, y), (x, y - 10), (x + 10, y), (x, y + 10)], color)
        draw.text((x + 16, y), "exact, no slabs", INK, font(22), anchor="lm")
        return
    shape([x - 8, y - 8, x + 8, y + 8], "white" if "8 bits" in kind else color, color, 3)
    if slabs:
        dx, dy, anchor = LABELS.get((slabs, kind), (14, 0, "lm"))
        draw.text((x + dx, y + dy), slabs, color, font(20), anchor=anchor)


def study_legend(draw, x, y):
    for row, kind in enumerate(("post", "pre", "post, 8 bits", "pre, 8 bits")):
        study_point(draw, (x + 8, y + 32 * row), "", kind)
        draw.text((x + 28, y + 32 * row), kind.replace("pre", "pre-integrated"), INK, font(20), anchor="lm")


def vtk(lamina, images):
    import numpy
    from PIL import Image
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run_page("learn/vtk-against-the-truth.md", lamina, folder)
        shown = numpy.clip(numpy.load(folder / "vtk.npy")[:, :, :3], 0, 1)
        sheet([(Image.fromarray(numpy.uint8(numpy.round(255 * shown))), "VTK, a step of 1.5 mm"),
               (folder / "vtk-difference.png", "minus the truth")], images / "learn-vtk-difference.png")


def draw(lamina, folder):
    """Makes every picture of docs/start, docs/learn and docs/annotations.md."""
    images = pathlib.Path(folder)
    lamina = str(pathlib.Path(lamina).resolve())
    start(lamina, images)
    annotations(lamina, images)
    transfer_function(lamina, images)
    precision(lamina, images)
    meshes(lamina, images)
    papers(lamina, images)
    study(images)
    vtk(lamina, images)
