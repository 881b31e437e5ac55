# SPDX-License-Identifier: Apache-2.0
"""Frames of a camera that moves, by EGL and by the cpu engine, and the time of their stages."""
import json
import statistics

from bench_parts import scenes
from bench_parts.measured_bench import drawn_by
from gpu_check_parts.checks import CONTEXTS, problem

SIZES, QUICK_SIZES = ((800, 600), (1920, 1080)), ((96, 72), (160, 90))  # pixels
TIMED, WARM_UP = {"egl": 20, "cpu": 5}, {"egl": 1, "cpu": 0.2}  # frames, and seconds before them
OPENGL_ROW = 0  # of a profile: when OpenGL ran commands


def thick_fog(folder, edge):
    """A volume of bytes that is made as it is read, drawn cell by cell. Cells with a corner above 30 show something:
    89.9 % of 1023^3. No ray ends early: the deepest has an optical depth below 2.6, 1.5 over the box's diagonal."""
    path = folder / "fog.json"
    path.write_text(json.dumps({
        "version": 1,
        "volume": {"generate": "marschner-lobb", "size": [edge] * 3},
        "transfer_function": {"points": [{"value": 0, "color": [0, 0.1, 0.3], "extinction": 0},
                                         {"value": 30, "color": [0, 0.1, 0.3], "extinction": 0},
                                         {"value": 255, "color": [1, 0.6, 0.2], "extinction": 1.5}]},
        "camera": {"projection": "perspective", "eye": [2.3, -1.5, 1.7], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1],
                   "fov_y": 35},
        "image": {"width": 800, "height": 600, "background": [0, 0, 0]},
        "render": {"method": "slice", "target": "float32", "slice": {"classification": "exact"}}}))
    return scenes.BenchScene(f"{edge}^3 bytes", path)


def timed(folder, quick):
    """The scenes of the table in docs/gpu.md, then the others that are shipped."""
    bonsai, bluntfin = scenes.find("bonsai"), scenes.find("bluntfin")
    lit = scenes.BenchScene("bonsai, lit", scenes.ROOT / "data" / "scenes" / "bonsai_lit.json")
    coded = [scenes.BenchScene(f"{scene.name}, codes", scene.path, ["--set", "render.target=emulated"])
             for scene in (bonsai, bluntfin)]
    table = [bonsai, thick_fog(folder, 64 if quick else 1024), bluntfin,
             *map(scenes.kuhn, (8, 12) if quick else (60, 119)), lit, *coded]
    others = ["gaussians"] if quick else [name for name in scenes.STANDARD if name not in ("bonsai", "bluntfin")]
    return [*table, *map(scenes.find, others)]


def stages(profile):
    """Milliseconds of each stage of a frame, by name, in the order in which they begin: medians of the frames. Names of
    OpenGL's own begin with "OpenGL"."""
    spans = [event for event in json.loads(profile.read_text())["traceEvents"] if event.get("ph") == "X"]
    spans.sort(key=lambda span: span["ts"])
    frames = [span for span in spans if span["name"] == "frame"][1:]  # the first is the picture
    sums = {}
    for number, frame in enumerate(frames):
        begin, end = frame["ts"], frame["ts"] + frame["dur"]
        for span in spans:
            if span is frame or span["tid"] not in (OPENGL_ROW, frame["tid"]) or not begin <= span["ts"] <= end:
                continue
            name = ("OpenGL " if span["tid"] == OPENGL_ROW else "") + span["name"]
            sums.setdefault(name, [0.0] * len(frames))[number] += span["dur"] / 1e3
    return {name: statistics.median(each) for name, each in sums.items()}


def by_context(lamina, scene, size, context, quick):
    """Stages come from a run of their own, because a profile waits for OpenGL's clock in each frame."""
    arguments = [*scene.arguments, *size, "--context", context, "--turn-by", 3]
    warm_up = [] if quick else ["--warm-up", WARM_UP[context]]
    frames = lamina.frames(scene.path, [*arguments, *warm_up], 2 if quick else TIMED[context])
    profile = lamina.folder / "profile.json"
    lamina.frames(scene.path, [*arguments, *warm_up, "--profile", profile], 2)
    return {"frame_ms": frames["frame_ms"], "first_picture_ms": frames["first_picture_ms"],
            "drawn_by": drawn_by(frames["plan"]), "counts": frames["counts"], "stages_ms": stages(profile)}


def check(lamina, quick):
    results = []
    for scene in timed(lamina.folder, quick):
        for width, height in QUICK_SIZES if quick else SIZES:
            result = {"scene": scene.name, "size": f"{width} x {height}"}
            results.append(result)
            if scene.missing():
                result["missing"] = scene.missing()
                continue
            size = ["--size", f"{width}x{height}"]
            try:
                for context in CONTEXTS:
                    result[context] = by_context(lamina, scene, size, context, quick)
            except SystemExit as error:
                result.update(problem(error))
    return results
