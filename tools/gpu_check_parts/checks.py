# SPDX-License-Identifier: Apache-2.0
"""The checks, each of which gives plain data for the report."""
import datetime
import json
import os
import platform
import subprocess

from bench_parts import processor, scenes
from bench_parts.lamina import OutOfTime

CONTEXTS = ("egl", "cpu")
# Seconds of each part, below 9 minutes in all: a machine with a GPU may be lent for 10.
LIMITS = {"start": 20, "probe": 40, "selftest": 60, "pictures": 50, "frames": 250, "ways": 120}


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
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMITS["start"])
    except OSError as error:
        print(f"gpu_check: {lamina.program}: {error.strerror}: build lamina or name it with --lamina")
        return None
    except subprocess.TimeoutExpired:
        print(f"gpu_check: EGL does not draw here: no picture within {LIMITS['start']} s")
        return None
    if done.returncode != 0:
        print(f"gpu_check: EGL does not draw here: {done.stderr.strip()}")
        return None
    return json.loads(stats.read_text())["context"]


def problem(error):
    """A result in place of figures: only programs that failed, not those that had no time, are a failure."""
    return {"missing" if isinstance(error, OutOfTime) else "error": str(error)}


def own_report(lamina, folder, name, arguments):
    """A report of `lamina selftest` by EGL. Exit code 3 says that a bound was not kept, which the cases say, too."""
    try:
        lamina.run("selftest", "-o", folder, "--context", "egl", "--force", "--quiet", *arguments, accepted=(0, 3))
    except SystemExit as error:
        return problem(error)
    return json.loads((folder / name).read_text())


def selftest(lamina, output, quick):
    report = own_report(lamina, output / "selftest", "selftest.json", ["--group", "optics"] if quick else [])
    if "cases" not in report:
        return report
    cases = report["cases"]
    return {"passed": sum(case["verdict"] == "passed" for case in cases), "cases": len(cases),
            "failed": [case for case in cases if case["verdict"] != "passed"]}


def probe(lamina, output, quick):
    """One kernel as a fragment and as a compute shader."""
    return own_report(lamina, output / "probe", "probe.json", ["--probe", "32x24" if quick else "1920x1080"])


def sized(quick):
    width, height = (96, 72) if quick else (400, 300)
    return ["--set", f"image.width={width}", "--set", f"image.height={height}"]


def picture(lamina, scene, arguments, truth, context):
    """One scene by one context: its error against the truth."""
    stats = lamina.folder / "stats.json"
    path = lamina.picture(context, scene.path, [*arguments, "--context", context, "--stats", stats])
    norms = json.loads(lamina.run("compare", path, truth, "--json"))["all"]
    return {"linf": norms["linf"], "l2": norms["l2"], "plan": json.loads(stats.read_text())["plan"]}


def shipped(quick):
    """The scenes as they are shipped: meshes that are made of volumes are left to the self test and to the frames."""
    return ["gaussians", "neghip", "bluntfin"] if quick else [name for name in scenes.STANDARD
                                                              if not scenes.find(name).arguments]


def pictures(lamina, quick):
    results = []
    for scene in map(scenes.find, shipped(quick)):
        if scene.missing():
            results.append({"scene": scene.name, "missing": scene.missing()})
            continue
        size, truth = sized(quick), lamina.folder / "truth.exr"
        try:
            lamina.run("render", scene.path, "-o", truth, "--quiet", *size, "--method", "trace")
            result = {context: picture(lamina, scene, size, truth, context) for context in CONTEXTS}
            between = json.loads(lamina.run("compare", lamina.folder / "egl.exr", lamina.folder / "cpu.exr", "--json"))
            results.append({"scene": scene.name, **result, "between": between["all"]["linf"]})
        except SystemExit as error:
            results.append({"scene": scene.name, **problem(error)})
    return results
