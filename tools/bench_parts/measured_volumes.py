# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/performance.md: frames of any scene, and volumes."""
import random

from bench_parts import rounds, scenes
from bench_parts.measured_bench import FULL, HALF, drawn_by, median, ms, one_core, setting, slabs, table, times

OSMESA = ["--context", "osmesa"]
VOLUMES = ["bonsai", "engine", "headsq", "aneurism", "heptane", "hydrogen", "neghip", "gaussians", "mixing"]
MESHES = ["bluntfin", "combustor", "torso"]


def frames(bench):
    """Every scene with its own settings, by the cpu engine and by OpenGL in software."""
    rows = []
    for scene in map(scenes.find, [*VOLUMES, *MESHES]):
        ways = bench.ways(scene, {"osmesa": OSMESA, "cpu": []}, frames=1)
        cpu, gl = ways["cpu"], ways["osmesa"]
        how, how_gl = drawn_by(cpu["stats"]["plan"]), drawn_by(gl["stats"]["plan"])
        rows.append([scene.name, how if how == how_gl else f"{how}; OSMesa: {how_gl}",
                     f"{cpu['stats']['fragments'] / 1e6:.1f}", ms(cpu["ms"]), ms(gl["ms"]),
                     times(bench.ratio(gl, cpu)), ms(cpu["first_picture_ms"])])
    return table(["scene", "drawn by", "million segments", "`cpu`", "OSMesa", "times as fast", "first picture, `cpu`"],
                 rows)


def sizes(bench):
    """Frame times by pixels."""
    pixels = [(200, 150), (400, 300), (800, 600), (1600, 1200)]
    rows = []
    for scene in map(scenes.find, ["bonsai", "engine", "headsq", "bluntfin", "combustor"]):
        ways = bench.ways(scene, {f"{w}x{h}": bench.pixels((w, h)) for w, h in pixels})
        rows.append([scene.name, *(ms(way["ms"]) for way in ways.values())])
    return table(["scene", *(f"{w} x {h}" for w, h in pixels)], rows)


def moving(bench):
    """Frame times of a camera that turns by more from frame to frame."""
    rows = []
    for scene in map(scenes.find, ["bonsai", "engine", "aneurism", "mixing", "bluntfin", "combustor", "torso"]):
        ways = bench.ways(scene, {turn: ["--turn-by", turn] for turn in ("0.1", "1", "10")}, frames=9)
        base = ways["0.1"]
        rows.append([scene.name, ms(base["ms"]), *(times(bench.ratio(ways[turn], base)) for turn in ("1", "10"))])
    return table(["scene", "0.1 degree a frame", "1 degree: times as long", "10 degrees: times as long"], rows)


def cores(bench):
    """One core and all cores."""
    rows = []
    for scene in map(scenes.find, ["bonsai", "engine", "mixing", "bluntfin", "combustor"]):
        def frame(scene=scene):
            return bench.lamina.frames(scene.path, bench.whole(scene.arguments, FULL), 3)["frame_ms"]["median"]

        def frame_on_one_core(frame=frame):
            with one_core():
                return frame()

        found = rounds.interleaved({"one": frame_on_one_core, "all": frame}, bench.rounds)
        bench.raw.append({"scene": scene.name, "cores": found})
        one, every = ({"rounds_ms": values} for values in found.values())
        rows.append([scene.name, ms(median(found["one"])), ms(median(found["all"])), times(bench.ratio(one, every))])
    return table(["scene", "one core", "all cores", "times as fast"], rows)


def slicing(bench):
    """Slabs: cost by their number, and beside OpenGL in software."""
    numbers, rows = [128, 256, 512, 1024, 2048], []
    for scene in map(scenes.find, ["bonsai", "mixing"]):
        for classification in ("post", "preintegrated"):
            ways = {str(n): slabs(n, classification) for n in numbers}
            found = bench.ways(scene, {"osmesa": [*slabs(512, classification), *OSMESA], **ways}, HALF, 2)
            rows.append([f"{scene.name}, {classification}", *(ms(found[str(n)]["ms"]) for n in numbers),
                         ms(found["osmesa"]["ms"]), times(bench.ratio(found["osmesa"], found["512"]))])
    return table(["scene, classification", *(f"{n} slabs" for n in numbers), "OSMesa, 512 slabs", "times as fast"],
                 rows)


def classification(bench):
    """Exact segments beside the fewest slabs that keep the same error."""
    rows = []
    for scene in map(scenes.find, VOLUMES):
        ways = {"exact": slabs(1, "exact"), "post": slabs("auto", "post"),
                "preintegrated": slabs("auto", "preintegrated")}
        found = bench.ways(scene, ways, HALF, 2)
        row = [scene.name, ms(found["exact"]["ms"]), ms(found["exact"]["first_picture_ms"])]
        for name in ("post", "preintegrated"):
            row += [f"{found[name]['stats']['plan']['slabs']}: {ms(found[name]['ms'])}",
                    ms(found[name]["first_picture_ms"])]
        rows.append(row)
    return table(["scene", "exact", "its first picture", "`post`, slabs: frame", "its first picture",
                  "`preintegrated`, slabs: frame", "its first picture"], rows)


def random_points(count):
    """A transfer function of points that have nothing to do with one another."""
    numbers = random.Random(1)
    return [{"value": 255 * i / (count - 1), "color": [round(numbers.random(), 3) for _ in range(3)],
             "extinction": round(0.1 * numbers.random(), 4)} for i in range(count)]


def transfer_functions(shipped):
    """By name, for values from 0 to 255."""
    grey = [0.8, 0.7, 0.6]

    def peak(width):
        return [{"value": v, "color": grey, "extinction": e}
                for v, e in ((0, 0), (100 - width, 0), (100, 0.4), (100 + width, 0), (255, 0))]

    def slope(top):
        return {"unit_length": 20, "points": [{"value": 30, "color": [0.2, 0.5, 0.1], "opacity": 0},
                                              {"value": 255, "color": [1, 0.9, 0.7], "opacity": top}]}

    ramp = [{"value": 255 * i / 99, "color": [i / 99, 0.5, 1 - i / 99], "extinction": 0.3 * (i / 99) ** 3}
            for i in range(100)]
    return {"the scene's own, 6 points of extinction": shipped, "a peak of 0.02 of the range": {"points": peak(2.55)},
            "a peak of 0.002 of the range": {"points": peak(0.255)}, "a ramp of 100 points": {"points": ramp},
            "256 random points": {"points": random_points(256)}, "a slope of opacity from 0 to 0.9": slope(0.9),
            "a slope of opacity from 0 to 1": slope(1)}


def points(bench):
    """Measures the cost of points of the transfer function."""
    bonsai = scenes.find("bonsai")
    rows = []
    for name, function in transfer_functions(bonsai.json["transfer_function"]).items():
        scene = bench.scene("points", {**bonsai.json, "transfer_function": function})
        found = bench.ways(scene, {"exact": slabs(1, "exact"), "strict": [*slabs(1, "exact"),
                                                                          *setting(render__max_error=0.5)],
                                   "preintegrated": slabs(512, "preintegrated")}, HALF, 2)
        rows.append([name, *(ms(way["ms"]) for way in found.values())])
    return table(["transfer function", "exact", "exact, `max_error` 0.5", "pre-integrated, 512 slabs"], rows)


def omissions(bench):
    """Measures the time that leaving out saves."""
    kept = {"everything": "--no-omit", "`empty_space`": "--no-omit=empty_space",
            "`early_termination`": "--no-omit=early_termination", "`constant_regions`": "--no-omit=constant_regions"}
    rows = []
    for name, arguments in (("aneurism", []), ("bonsai", []), ("engine", []), ("headsq", []), ("hydrogen", []),
                            ("mixing", []), ("mixing", slabs(512, "post"))):
        scene = scenes.find(name)
        ways = {"left out": arguments, **{key: [*arguments, argument] for key, argument in kept.items()}}
        found = bench.ways(scene, ways, HALF, 2)
        names = [f"`{omission['name']}`" for omission in found["left out"]["stats"]["omitted"]]
        rows.append([f"{name}, {drawn_by(found['left out']['stats']['plan'])}", ms(found["left out"]["ms"]),
                     *(times(bench.ratio(found[key], found["left out"])) if key in ("everything", *names) else "-"
                       for key in kept)])
    return table(["scene", "a frame", *(f"{key} kept: times as long" for key in kept)], rows)


def trees(bench):
    """Straight compositing beside a tree of 32 x 32."""
    tree = setting(render__slice__tree={"factors": "32x32"})
    rows = []
    for scene in map(scenes.find, ["bonsai", "mixing"]):
        for classification in ("post", "preintegrated"):
            base = slabs(1024, classification)
            found = bench.ways(scene, {"straight": base, "float": [*base, *tree],
                                       "codes": [*base, *tree, *setting(render__target="fixed8")],
                                       "blended": [*base, *setting(render__target="fixed8")]}, HALF, 2)
            rows.append([f"{scene.name}, {classification}", ms(found["straight"]["ms"]),
                         *(times(bench.ratio(found[key], found["straight"])) for key in ("float", "codes",
                                                                                         "blended"))])
    return table(["scene, classification", "float32, straight", "float32, tree: times as long",
                  "fixed8, tree: times as long", "fixed8, straight: times as long"], rows)


def light(bench):
    """Lit frames beside unlit ones of the same view."""
    rows = []
    for name in ("bonsai_lit", "engine_lit", "headsq_lit", "bluntfin_lit"):
        lit = scenes.BenchScene(name, scenes.ROOT / "data" / "scenes" / f"{name}.json")
        lamp = setting(lighting=lit.json["lighting"])
        dark = bench.scene(name, {key: value for key, value in lit.json.items() if key != "lighting"})
        found = bench.ways(dark, {"unlit": [], "1": lamp, "4": [*lamp, *setting(render__max_error=4)],
                                  "gl unlit": OSMESA, "gl": [*lamp, *OSMESA]}, HALF, 1)
        rows.append([name, ms(found["unlit"]["ms"]), ms(found["1"]["ms"]), times(bench.ratio(found["1"],
                                                                                              found["unlit"])),
                     times(bench.ratio(found["4"], found["unlit"])),
                     times(bench.ratio(found["gl"], found["gl unlit"]))])
    return table(["scene", "unlit", "lit", "lit: times as long", "lit, `max_error` 4: times as long",
                  "lit, OSMesa: times as long"], rows)


TABLES = {"frames": frames, "sizes": sizes, "moving": moving, "cores": cores, "classification": classification,
          "points": points, "slicing": slicing, "omissions": omissions, "trees": trees, "light": light}
