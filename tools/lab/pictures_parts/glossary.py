# SPDX-License-Identifier: Apache-2.0
"""Pictures of docs/glossary.md: diagrams as SVG, and two small scenes drawn by the program, each beside the truth."""
import json
import pathlib
import subprocess
import tempfile

INK, GREY, PALE, ORANGE, BLUE = "#1a1a1a", "#707070", "#dbe6f0", "#d55e00", "#0072b2"
PANEL, CAPTION = 240, 62  # of pictures by the program, in pixels


class Drawing:
    """An SVG on white, 480 wide, whose letters can be read at 360."""

    def __init__(self, height, title):
        self.parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 480 {height}" width="480" '
                      f'height="{height}" font-family="sans-serif" font-size="16" role="img">',
                      f"<title>{title}</title>", '<rect width="100%" height="100%" fill="#ffffff"/>']

    def line(self, points, color=INK, width=1.5, dash="none", close=False, fill="none"):
        places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<{"polygon" if close else "polyline"} points="{places}" fill="{fill}" stroke="{color}" '
                          f'stroke-width="{width}" stroke-dasharray="{dash}" stroke-linejoin="round"/>')

    def box(self, x, y, width, height, fill, color=INK):
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" '
                          f'fill="{fill}" stroke="{color}"/>')

    def dot(self, x, y, color=INK, radius=4, fill=None):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{fill or color}" '
                          f'stroke="{color}" stroke-width="1.5"/>')

    def text(self, x, y, words, color=INK, anchor="start", weight="normal", size=16):
        words = words.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{color}" text-anchor="{anchor}" '
                          f'font-weight="{weight}" font-size="{size}">{words}</text>')

    def write(self, path):
        path.write_text("\n".join(self.parts) + "\n</svg>\n", encoding="utf-8")


def cut_at(corners, x, keep_right):
    """The part of a convex polygon on one side of the vertical line at x."""
    kept, side = [], 1 if keep_right else -1
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
        if side * (x0 - x) >= 0:
            kept.append((x0, y0))
        if (x0 - x) * (x1 - x) < 0:
            kept.append((x, y0 + (y1 - y0) * (x - x0) / (x1 - x0)))
    return kept


def slab(folder):
    drawing = Drawing(310, "A box cut into eight slabs of equal thickness, at right angles to the view")
    corners = [(190, 120), (330, 30), (430, 170), (290, 260)]
    for i in range(8):
        part = cut_at(cut_at(corners, 190 + 30 * i, True), 220 + 30 * i, False)
        drawing.line(part, BLUE, 1, close=True, fill="#f6c9a4" if i == 3 else PALE if i % 2 else "#ffffff")
    drawing.line(corners, INK, 2, close=True)
    for y in (75, 145, 215):
        drawing.line([(36, 150), (470, 150 + (y - 145) * 1.9)], GREY, 1.2, "6 4")
    drawing.dot(36, 150, INK, 7)
    drawing.text(20, 184, "eye")
    drawing.text(50, 84, "viewing rays", GREY)
    drawing.line([(285, 48), (293, 110)], ORANGE)
    drawing.text(205, 42, "one slab", ORANGE, weight="bold")
    drawing.line([(190, 270), (190, 280), (430, 280), (430, 270)], INK)
    drawing.text(310, 300, "N = 8 slabs of equal thickness", anchor="middle")
    drawing.write(folder / "glossary-slab.svg")


def segment(folder):
    drawing = Drawing(300, "The segment of a ray in one slab is longer than the slab is thick")
    drawing.box(170, 34, 150, 196, "#f6c9a4", BLUE)
    drawing.text(245, 26, "one slab", anchor="middle", color=ORANGE, weight="bold")
    drawing.line([(20, 60), (460, 221)], GREY, 1.2, "6 4")
    front, back = (170, 60 + 150 * 161 / 440), (320, 60 + 300 * 161 / 440)
    drawing.line([front, back], BLUE, 6)
    for place in (front, back):
        drawing.dot(*place, BLUE, 6)
    drawing.text(20, 52, "ray", GREY)
    drawing.text(160, front[1] + 24, "enters:", anchor="end")
    drawing.text(160, front[1] + 44, "scalar sf", anchor="end")
    drawing.text(330, back[1] - 30, "leaves:")
    drawing.text(330, back[1] - 10, "scalar sb")
    drawing.text(178, 62, "segment", BLUE, weight="bold")
    drawing.text(178, 84, "of length l", BLUE)
    drawing.line([(170, 240), (170, 250), (320, 250), (320, 240)], INK)
    drawing.text(330, 254, "thickness")
    drawing.text(240, 286, "opacity of the segment = 1 - exp(-extinction × l)", anchor="middle")
    drawing.write(folder / "glossary-segment.svg")


def opacity(folder):
    import math
    drawing = Drawing(250, "Opacity against optical depth")
    left, bottom, unit, height = 70, 190, 76, 150
    for i in range(6):
        drawing.line([(left + i * unit, bottom), (left + i * unit, bottom - height)], "#dddddd", 1)
        drawing.text(left + i * unit, bottom + 20, str(i), anchor="middle")
    for value in (0, 0.5, 1):
        drawing.line([(left, bottom - value * height), (left + 5 * unit, bottom - value * height)], "#dddddd", 1)
        drawing.text(left - 8, bottom - value * height + 5, f"{value:g}", anchor="end")
    drawing.line([(left, bottom - height), (left, bottom), (left + 5 * unit, bottom)])
    curve = [(left + i * unit / 20, bottom - height * (1 - math.exp(-i / 20))) for i in range(101)]
    drawing.line(curve, BLUE, 3)
    drawing.text(left + 1.4 * unit, bottom - 0.6 * height, "opacity = 1 - exp(-optical depth)", BLUE)
    drawing.text(left + 2.5 * unit, bottom + 44, "optical depth", anchor="middle")
    drawing.text(left - 50, bottom - height - 14, "opacity")
    drawing.write(folder / "glossary-opacity.svg")


def preintegration(folder):
    drawing = Drawing(318, "A peak of the transfer function between the scalars at a segment's ends")
    base, left = 210, 30
    peak = [(left, base), (196, base), (219, 62), (242, base), (460, base)]
    drawing.line([(150, base), (196, base), (219, 62), (242, base), (410, base)], PALE, 0, close=True, fill=PALE)
    drawing.line(peak, INK, 2.5)
    drawing.text(left, 26, "extinction by scalar, with a narrow peak", weight="bold")
    drawing.text(464, base - 10, "scalar", GREY, "end")
    for x, name in ((150, "sf"), (410, "sb")):
        drawing.line([(x, base + 8), (x, 70)], BLUE, 1.5, "5 4")
        drawing.text(x, base + 22, name, BLUE, "middle")
    drawing.text(144, 88, "front of", BLUE, "end")
    drawing.text(144, 108, "the segment", BLUE, "end")
    drawing.text(404, 88, "back", BLUE, "end")
    drawing.dot(280, base, ORANGE, 7)
    drawing.line([(280, base - 8), (280, 150)], ORANGE, 1.5)
    drawing.text(286, 152, "middle", ORANGE)
    drawing.dot(left + 6, 262, ORANGE, 7)
    drawing.text(left + 22, 267, "post: the value in the middle alone, here 0", ORANGE)
    drawing.box(left - 1, 285, 14, 14, PALE, BLUE)
    drawing.text(left + 22, 298, "pre-integrated: all values from sf to sb", BLUE)
    drawing.write(folder / "glossary-pre-integration.svg")


def over_of_equal(code, count):
    """The result of `count` fragments of one code in 8 bits, rounded as OVER rounds."""
    stored = 0
    for _ in range(count):
        stored = int((code * 255 + stored * (255 - code)) / 255 + 0.5)
    return stored


def share_of(code, share):
    return 255 * (1 - (1 - code / 255) ** share)


def factoring(folder):
    wanted = 4
    thin = share_of(wanted, 1 / 16)
    child = round(share_of(wanted, 1 / 4))
    node = over_of_equal(child, 4)
    root = over_of_equal(round(share_of(node, 1 / 4)), 4)
    drawing = Drawing(452, "Sixteen thin samples composited straight and in a tree")
    drawing.text(20, 28, f"A ray of 16 samples, opacity {wanted}/255 together", weight="bold", size=18)
    drawing.text(20, 62, f"Straight: each sample has {thin:.2f}/255,", size=18)
    for i in range(16):
        drawing.dot(30 + 28 * i, 82, GREY, 8, "#ffffff")
        drawing.text(30 + 28 * i, 116, str(round(thin)), GREY, "middle", size=20)
    drawing.text(20, 146, f"rounded to 0. The ray shows {over_of_equal(round(thin), 16)}/255.", ORANGE, size=18)
    drawing.text(20, 192, "Tree 4x4: each sample enters as if all were like it", size=18)
    for group in range(4):
        x = 72 + 112 * group
        for i in range(4):
            drawing.line([(30 + 28 * (4 * group + i), 218), (x, 300)], GREY, 1)
            drawing.dot(30 + 28 * (4 * group + i), 218, BLUE, 13, PALE)
            drawing.text(30 + 28 * (4 * group + i), 225, str(wanted), BLUE, "middle", size=20)
        drawing.line([(x, 300), (240, 372)], GREY, 1)
        drawing.box(x - 46, 248, 92, 24, "#ffffff", "none")
        drawing.text(x, 267, "+".join([str(child)] * 4), ORANGE, "middle", size=20)
        drawing.dot(x, 300, BLUE, 17, PALE)
        drawing.text(x, 307, str(node), BLUE, "middle", size=20)
    drawing.box(240 - 46, 324, 92, 24, "#ffffff", "none")
    drawing.text(240, 343, "+".join([str(round(share_of(node, 1 / 4)))] * 4), ORANGE, "middle", size=20)
    drawing.dot(240, 372, BLUE, 19, PALE)
    drawing.text(240, 380, str(root), BLUE, "middle", "bold", 22)
    drawing.text(20, 418, f"A child's {node} becomes {child}, its share: 1 - (1 - a)^(1/4).", ORANGE, size=18)
    drawing.text(20, 444, f"Four of these make {root}. The ray shows {root}/255.", BLUE, size=18)
    drawing.write(folder / "glossary-exponent-factoring.svg")


def subtree(drawing, factors, left, right, y, step):
    """Draws a tree with the given bifurcation factors from its root down; returns where the root is."""
    x = (left + right) / 2
    if not factors:
        drawing.dot(x, y, GREY, 5, "#ffffff")
        return x, y
    width = (right - left) / factors[0]
    for i in range(factors[0]):
        child = subtree(drawing, factors[1:], left + i * width, left + (i + 1) * width, y + step, step)
        drawing.line([(x, y), child], GREY, 1)
        drawing.dot(*child, BLUE if factors[1:] else GREY, 5, BLUE if factors[1:] else "#ffffff")
    drawing.dot(x, y, BLUE, 6)
    return x, y


def bifurcation(folder):
    drawing = Drawing(196, "Eight samples in three trees")
    for column, (name, factors) in enumerate((("8", [8]), ("2x4", [2, 4]), ("2x2x2", [2, 2, 2]))):
        left = 14 + 158 * column
        subtree(drawing, factors, left, left + 136, 46, 96 / len(factors))
        drawing.text(left + 68, 26, name, INK, "middle", "bold")
    drawing.dot(24, 176, BLUE, 6)
    drawing.text(38, 182, "node")
    drawing.dot(104, 176, GREY, 5, "#ffffff")
    drawing.text(118, 182, "sample: a slab of the ray")
    drawing.write(folder / "glossary-bifurcation-factor.svg")


def dithering(folder):
    drawing = Drawing(278, "Eight slabs of 0.375 codes each, rounded and dithered")
    rows = [("wanted in each of 8 slabs: 0.375 of a code", [0.375] * 8, GREY, "3 in all"),
            ("rounded: every slab shows nothing", [0] * 8, ORANGE, "0 in all"),
            ("dithered: 3 of 8 slabs show a whole code", [0, 1, 0, 0, 1, 0, 1, 0], BLUE, "3 in all")]
    for row, (words, values, color, total) in enumerate(rows):
        y = 28 + 88 * row
        drawing.text(20, y, words, color)
        for i, value in enumerate(values):
            drawing.box(20 + 42 * i, y + 12, 38, 44, "#ffffff", GREY)
            if value:
                drawing.box(20 + 42 * i, y + 12 + 44 * (1 - value), 38, 44 * value, color, color)
        drawing.text(366, y + 40, total, color, weight="bold")
    drawing.write(folder / "glossary-dithering.svg")


def projected(folder):
    drawing = Drawing(470, "A tet in the picture is four triangles around the place where it is thickest")
    a, b, c, d = (30, 120), (120, 30), (210, 130), (110, 210)
    thick = (119, 124)  # where the edges a-c and b-d cross in the picture
    drawing.line([a, b, c, d], INK, 2, close=True, fill=PALE)
    drawing.line([a, c], INK, 1.5)
    drawing.line([b, d], INK, 1.5, "5 4")
    drawing.text(120, 240, "a tet in the picture", anchor="middle", size=18)
    shift = 8
    for first, second, fill in ((a, b, "#f6c9a4"), (b, c, PALE), (c, d, "#f6c9a4"), (d, a, PALE)):
        corners = [(x + 240, y) for x, y in (first, second, thick)]
        middle = [sum(corner[i] for corner in corners) / 3 for i in range(2)]
        away = [middle[0] - 240 - thick[0], middle[1] - thick[1]]
        length = (away[0] ** 2 + away[1] ** 2) ** 0.5
        moved = [(x + shift * away[0] / length, y + shift * away[1] / length) for x, y in corners]
        drawing.line(moved, INK, 2, close=True, fill=fill)
    drawing.text(360, 240, "its four triangles", anchor="middle", size=18)
    corners = [(150, 340), (240, 256), (300, 350), (230, 420)]
    drawing.line(corners, INK, 2, close=True, fill=PALE)
    drawing.line([(60, 372), (400, 312)], GREY, 1.2, "6 4")
    enter, leave = on_edge(corners[3], corners[0]), on_edge(corners[1], corners[2])
    drawing.line([enter, leave], BLUE, 5)
    drawing.dot(*enter, BLUE, 6)
    drawing.dot(*leave, BLUE, 6)
    drawing.text(60, 396, "ray", GREY, size=18)
    drawing.text(304, 306, "segment", BLUE, "start", "bold", 18)
    drawing.text(230, 456, "the tet from the side: a ray's segment in it", anchor="middle", size=18)
    drawing.write(folder / "glossary-projected-tetrahedra.svg")


def on_edge(first, second):
    """The point at which the ray of `projected`, from (60, 372) to (400, 312), crosses the line through two corners."""
    def side(point):
        return (point[1] - 372) * 340 + (point[0] - 60) * 60
    share = side(first) / (side(first) - side(second))
    return tuple(p + share * (q - p) for p, q in zip(first, second))


def camera(fov):
    return {"projection": "perspective", "eye": [1.9, -1.1, 1.4], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1],
            "fov_y": fov}


def scene(points, fov):
    """The shipped volume `gaussians` with other points of the transfer function."""
    keys = ("value", "color", "extinction")
    return {"version": 1, "volume": {"generate": "gaussians", "size": [128, 128, 128]},
            "transfer_function": {"points": [dict(zip(keys, point)) for point in points]},
            "camera": camera(fov), "image": {"width": PANEL, "height": PANEL}}


FAINT = scene([(0, [1, 1, 1], 0), (255, [1, 1, 1], 2)], 31)
PEAK = scene([(120, [1, 0.75, 0.3], 0), (123, [1, 0.75, 0.3], 120), (126, [1, 0.75, 0.3], 0), (180, [0.2, 0.5, 1], 0),
              (255, [0.2, 0.5, 1], 1.5)], 22)


def render(lamina, what, path, settings):
    """A picture of a scene, with settings of render.slice as one object, or the tracer's if there are none."""
    chosen = {"method": "trace"} if settings is None else settings
    source = path.with_suffix(".json")
    source.write_text(json.dumps({**what, "render": chosen}))
    subprocess.run([lamina, "render", source, "-o", path, "--quiet", "--context", "cpu"], check=True)


def panels(lamina, what, target, columns):
    """Pictures of one scene side by side, with two lines of words below each; the last one is the truth."""
    from PIL import Image, ImageDraw, ImageFont
    font = ImageFont.truetype("DejaVuSans.ttf", 23)
    sheet = Image.new("RGB", (len(columns) * (PANEL + 4) - 4, PANEL + CAPTION), "white")
    pen = ImageDraw.Draw(sheet)
    with tempfile.TemporaryDirectory() as folder:
        for i, (lines, settings) in enumerate(columns):
            path = pathlib.Path(folder) / f"{i}.png"
            render(lamina, what, path, settings)
            sheet.paste(Image.open(path).convert("RGB"), (i * (PANEL + 4), 0))
            for row, words in enumerate(lines):
                pen.text((i * (PANEL + 4) + PANEL / 2, PANEL + 16 + 28 * row), words, "black", font, "mm")
    sheet.quantize(96, dither=Image.Dither.NONE).save(target, optimize=True)


def draw(lamina, folder):
    """Makes every picture of docs/glossary.md in this folder."""
    folder = pathlib.Path(folder)
    for diagram in (slab, segment, opacity, preintegration, factoring, bifurcation, dithering, projected):
        diagram(folder)
    coarse = {"target": "fixed8", "slice": {"classification": "post", "samples": 256}}
    truth = (("the truth", "reference tracer"), None)
    plain = (("8 bits, 256 slabs", "plain"), coarse)
    panels(lamina, FAINT, folder / "glossary-dithering.png", [
        plain, (("8 bits, 256 slabs", "dithered"), {**coarse, "slice": {**coarse["slice"], "dither": {"period": 16}}}),
        truth])
    panels(lamina, FAINT, folder / "glossary-exponent-factoring.png", [
        plain, (("8 bits, 256 slabs", "tree 8x8"), {**coarse, "slice": {
            **coarse["slice"], "tree": {"factors": [8, 8], "nodes": "fixed"}}}), truth])
    panels(lamina, PEAK, folder / "glossary-pre-integration.png", [
        (("24 slabs,", kind), {"slice": {"classification": word, "samples": 24}})
        for kind, word in (("post-classified", "post"), ("pre-integrated", "preintegrated"))] + [truth])
