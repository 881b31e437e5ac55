# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/performance.md: reading files, the first picture, memory."""
import pathlib
import types

from bench_parts import rounds, scenes
from bench_parts.measured_bench import HALF, data_file, median, mib, ms, slabs, table, times

TYPE_BYTES = {"uint8": 1, "int8": 1, "uint16": 2, "int16": 2, "float": 4, "float32": 4}
TET_BYTES, POINT_BYTES = 32, 32  # in memory, with neighbours


def reading(bench):
    """One volume in many formats."""
    from bench_parts import volume_formats  # needs numpy
    size = (40, 48, 48) if bench.quick else (370, 368, 368)
    folder = pathlib.Path(bench.folder) / "formats"
    folder.mkdir()
    ways = {}
    for name, path in volume_formats.write_all(folder, size).items():
        scene = bench.scene("reading", {
            "version": 1, "volume": str(path), "image": {"width": 32, "height": 24},
            "transfer_function": {"points": [{"value": -1000, "color": [1, 1, 1], "extinction": 0.001},
                                             {"value": 2000, "color": [1, 1, 1], "extinction": 0.002}]},
            "camera": {"projection": "perspective", "eye": [900, 900, 900], "center": [180, 180, 180],
                       "up": [0, 0, 1], "fov_y": 35}})
        scene.path = scene.path.rename(folder / f"{len(ways)}.json")
        arguments = ["--context", "cpu", *slabs(4, "post")]
        ways[name] = lambda scene=scene: bench.lamina.frames(scene.path, arguments, 1)["stages"]["load"]
    found = rounds.interleaved(ways, bench.rounds)
    raw = next(iter(found))
    bench.raw.append({"formats": found, "size": size})
    megabytes = 2 * size[0] * size[1] * size[2] / 1e6
    rows = [[name, ms(median(values)), f"{1e3 * megabytes / median(values):,.0f} MB/s",
             times(rounds.ratio(found[raw], values)["median"])] for name, values in found.items()]
    return table(["format", f"{megabytes:.0f} MB", "rate", "as a share of raw NRRD"], rows)


def large_volume(bench):
    """A volume of 512^3 bytes, made once."""
    path = pathlib.Path(bench.folder) / "large.nrrd"
    edge = 64 if bench.quick else 512
    if not path.exists():
        bench.lamina.run("generate", "mixing", "-o", path, "--size", f"{edge},{edge},{edge}", "--quiet")
    return types.SimpleNamespace(name=f"mixing, {edge}^3", path=path, arguments=[])


def first_picture(bench):
    """Files without a scene, from the start of reading to the written picture."""
    groups = {"read": ["load"], "look and choose": ["choose", "measure", "plan"], "set up": ["context", "set_up"],
              "draw": ["order", "geometry", "draw"], "write": ["read", "write"]}
    rows = []
    for file in [*map(data_file, ["headsq.nrrd", "bonsai.nrrd", "heptane.nrrd"]), large_volume(bench),
                 *map(data_file, ["torso.vtu", "bluntfin.vtu", "combustor.vtu"])]:
        found = bench.stats(file)
        stages = [ms(median(sum(run["stages"].get(stage, 0) for stage in group) for run in found))
                  for group in groups.values()]
        rows.append([file.name, *stages, ms(median(run["first_picture_ms"] for run in found))])
    return table(["file", *groups, "first picture"], rows)


def data_bytes(bench, path):
    """Returns the memory that a file's samples or tets take, and what they are."""
    facts = bench.info(path)
    if facts["kind"] == "mesh":
        return f"{facts['tets']:,} tets", TET_BYTES * facts["tets"] + POINT_BYTES * facts["points"]
    x, y, z = facts["size"]
    return f"{x} x {y} x {z} {facts['type']}", TYPE_BYTES[facts["type"]] * x * y * z


def memory(bench):
    """Data, what the engine adds to them, and the most that the process held."""
    rows = []
    for name in ("headsq", "hydrogen", "bonsai", "heptane", "large", "bluntfin", "combustor"):
        scene = large_volume(bench) if name == "large" else scenes.find(name)
        path = scene.path if name == "large" else scene.data_file()
        what, count = data_bytes(bench, path)
        found = [bench.lamina_by_shell.frames(scene.path, bench.whole(["--context", context], HALF), 1)
                 for context in ("cpu", "osmesa")]
        bench.raw.append({"scene": scene.name, "stats": found})
        rows.append([scene.name, what, mib(count), mib(found[0]["bytes_host"]),
                     *(f"{run['peak_rss_mb']:,.0f} MiB" for run in found)])
    return table(["scene", "data", "in memory", "engine beside them", "process, `cpu`", "process, OSMesa"], rows)


TABLES = {"reading": reading, "first-picture": first_picture, "memory": memory}
