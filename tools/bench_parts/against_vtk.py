# SPDX-License-Identifier: Apache-2.0
"""Time and error of VTK's mappers and of lamina's methods, on one scene in one run."""
import os
import shutil
import statistics
import sys

from bench_parts import rounds

SAMPLES = [16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096]
CLASSIFICATIONS = ["post", "preintegrated"]


def ensure_vtk():
    """Runs this program again with Debian's python3 if this one has no VTK, and if there is no display inside
    xvfb-run: there GL is Mesa's llvmpipe."""
    debian = "/usr/bin/python3"
    try:
        import vtk  # noqa: F401
    except ImportError as error:
        if os.path.realpath(sys.executable) == os.path.realpath(debian) or not os.path.exists(debian):
            raise SystemExit(f"bench: {error}, in {sys.executable}; install Debian's python3-vtk9")
        os.execv(debian, [debian, *sys.argv])
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("xvfb-run") or not shutil.which("xauth"):
        raise SystemExit("bench: xvfb-run or xauth: not found and DISPLAY is not set; install Debian's xvfb and xauth")
    os.environ["LP_NUM_THREADS"] = str(len(os.sched_getaffinity(0)))
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, *sys.argv])


class Comparison:
    """One scene: `vtk` are windows by name, `lamina` the arguments of ways by name."""

    def __init__(self, lamina, scene, options):
        self.runs, self.scene, self.options = lamina, scene, options
        image = scene.json["image"]
        self.size = options.size or [image["width"], image["height"]]
        self.common = [*scene.arguments, f"--set=image.width={self.size[0]}", f"--set=image.height={self.size[1]}"]
        self.reference = lamina.picture(f"{scene.name}-trace", scene.path, [*self.common, "--method", "trace"])
        self.vtk, self.lamina, self.errors = {}, {}, {}

    def add_vtk(self, name, window):
        picture = self.runs.folder / "vtk.npy"
        window.write_picture(picture)
        self.vtk[name] = window
        self.errors[name] = self.runs.color_error(picture, self.reference)

    def add_lamina(self, name, arguments):
        self.lamina[name] = [*self.common, *arguments]
        self.errors[name] = self.error_of(arguments)

    def error_of(self, arguments):
        picture = self.runs.picture("lamina", self.scene.path, [*self.common, *arguments])
        return self.runs.color_error(picture, self.reference)

    def add_volume(self, context):
        """VTK at one and at two samples a voxel; for each the fewest slabs of lamina's with an L2 at most as large, and
        exact segments."""
        from bench_parts import vtk_side
        slicing = ["--method", "slice", "--context", context]
        for steps in (1, 2):
            name = f"vtk {steps} a voxel"
            self.add_vtk(name, vtk_side.volume_window(self.scene, self.size, steps))
            for classification in CLASSIFICATIONS:
                way = [*slicing, f"--set=render.slice.classification={classification}"]
                for samples in SAMPLES:
                    arguments = [*way, f"--set=render.slice.samples={samples}"]
                    if self.error_of(arguments)["l2"] <= self.errors[name]["l2"]:
                        self.add_lamina(f"{context} {classification} {samples}", arguments)
                        break
        if context == "cpu":
            self.add_lamina("cpu exact", [*slicing, "--set=render.slice.classification=exact"])

    def add_mesh(self, context):
        from bench_parts import vtk_side
        self.add_vtk("vtk", vtk_side.mesh_window(self.scene, self.size))
        self.add_lamina(context, ["--method", "project", "--context", context])

    def measure(self):
        frames = self.options.frames
        ways = {name: (lambda window=window: window.median_ms(frames)) for name, window in self.vtk.items()}
        first_pictures = {name: [] for name in self.lamina}

        def timed(name):
            stats = self.runs.frames(self.scene.path, self.lamina[name], frames)
            first_pictures[name].append(stats["first_picture_ms"])
            return stats["frame_ms"]["median"]

        ways.update({name: (lambda name=name: timed(name)) for name in self.lamina})
        times = rounds.interleaved(ways, self.options.rounds)
        gl = next(iter(self.vtk.values())).gl
        for window in self.vtk.values():
            window.close()
        result = {"scene": self.scene.name, "size": self.size, "gl": gl, "ways": []}
        for name in ways:
            way = {"name": name, "ms": statistics.median(times[name]), "rounds_ms": times[name], **self.errors[name]}
            if name in self.lamina:
                way["first_picture_ms"] = statistics.median(first_pictures[name])
                way["against"] = {vtk: {"times_as_fast": rounds.ratio(times[vtk], times[name]),
                                        "l2_ratio": self.errors[vtk]["l2"] / self.errors[name]["l2"]}
                                  for vtk in self.vtk if self.errors[name]["l2"] <= self.errors[vtk]["l2"]}
            result["ways"].append(way)
        return result


def print_result(result):
    print(f"{result['scene']}: {result['size'][0]} x {result['size'][1]}, VTK on {result['gl']}; errors in 1/255")
    print(f"  {'':28} {'ms a frame':>10} {'first picture':>13} {'Linf':>8} {'L2':>8}")
    for way in result["ways"]:
        first = f"{way['first_picture_ms']:.1f}" if "first_picture_ms" in way else "-"  # VTK's is not timed
        print(f"  {way['name']:28} {way['ms']:10.1f} {first:>13} {way['linf']:8.3f} {way['l2']:8.4f}")
        for name, found in way.get("against", {}).items():
            print(f"    against {name}: {rounds.ratio_text(found['times_as_fast'])}, L2 "
                  f"{found['l2_ratio']:.1f} times smaller")


def compare(lamina, scene, options, context):
    comparison = Comparison(lamina, scene, options)
    if isinstance(scene.json.get("mesh"), str):
        comparison.add_mesh(context)
    else:
        comparison.add_volume(context)
    result = comparison.measure()
    print_result(result)
    return result
