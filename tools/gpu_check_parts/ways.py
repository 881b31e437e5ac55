# SPDX-License-Identifier: Apache-2.0
"""Ways in which the shaders of a frame can be run by EGL. Which is the fastest on a GPU is a guess until one has run them."""
import json
import shutil

from bench_parts import scenes
from gpu_check_parts.checks import problem
from gpu_check_parts.frames import TIMED, WARM_UP

# Name, LAMINA_RAYS (docs/gpu.md), and arguments. The first way of a list is the one that all others are compared with.
DRAWN = ("drawn as fragments", "", ["--no-omit=blending"])
MARCHES = (("texels, 64", "texels,64", []), ("texels, 32", "texels,32", []), ("texels, 128", "texels,128", []),
           ("words, 64", "words,64", []), ("texels, 64, blocks", "texels,64,blocks", []),
           ("texels, 64, alone", "texels,64,alone", []),
           ("texels, 64, sorted", "texels,64,sorted", []), ("texels, 64, queue", "texels,64,queue", []),
           ("texels, 64, sorted queue", "texels,64,sorted,queue", []), DRAWN)
WALKS = (("rays walk", "", []), ("rays walk, blocks", "blocks", []), DRAWN)
SIZE, QUICK_SIZE = "800x600", "96x72"


def compared(quick):
    """Scenes, each with its ways: the fewest first, in case there is no time for all."""
    lit = scenes.BenchScene("bonsai, lit", scenes.ROOT / "data" / "scenes" / "bonsai_lit.json")
    marched = [scenes.find("gaussians")] if quick else [scenes.find("bonsai"), lit]
    return [(scenes.kuhn(8) if quick else scenes.find("bluntfin"), WALKS), *((scene, MARCHES) for scene in marched)]


def timed(lamina, scene, rays, arguments, quick):
    """Leaves the scene's own picture in the folder, as timed.exr."""
    lamina.variables = {"LAMINA_RAYS": rays}
    warm_up = [] if quick else ["--warm-up", WARM_UP["egl"]]
    try:
        frames = lamina.frames(scene.path, [*scene.arguments, "--size", QUICK_SIZE if quick else SIZE, "--context", "egl",
                                            "--turn-by", 3, *warm_up, *arguments], 2 if quick else TIMED["egl"])
    finally:
        lamina.variables = {}
    return frames["frame_ms"]


def not_timed(error):
    """A result in place of times: lamina refuses ways that this OpenGL does not have."""
    refused = str(error).partition("LAMINA_RAYS: ")[2]
    return {"missing": refused} if refused else problem(error)


def check(lamina, quick):
    results = []
    for scene, ways in compared(quick):
        picture, first = lamina.folder / "timed.exr", lamina.folder / "first.exr"
        for way in ways:
            name, rays, arguments = way
            result = {"scene": scene.name, "way": name}
            results.append(result)
            if scene.missing():
                result["missing"] = scene.missing()
                continue
            try:
                result["frame_ms"] = timed(lamina, scene, rays, arguments, quick)
                if way is ways[0]:
                    shutil.copyfile(picture, first)
                result["apart"] = json.loads(lamina.run("compare", picture, first, "--json"))["all"]["linf"]
            except SystemExit as error:
                result.update(not_timed(error))
    return results
