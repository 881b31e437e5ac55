#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whole-frame times of VTK's projected tetrahedra (A) and of `lamina render` with method `project` (B).

    tools/bench_projection_vtk.py [--scene SCENE.json]... [--frames 10] [--rounds 3] [-o OUT.json]
    tools/bench_projection_vtk.py --vtk-only --png vtk.png

Needs Debian's python3-vtk9 (with Debian's own python3), xvfb and xauth; xvfb-run is used where DISPLAY is
not set: GL is Mesa's llvmpipe there, as in B's OSMesa. LAMINA_DATA names the folder of the data.

A round is one warm-up and N timed frames of A, then the same of B; rounds follow one another, so both
meet the same other load. The camera turns by 0.1 degree about `up` from frame to frame. A frame runs from
the camera's change to glFinish: sort, projection, upload, drawing; no files, no read-back.

Not equal work: VTK sorts by cell centres, classifies at the vertices in 8 bits, interpolates without
perspective. "triangles" is what GL counts in a frame of A (3 or 4 a tet), "sort alone" A's visibility sort.
Opacities are resampled, as VTK is linear in opacity and a scene in extinction; colours are not sRGB-coded.
"""
import argparse
import ctypes
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time


def fail(message):
    sys.exit(f"bench_projection_vtk: {message}")


try:
    import vtk
except ImportError as error:
    fail(f"{error}, in {sys.executable}; install Debian's python3-vtk9 and use Debian's python3")

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEGREES_PER_FRAME = 0.1  # as `lamina render --frames`
CORES = 2  # for both
STEPS = 64  # opacity points between two points of the scene
GL_PRIMITIVES_GENERATED, GL_QUERY_RESULT = 0x8C87, 0x8866


def ensure_display():
    """Runs this program again inside xvfb-run where there is no display."""
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("xvfb-run") or not shutil.which("xauth"):
        fail("xvfb-run or xauth: not found and DISPLAY is not set; install Debian's xvfb and xauth")
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, *sys.argv])


def read_scene(path):
    try:
        scene = json.loads(path.read_text())
    except (OSError, ValueError) as error:
        fail(f"{path}: {error}")
    mesh = scene.get("mesh")
    if not isinstance(mesh, str) or not mesh.endswith((".vtu", ".vtk")):
        fail(f"{path}: mesh: expected a .vtu or .vtk file, which VTK can read")
    scene["mesh"] = path.parent / os.path.expandvars(mesh)  # ${LAMINA_DATA}
    if not scene["mesh"].is_file():
        fail(f"{scene['mesh']}: no such file (LAMINA_DATA={os.environ.get('LAMINA_DATA', '')})")
    if scene["transfer_function"].get("interpolation") == "nearest" or "points" not in scene["transfer_function"]:
        fail(f"{path}: transfer_function: expected points and linear interpolation")
    return scene


def extinction_of(point, unit_length):
    return point.get("extinction", -math.log1p(-min(point.get("opacity", 0), 1 - 1e-9)) / unit_length)


def make_property(function):
    points = [(p["value"], p["color"], extinction_of(p, function.get("unit_length", 1))) for p in function["points"]]
    color, opacity, result = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
    color.AllowDuplicateScalarsOn()  # steps
    opacity.AllowDuplicateScalarsOn()
    unit = 3 / (max(extinction for _, _, extinction in points) or 3)  # opacity 0.95 at most, in 8 bits
    for (x0, _, e0), (x1, _, e1) in zip(points, points[1:] + points[-1:]):
        for t in [i / STEPS for i in range(STEPS if x1 > x0 else 1)]:
            opacity.AddPoint(x0 + t * (x1 - x0), -math.expm1(-unit * (e0 + t * (e1 - e0))))
    for value, rgb, _ in points:
        color.AddRGBPoint(value, *rgb)
    result.SetColor(color)
    result.SetScalarOpacity(opacity)
    result.SetScalarOpacityUnitDistance(unit)
    return result


class VtkSide:
    def __init__(self, scene, size):
        self.scene = scene
        path = str(scene["mesh"])
        reader = vtk.vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtk.vtkUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
        self.tets = grid.GetNumberOfCells()
        name = scene.get("scalar", grid.GetPointData().GetArrayName(0))
        if not name or not grid.GetPointData().HasArray(name):
            fail(f"{path}: no point array {name!r}")
        if not self.tets or not grid.IsHomogeneous() or grid.GetCellType(0) != vtk.VTK_TETRA:
            fail(f"{path}: expected tetrahedra only: VTK's mapper draws no other cells")
        self.mapper, volume = vtk.vtkProjectedTetrahedraMapper(), vtk.vtkVolume()
        self.mapper.SetInputData(grid)
        self.mapper.SetScalarModeToUsePointFieldData()
        self.mapper.SelectScalarArray(name)
        volume.SetMapper(self.mapper)
        volume.SetProperty(make_property(scene["transfer_function"]))
        self.renderer, self.window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
        self.renderer.AddVolume(volume)  # a plain volume: no level of detail
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        self.triangles = self.count_triangles()
        self.gl = self.window.ReportCapabilities().partition("renderer string:")[2].partition("\n")[0].strip()

    def set_camera(self, degrees):
        """The scene's camera, its eye turned about `up` through the centre."""
        wanted, turn = self.scene["camera"], vtk.vtkTransform()
        turn.Translate(wanted["center"])
        turn.RotateWXYZ(degrees, wanted["up"])
        turn.Translate([-x for x in wanted["center"]])
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(turn.TransformPoint(wanted["eye"]))
        camera.SetFocalPoint(wanted["center"])
        camera.SetViewUp(wanted["up"])
        if wanted.get("projection") == "orthographic":
            camera.ParallelProjectionOn()
            camera.SetParallelScale(wanted["height"] / 2)
        else:
            camera.SetViewAngle(wanted["fov_y"])
        self.renderer.ResetCameraClippingRange()  # VTK drops whole tets that cross the near plane

    def frame_ms(self, degrees):
        start = time.perf_counter()
        self.set_camera(degrees)
        self.window.Render()
        self.window.WaitForCompletion()  # glFinish
        return (time.perf_counter() - start) * 1e3

    def round(self, frames):
        times = [self.frame_ms(DEGREES_PER_FRAME * i) for i in range(frames + 1)][1:]
        return {"median": statistics.median(times), "min": min(times), "max": max(times), "n": frames}

    def sort_ms(self):
        sort = self.mapper.GetVisibilitySort()  # input, camera and direction are the last frame's
        start = time.perf_counter()
        sort.InitTraversal()
        while sort.GetNextCells():
            pass
        return (time.perf_counter() - start) * 1e3

    def count_triangles(self):
        gl, query, count = ctypes.CDLL("libGL.so.1"), ctypes.c_uint(), ctypes.c_uint()
        self.frame_ms(0)  # opens the window
        gl.glGenQueries(1, ctypes.byref(query))
        gl.glBeginQuery(GL_PRIMITIVES_GENERATED, query)
        self.frame_ms(0)
        gl.glEndQuery(GL_PRIMITIVES_GENERATED)
        gl.glGetQueryObjectuiv(query, GL_QUERY_RESULT, ctypes.byref(count))
        gl.glDeleteQueries(1, ctypes.byref(query))
        return count.value

    def write_png(self, path):
        self.frame_ms(0)
        grab, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
        grab.SetInput(self.window)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.SetFileName(path)
        writer.Write()


def lamina_round(path, size, args):
    sets = ["render.method=project", f"image.width={size[0]}", f"image.height={size[1]}", *args.set]
    with tempfile.TemporaryDirectory() as folder:
        command = [args.lamina, "render", str(path), "-o", folder + "/frame.exr", "--frames", str(args.frames),
                   "--stats", folder + "/stats.json", "--context", "osmesa", *(f"--set={one}" for one in sets)]
        done = subprocess.run(command + ["--quiet"], capture_output=True, text=True)
        if done.returncode:
            fail(f"{args.lamina} ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(pathlib.Path(folder, "stats.json").read_text())


def measure(path, args):
    scene = read_scene(path)
    size = args.size or (scene["image"]["width"], scene["image"]["height"])
    a, rounds, stats = VtkSide(scene, size), {"vtk": [], "lamina": []}, None
    for _ in range(args.rounds):
        rounds["vtk"].append(a.round(args.frames))
        if not args.vtk_only:
            stats = lamina_round(path, size, args)
            rounds["lamina"].append(stats["frame_ms"])
    result = {"scene": path.name, "size": size, "tets": a.tets, "vtk_version": vtk.vtkVersion.GetVTKVersion(),
              "gl_renderer": a.gl, "triangles": a.triangles, "lamina_stats": stats, "rounds": rounds,
              "sort_ms": statistics.median(a.sort_ms() for _ in range(5))}
    if args.png:
        a.write_png(args.png)
    a.window.Finalize()
    print(f"{path.name}: {size[0]} x {size[1]}, {a.tets} tets; ms a frame: median, min, max (medians of the rounds)\n"
          f"  VTK {result['vtk_version']}, {a.gl}: {a.triangles} triangles, sort alone {result['sort_ms']:.1f} ms")
    if stats:
        print(f"  lamina, {stats['context']}: {stats['tets_drawn']} tets drawn")
        result["ratios"] = [b["median"] / v["median"] for v, b in zip(rounds["vtk"], rounds["lamina"])]
    for name, each in rounds.items():
        if each:
            medians = [one["median"] for one in each]
            result[name] = {"median": statistics.median(medians), "min": min(one["min"] for one in each),
                            "max": max(one["max"] for one in each), "n": sum(one["n"] for one in each)}
            print(f"  {name:8}" + "".join(f"{result[name][key]:9.1f}" for key in ("median", "min", "max")),
                  f"  ({' '.join(f'{m:.1f}' for m in medians)})")
    if stats:
        result["ratio"] = result["lamina"]["median"] / result["vtk"]["median"]
        print(f"  lamina / VTK = {result['ratio']:.3f}   ({' '.join(f'{r:.3f}' for r in result['ratios'])})")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", action="append", type=pathlib.Path, help="default: data/scenes/bluntfin.json")
    for name, default in (("--frames", 10), ("--rounds", 3)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--size", type=int, nargs=2, metavar=("W", "H"), help="instead of the scene's")
    parser.add_argument("--lamina", default=str(ROOT / "build/release/lamina"))
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="for lamina, as its --set")
    parser.add_argument("--vtk-only", action="store_true")
    parser.add_argument("--png", metavar="FILE", help="write VTK's picture (of the last scene)")
    parser.add_argument("-o", metavar="FILE", help="write the figures as JSON")
    args = parser.parse_args()
    if min(args.frames, args.rounds) < 1:
        parser.error("--frames and --rounds: expected at least 1")
    if not args.vtk_only and not shutil.which(args.lamina):
        fail(f"{args.lamina}: no such program; build lamina, name it with --lamina, or take --vtk-only")
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:CORES])  # inherited by Xvfb and lamina
    os.environ["LP_NUM_THREADS"] = str(CORES)
    ensure_display()
    results = [measure(path, args) for path in args.scene or [ROOT / "data/scenes/bluntfin.json"]]
    if args.o:
        pathlib.Path(args.o).write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
