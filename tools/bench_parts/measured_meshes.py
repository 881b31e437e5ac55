# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/performance.md: meshes, VTK, and the limits of the machine."""
import json
import pathlib
import types

from bench_parts import against_vtk, scenes
from bench_parts.lamina import Lamina
from bench_parts.measured_bench import FULL, HALF, digits, ms, one_core, slabs, table, times


def spans(bench, scene):
    """Milliseconds by name of a profile's spans, summed over threads, and the number of its frames."""
    profile = pathlib.Path(bench.folder) / "profile.json"
    bench.lamina.frames(scene.path, bench.whole([*scene.arguments, "--profile", profile], FULL), 3)
    total = {"frame": 0.0, "sort": 0.0, "parts": 0.0, "set-up": 0.0, "tiles": 0.0}
    for event in json.loads(profile.read_text())["traceEvents"]:
        if event.get("ph") == "X" and event["name"] in total:
            total[event["name"]] += event["dur"] / 1e3
    return total


def tetrahedra(bench):
    """Meshes: fragments a second, and the shares of the stages of a frame on one core."""
    rows = []
    for scene in [*map(scenes.find, ["torso", "bluntfin", "combustor"]), scenes.kuhn(32)]:
        way = bench.ways(scene, {"cpu": []})["cpu"]
        with one_core():
            found = spans(bench, scene)
        fragments = way["stats"]["fragments"]
        rows.append([scene.name, f"{way['stats']['counts']['tets']:,}", f"{fragments / 1e6:.1f}", ms(way["ms"]),
                     f"{fragments / way['ms'] / 1e3:.0f}",
                     *(f"{100 * found[name] / found['frame']:.0f} %" for name in ("sort", "parts", "set-up",
                                                                                 "tiles"))])
    return table(["mesh", "tets", "million fragments", "frame", "million fragments a second", "order", "list of parts",
                  "set-up", "tiles"], rows)


def growth(bench):
    """Cost by the number of tets, of one picture."""
    rows = []
    for samples in (8, 12, 16) if bench.quick else (16, 24, 32, 48, 70):
        scene = scenes.kuhn(samples)
        way = bench.ways(scene, {"cpu": []})["cpu"]
        tets = way["stats"]["counts"]["tets"]
        rows.append([f"{tets:,}", f"{way['stats']['fragments'] / 1e6:.1f}", ms(way["ms"]),
                     f"{1e6 * way['ms'] / tets:,.0f} ns", ms(way["first_picture_ms"]),
                     f"{way['stats']['bytes_host'] / tets:.0f}"])
    return table(["tets", "million fragments", "frame", "frame, a tet", "first picture", "engine's bytes a tet"], rows)


def vtk(bench):
    """VTK's mappers and lamina's defaults: time and error."""
    from bench_parts import vtk_side
    rows, size = [], bench.size(HALF)
    options = types.SimpleNamespace(size=list(size), frames=1 if bench.quick else 2, rounds=bench.rounds)
    for scene in map(scenes.find, scenes.AGAINST_VTK):
        comparison = against_vtk.Comparison(bench.lamina, scene, options)
        if isinstance(scene.json.get("mesh"), str):
            comparison.add_mesh("cpu")
        else:
            for steps in (1, 2):
                comparison.add_vtk(f"{steps} a voxel", vtk_side.volume_window(scene, options.size, steps))
            comparison.add_lamina("cpu", ["--method", "slice", "--context", "cpu", *slabs(1, "exact")])
        result = comparison.measure()
        bench.raw.append(result)
        ways = {way["name"]: way for way in result["ways"]}
        ours = ways.pop("cpu")
        rows += [[scene.name, name.replace("vtk", "-"), ms(way["ms"]), digits(way["linf"]), digits(way["l2"]),
                  ms(ours["ms"]), digits(ours["linf"]), digits(ours["l2"]), times(bench.ratio(way, ours))]
                 for name, way in ways.items()]
    return table(["scene", "VTK's samples", "VTK", "VTK's Linf", "VTK's L2", "lamina", "lamina's Linf", "lamina's L2",
                  "times as fast"], rows)


class Limits:
    """Peak rates of one core, in units a nanosecond."""

    def __init__(self, bench):
        found = pathlib.Path(bench.folder) / "limits.json"
        Lamina(bench.measure_cpu, bench.folder).run("--json", found)
        self.limits = json.loads(found.read_text())["limits"]
        self.operations = self.named("float32 multiply").get("one_core")
        self.fetches = self.named("gather 4 x 4 blocks in L2").get("one_core")

    def named(self, start):
        return next(limit for limit in self.limits if limit["name"].startswith(start))

    def sentence(self):
        read = self.named("memory: read")
        return (f"One core computes at most {self.operations:.0f} G products or sums a second in float32, and gathers "
                f"{self.fetches:.1f} G numbers a second from blocks in the second cache. It reads "
                f"{read['one_core']:.0f} GB/s from memory; all cores together read {read['all_cores']:.0f} GB/s.")


WORK = {"post": (80, 4), "project": (170, 0)}  # operations and fetches a segment


def limits(bench):
    """Returns a table of the times that counts and the machine's limits imply for a frame on one core, beside those
    measured."""
    machine, rows = Limits(bench), []
    for name, kind in (("bonsai", "post"), ("engine", "post"), ("mixing", "post"), ("bluntfin", "project"),
                       ("combustor", "project"), ("torso", "project")):
        scene = scenes.find(name)
        with one_core():
            way = bench.ways(scene, {"one": slabs(512, "post") if kind == "post" else []}, frames=2)["one"]
        segments = way["stats"]["fragments"]
        operations, fetches = WORK[kind]
        implied = segments * (operations / machine.operations + fetches / machine.fetches) / 1e6
        rows.append([f"{name}, {'post, 512 slabs' if kind == 'post' else 'tets'}", f"{segments / 1e6:.1f}",
                     ms(implied), ms(way["ms"]), f"{100 * implied / way['ms']:.0f} %"])
    return table(["scene", "million segments", "at the limit", "taken on one core", "share"], rows,
                 machine.sentence())


TABLES = {"tetrahedra": tetrahedra, "growth": growth, "vtk": vtk, "limits": limits}
