#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whole-frame times of one scene in several ways, as ratios: by default --context osmesa against cpu.

    tools/bench_native.py SCENE [--way NAME:ARGS]... [--frames 5] [--rounds 3] [--lamina build/lamina] [-- ARGS...]

ARGS after -- go to every run; a way's own follow them. The first way is the one that the others are compared with.
A round is one run of every way, one after the other, so that all meet the same other load; each run is one warm-up
and N timed frames with the camera turning. Given are the median of all frames of a way, and the median and the range
of the ratios of the rounds.
"""
import argparse
import json
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(lamina, scene, arguments, frames):
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        command = [lamina, "render", scene, "-o", str(pathlib.Path(folder) / "picture.exr"), "--stats", str(stats),
                   "--frames", str(frames), "--quiet", *arguments]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"bench_native: {shlex.join(command)}: {done.stderr.strip()}")
        return json.loads(stats.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--way", action="append", default=[], help="NAME:ARGS")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--lamina", default=str(ROOT / "build" / "lamina"))
    own, common = sys.argv[1:], []
    if "--" in own:
        own, common = own[:own.index("--")], own[own.index("--") + 1:]
    options = parser.parse_args(own)
    ways = options.way or ["osmesa:--context osmesa", "cpu:--context cpu"]
    names = [way.split(":", 1)[0] for way in ways]
    arguments = {name: common + shlex.split(way.split(":", 1)[1]) for name, way in zip(names, ways)}
    medians = {name: [] for name in names}
    last = {}
    for _ in range(options.rounds):
        for name in names:
            last[name] = run(options.lamina, options.scene, arguments[name], options.frames)
            medians[name].append(last[name]["frame_ms"]["median"])
    for name in names:
        line = f"{name:12} {statistics.median(medians[name]):9.1f} ms"
        fragments = last[name].get("fragments") or 0
        if fragments:
            line += f"  {fragments / 1e6:8.2f} M fragments  {fragments / 1e3 / statistics.median(medians[name]):7.1f} M/s"
        if name != names[0]:
            ratios = sorted(a / b for a, b in zip(medians[names[0]], medians[name]))
            line += f"  {statistics.median(ratios):6.2f} times as fast ({ratios[0]:.2f} .. {ratios[-1]:.2f})"
        print(line)


if __name__ == "__main__":
    main()
