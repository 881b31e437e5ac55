# SPDX-License-Identifier: Apache-2.0
"""The checks, each of which gives plain data for the report."""
import datetime
import json
import os
import platform
import subprocess
import sys

from bench_parts import processor, scenes

CONTEXTS = ("egl", "cpu")


def machine(lamina):
    """Describes the machine and the program that the figures belong to."""
    try:
        driver = subprocess.run(["nvidia-smi", "--query-gpu=name,driver_version", "--format=csv,noheader"],
                                capture_output=True, text=True).stdout.strip()
    except OSError:
        driver = ""
    return {"processor": processor.name(), "processors": len(os.sched_getaffinity(0)), "system": platform.platform(),
            "driver": driver, "date": datetime.date.today().isoformat(), "lamina": lamina.run("--version").splitlines()}


def renderer_of(lamina):
    """Returns the device that draws through EGL, or None: then the reason was printed."""
    scene = scenes.find("gaussians")
    stats = lamina.folder / "egl.json"
    command = [str(lamina.program), "render", str(scene.path), "-o", str(lamina.folder / "egl.exr"), "--context", "egl",
               "--set", "image.width=64", "--set", "image.height=48", "--stats", str(stats), "--quiet"]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        print(f"gpu_check: {lamina.program}: {error.strerror}: build lamina or name it with --lamina")
        return None
    if done.returncode != 0:
        print(f"gpu_check: EGL does not draw here: {done.stderr.strip()}")
        return None
    return json.loads(stats.read_text())["context"]


def selftest(lamina, output, quick):
    """Exit code 3 says that a bound was not kept, which the cases say, too."""
    print("gpu_check: self test", file=sys.stderr)
    folder = output / "selftest"
    groups = ["--group", "optics"] if quick else []
    done = subprocess.run([str(lamina.program), "selftest", "-o", str(folder), "--context", "egl", "--force", "--quiet",
                           *groups], capture_output=True, text=True)
    if done.returncode not in (0, 3):
        return {"error": done.stderr.strip()}
    report = json.loads((folder / "selftest.json").read_text())
    cases = report["cases"]
    return {"passed": sum(case["verdict"] == "passed" for case in cases), "cases": len(cases),
            "failed": [case for case in cases if case["verdict"] != "passed"]}


def sized(quick):
    width, height = (96, 72) if quick else (400, 300)
    return ["--set", f"image.width={width}", "--set", f"image.height={height}"]


def picture(lamina, scene, arguments, truth, context):
    """One scene by one context: its error against the truth, and the time of a frame."""
    frames = lamina.frames(scene.path, [*arguments, "--context", context], 3)
    path = lamina.picture(context, scene.path, [*arguments, "--context", context])
    norms = json.loads(lamina.run("compare", path, truth, "--json"))["all"]
    return {"linf": norms["linf"], "l2": norms["l2"], "ms": frames["frame_ms"]["median"], "plan": frames["plan"]}


def shipped(quick):
    """The scenes as they are shipped: meshes that are made of volumes are left to the self test and to tools/bench."""
    return ["gaussians", "neghip", "bluntfin"] if quick else [name for name in scenes.STANDARD
                                                              if not scenes.find(name).arguments]


def pictures(lamina, quick):
    results = []
    for scene in map(scenes.find, shipped(quick)):
        if scene.missing():
            results.append({"scene": scene.name, "missing": scene.missing()})
            continue
        print(f"gpu_check: {scene.name}", file=sys.stderr)
        size, truth = sized(quick), lamina.folder / "truth.exr"
        try:
            lamina.run("render", scene.path, "-o", truth, "--quiet", *size, "--method", "trace")
            result = {context: picture(lamina, scene, size, truth, context) for context in CONTEXTS}
            between = json.loads(lamina.run("compare", lamina.folder / "egl.exr", lamina.folder / "cpu.exr", "--json"))
            results.append({"scene": scene.name, **result, "between": between["all"]["linf"]})
        except SystemExit as error:
            results.append({"scene": scene.name, "error": str(error)})
    return results


def bench(lamina, program, quick):
    print("gpu_check: bench", file=sys.stderr)
    out = lamina.folder / "bench.json"
    options = ["--scenes", "gaussians", "--frames", "1", "--rounds", "1"] if quick else []
    done = subprocess.run([sys.executable, "-B", str(program), "--contexts", "cpu,egl", "--lamina", str(lamina.program),
                           "--json", str(out), *options], capture_output=True, text=True)
    if done.returncode != 0:
        return {"error": done.stderr.strip()}
    return json.loads(out.read_text())
