# SPDX-License-Identifier: Apache-2.0
"""Runs of tools/bench over commits: a file with a line of JSON each, and its page."""
import datetime
import html
import json
import os
import platform
import re

from bench_parts import processor

WIDTH, HEIGHT, LEFT, TOP = 640, 150, 46, 8
COLORS = ("#2a78c8", "#d9622b", "#3a9b5c", "#8a4fb0")


def machine():
    """Times of one machine alone are compared."""
    return f"{processor.name()}, {len(os.sched_getaffinity(0))} cores, {platform.node()}"


def add(path, lamina, options, results):
    commit = re.search(r"^commit: (.*)$", lamina.run("--version"), re.MULTILINE)[1]
    line = {"date": datetime.datetime.now().isoformat(timespec="seconds"), "commit": commit, "machine": machine(),
            "frames": options.frames, "rounds": options.rounds, "arguments": options.common,
            "ms": {result["scene"]: {way["name"]: way["ms"] for way in result["ways"]} for result in results}}
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        file.write(json.dumps(line) + "\n")


def read(path):
    """The runs; a line that is none is named."""
    runs = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        try:
            run = json.loads(line)
            runs.append({key: run[key] for key in ("date", "commit", "machine", "arguments", "ms")})
        except (ValueError, KeyError, TypeError) as error:
            raise SystemExit(f"bench_history: {path}, line {number}: expected a run of tools/bench --history ({error})")
    if not runs:
        raise SystemExit(f"bench_history: {path}: found no runs")
    return runs


def series_of(runs, scene):
    """For each way (number of the run, how many times as fast as the first run that had it)."""
    series = {}
    for number, run in enumerate(runs):
        for way, ms in run["ms"].get(scene, {}).items():
            series.setdefault(way, []).append((number, ms))
    return {way: [(number, points[0][1] / ms) for number, ms in points] for way, points in series.items()}


def plot(runs, series):
    """Up is faster. The line of 1 is stronger than those of the lowest and the highest ratio."""
    ratios = [ratio for points in series.values() for _, ratio in points]
    low, high = min(ratios + [0.9]), max(ratios + [1.1])

    def x_of(number):
        return LEFT + (WIDTH - LEFT - 10) * (number / max(1, len(runs) - 1))

    def y_of(ratio):
        return TOP + (HEIGHT - 2 * TOP) * (high - ratio) / (high - low)

    parts = []
    for ratio in sorted({1.0, low, high}):
        parts.append(f'<path d="M{LEFT} {y_of(ratio):.1f}H{WIDTH}" stroke="currentColor" opacity="{.5 if ratio == 1 else .15}"/>'
                     f'<text x="{LEFT - 6}" y="{y_of(ratio) + 4:.1f}" text-anchor="end">{ratio:.2f}</text>')
    for color, (way, points) in zip(COLORS * len(series), series.items()):
        line = " ".join(f"{x_of(number):.1f},{y_of(ratio):.1f}" for number, ratio in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="2"/>')
        for number, ratio in points:
            about = html.escape(f"{way}: {ratio:.3f} at {runs[number]['commit']}, {runs[number]['date']}")
            parts.append(f'<circle cx="{x_of(number):.1f}" cy="{y_of(ratio):.1f}" r="3.5" fill="{color}"><title>{about}</title>'
                         "</circle>")
    return f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img">{"".join(parts)}</svg>'


def legend(series):
    return " ".join(f'<span style="color:{color}">&#9679;</span> {html.escape(way)}'
                    for color, way in zip(COLORS * len(series), series))


def html_of(all_runs, chosen):
    """The page of one machine and one set of arguments."""
    runs = [run for run in all_runs if (run["machine"], run["arguments"]) == chosen]
    left_out = len(all_runs) - len(runs)
    names = sorted({scene for run in runs for scene in run["ms"]})
    sections = "".join(f"<h2>{html.escape(scene)}</h2><p>{legend(series)}</p>{plot(runs, series)}"
                       for scene in names for series in [series_of(runs, scene)])
    rows = "".join(f"<tr><td>{number + 1}<td>{html.escape(run['date'])}<td>{html.escape(run['commit'])}</tr>"
                   for number, run in enumerate(runs))
    arguments = html.escape(" ".join(chosen[1])) or "none"
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>lamina: times over commits</title><style>
body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 50rem; margin: 2rem auto; padding: 0 1rem }}
svg {{ width: 100%; font-size: 11px; fill: currentColor }} td {{ padding: 0 1rem 0 0 }}
@media (prefers-color-scheme: dark) {{ body {{ background: #131416; color: #ddd }} }}
</style></head><body><h1>Times over commits</h1>
<p>How many times as fast a frame is as in the first run: up is faster. Machine: {html.escape(chosen[0])}. Arguments of every run:
{arguments}. {left_out} runs of other machines or arguments are not shown. Runs from left to right:</p>
<table>{rows}</table>{sections}</body></html>
"""
