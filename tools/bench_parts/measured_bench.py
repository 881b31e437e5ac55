# SPDX-License-Identifier: Apache-2.0
"""Shared pieces of the tables of docs/performance.md: timed ways, tables, and how numbers are written."""
import contextlib
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import shlex
import statistics
import textwrap
import types

from bench_parts import rounds, scenes
from bench_parts.lamina import Lamina

TOOLS = pathlib.Path(__file__).resolve().parent.parent
FULL, HALF, QUICK = (800, 600), (400, 300), (200, 150)  # pixels of a picture


def load_bench():
    """tools/bench as a module: how it times is how the tables are timed."""
    loader = importlib.machinery.SourceFileLoader("bench", str(TOOLS / "bench"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
    loader.exec_module(module)
    return module


def by_shell(program, folder):
    """A script that runs the program as its child: the largest memory that Linux tells of a program includes that of
    the one which started it, and this one has VTK in its memory."""
    script = pathlib.Path(folder) / "lamina"
    script.write_text(f"#!/bin/sh\n{shlex.quote(str(pathlib.Path(program).resolve()))} \"$@\"\nexit $?\n")
    script.chmod(0o755)
    return script


class Bench:
    """Times scenes. `spreads` are the largest deviations of a round's ratio from the median of its ratio."""

    def __init__(self, program, folder, quick, round_count, measure_cpu):
        self.lamina, self.folder, self.quick, self.rounds = Lamina(program, folder), folder, quick, round_count
        self.measure_cpu, self.spreads, self.raw = measure_cpu, [], []
        self.measure = load_bench().measure
        self.lamina_by_shell = Lamina(by_shell(program, folder), folder)

    def size(self, size):
        return QUICK if self.quick else size

    def pixels(self, size):
        width, height = self.size(size)
        return ["--size", f"{width}x{height}"]

    def whole(self, arguments, size):
        """Arguments of a run; the cpu engine draws and `size` is drawn if they do not say otherwise."""
        context = [] if "--context" in arguments else ["--context", "cpu"]
        return [*([] if "--size" in arguments else self.pixels(size)), *context, *arguments]

    def ways(self, scene, ways, size=FULL, frames=3):
        """Returns the findings of `tools/bench` for each way, by name."""
        options = types.SimpleNamespace(common=[], rounds=self.rounds, frames=1 if self.quick else frames)
        whole = {name: self.whole(arguments, size) for name, arguments in ways.items()}
        result = self.measure(self.lamina, scene, whole, options)
        self.raw.append({"arguments": whole, **result})
        return {way["name"]: way for way in result["ways"]}

    def stats(self, scene, arguments=(), size=FULL):
        """The statistics of one run in each round."""
        found = [self.lamina.frames(scene.path, [*scene.arguments, *self.whole(arguments, size)], 1)
                 for _ in range(self.rounds)]
        self.raw.append({"scene": scene.name, "size": self.size(size), "stats": found})
        return found

    def ratio(self, slower, faster):
        """How many times as fast the second of two ways is: the median of the rounds."""
        found = rounds.ratio(slower["rounds_ms"], faster["rounds_ms"])
        self.spreads.append(max(found["max"] / found["median"], found["median"] / found["min"]) - 1)
        return found["median"]

    def info(self, path):
        return json.loads(self.lamina.run("info", path, "--json"))

    def scene(self, name, description, arguments=()):
        """A scene that is made for a table."""
        path = pathlib.Path(self.folder) / f"{name}.json"
        path.write_text(json.dumps(description))
        return scenes.BenchScene(name, path, arguments)


def data_file(name):
    """A file of LAMINA_DATA, drawn with what lamina chooses for it."""
    path = pathlib.Path(os.environ["LAMINA_DATA"]) / name
    return types.SimpleNamespace(name=name, path=path, arguments=[])


@contextlib.contextmanager
def one_core():
    """Programs that are started meanwhile have one core."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, cores)


def median(values):
    return statistics.median(list(values))


def setting(**values):
    """Arguments that set keys of a scene; an underscore that is doubled stands for a dot."""
    return [f"--set={key.replace('__', '.')}={value if isinstance(value, str) else json.dumps(value)}"
            for key, value in values.items()]


def slabs(samples, classification):
    return setting(render__slice__samples=samples, render__slice__classification=classification)


def ms(value):
    return f"{value:.1f} ms" if value < 10 else f"{value:,.0f} ms"


def times(value):
    return f"{value:.2f}" if value < 2 else f"{value:.1f}" if value < 10 else f"{value:.0f}"


def mib(count):
    return f"{count / 2**20:.1f} MiB" if count < 10 * 2**20 else f"{count / 2**20:.0f} MiB"


def digits(value):
    """Two significant digits, as `0.0014`."""
    if value == 0 or value >= 1:
        return f"{value:.0f}" if value == 0 or value >= 10 else f"{value:.1f}"
    return f"{float(f'{value:.1e}'):.10f}".rstrip("0").rstrip(".")


def drawn_by(plan):
    """Says in words what a plan draws a scene with."""
    if plan["method"] == "project":
        return "projected tetrahedra"
    return "exact" if plan["classification"] == "exact" else f"{plan['classification']}, {plan['slabs']} slabs"


def table(head, rows, note=""):
    """A Markdown table; a note follows it."""
    lines = [head, ["---"] * len(head), *rows]
    text = "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
    return f"{text}\n\n{textwrap.fill(note, 118)}" if note else text
