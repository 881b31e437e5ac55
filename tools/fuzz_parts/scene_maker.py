# SPDX-License-Identifier: Apache-2.0
"""Whole random scenes: data, transfer function, camera, how it is drawn. The same seed gives the same scene."""
import json
from dataclasses import dataclass, field

import numpy

from . import cameras, clips, lights, markers, meshes, transfer, volumes
from .dice import Dice


@dataclass
class RandomScene:
    seed: int
    scene: dict
    files: dict  # contents by name
    arguments: list  # of `lamina render`
    volume: volumes.Volume = None
    mesh: meshes.Mesh = None
    labels: dict = field(default_factory=dict)  # what it is, for people
    marked: bool = False  # what shows is a window that may be far narrower than the data

    def write(self, folder):
        for name, data in self.files.items():
            (folder / name).write_bytes(data)
        (folder / "scene.json").write_text(json.dumps(self.scene, indent=1) + "\n")


def tree(dice, target):
    if dice.chance(0.4):
        return "auto"
    fixed = target in ("fixed8", "fixed16", "emulated") and (target == "emulated" or dice.chance(0.2))
    found = {"factors": [dice.whole(1, 12) for _ in range(dice.whole(1, 3))], "nodes": "fixed" if fixed else "shader"}
    if not fixed:
        found["code"] = dice.pick("minimax", "minimax", "phi", "alpha")
        if target == "fixed8":
            found["alpha_bits"] = dice.pick(8, 16)
    return found


def emulation(dice):
    return {"bits": dice.whole(4, 16), "alpha": dice.pick("truncate", "nearest", "stochastic"),
            "over": dice.pick("separate", "fused"), "seed": dice.whole(0, 1000)}


def slicing(dice):
    target = dice.weighted(float32=6, float16=0.7, fixed16=0.7, fixed8=0.7, emulated=0.7, auto=1.2)
    render = {"method": "slice", "target": target}
    if target == "emulated":
        render["emulate"] = emulation(dice)
    if dice.chance(0.5):
        render["max_error"] = dice.pick(0.25, 0.5, 2, 4, 16)
    found = render["slice"] = {}
    if dice.chance(0.45):
        found["samples"] = dice.pick(1, 2, 3, 7, 16, 33, 64, 100, 200)
    found["classification"] = dice.pick("post", "preintegrated", "exact", "auto")
    found["order"] = dice.pick("back_to_front", "front_to_back")
    if dice.chance(0.1) and found["classification"] != "exact":
        found["filter"] = dice.pick("hardware", "auto")
    if dice.chance(0.15) and target in ("fixed8", "fixed16", "emulated"):
        found["dither"] = {"period": dice.pick(4, 16, "auto"), "color": dice.chance(0.5),
                           "increment": dice.pick(1, 1, 4)}
    if dice.chance(0.2):
        found["tree"] = tree(dice, target)
    return render


def projecting(dice):
    target = dice.weighted(float32=7, float16=0.4, fixed16=0.6, fixed8=0.5, emulated=0.4, auto=1)
    render = {"method": "project", "target": target}
    if target == "emulated":
        render["emulate"] = emulation(dice)
    found = render["project"] = {}
    found["coloring"] = dice.weighted(preintegrated=5, analytic=2, attenuation=0.3, vertex=0.3)
    if dice.chance(0.3):
        found["geometry"] = dice.pick("silhouette", "triangles")
    if dice.chance(0.1):
        found["order"] = dice.pick("mpvo", "exact", "centroid", "none")
    if dice.chance(0.1):
        found["interpolation"] = "linear"
    if dice.chance(0.05):
        found["thickness"] = "dz"
    if dice.chance(0.1) and target != "float32":
        found["dither"] = dice.pick("alpha", "after_blend")
    if dice.chance(0.15) and found["coloring"] == "preintegrated":
        found["table"] = {"scalar": dice.pick(16, 64, 200), "length": dice.pick(4, 16),
                          "mapping": dice.pick("octave", "log2", "linear"),
                          "store": dice.pick("mean_extinction", "opacity"),
                          "format": dice.pick("fixed16", "fixed8", "float16", "float32"),
                          "construction": dice.pick("exact", "incremental")}
    return render


def omissions(dice):
    kind = dice.weighted(all=6, none=2, one=1)
    if kind == "all":
        return []
    return ["--no-omit"] if kind == "none" else ["--no-omit=" + dice.pick(
        "empty_space", "early_termination", "constant_regions", "blending", "table", "length_layers", "color",
        "smooth_points")]


def world_scale(dice):
    """Voxels of about so many world units."""
    if dice.chance(0.06):
        return dice.pick(dice.log_between(1e-35, 1e-28), dice.log_between(1e-28, 1e18), dice.log_between(1e18, 1e25))
    return dice.pick(1, 1, dice.log_between(1e-3, 1e3))


def image(dice):
    width, height = dice.whole(12, 40), dice.whole(12, 40)
    kind = dice.weighted(small=90, line=4, large=4)
    if kind == "line":
        width, height = dice.pick((1, 1), (64, 1), (1, 50))
    elif kind == "large":  # more rays than `samples: auto` traces
        width, height = dice.whole(220, 330), dice.whole(170, 240)
    return {"width": width, "height": height}


def assembled(seed, dice, data, corner, edges, made, lit):
    length = float(numpy.linalg.norm(edges.sum(1))) or float(numpy.abs(edges).max())
    made.scene["transfer_function"], made.labels["transfer"] = transfer.make(dice, data.finite_range(), length)
    made.scene["camera"], made.labels["camera"] = cameras.make(dice, corner, edges)
    made.scene["image"] = image(dice)
    cuts = Dice(seed + (1 << 33))  # of their own, so that scenes without clips stay as they were
    if cuts.chance(0.2):
        made.scene["clip"] = clips.make(cuts, corner, edges, made.scene["camera"]["eye"])
        made.labels["clip"] = " and ".join(made.scene["clip"])
    lamps = Dice(seed + (1 << 34))
    if lamps.chance(0.12) or lit:
        made.scene["lighting"] = lights.make(lamps, data.finite_range(), length)
        made.labels["light"] = str(len(made.scene["lighting"].get("lights", [0])))
    if dice.chance(0.04):
        made.arguments += ["--context", "osmesa"]
    else:
        made.arguments += ["--context", "cpu"]
    return made


def volume_scene(seed, dice, lit):
    volume = volumes.make(dice, world_scale(dice))
    low, high = volume.corners()
    corner, edges = volume.to_world(low), volume.steps * (high - low)
    scene = {"version": 1, "volume": "volume.nrrd"}
    if (volume.samples == numpy.rint(volume.samples)).all():  # else blocks of them may be taken for labels
        scene["volume"] = {"path": "volume.nrrd", "lookup": "linear"}
    if not numpy.isfinite(volume.samples).all():
        scene["nan"] = "transparent"
        volume.kind += " with NaN"
    made = RandomScene(seed, scene, {"volume.nrrd": volumes.nrrd(volume, dice)}, [], volume=volume,
                       labels={"data": f"{volume.type} {volume.kind}"})
    made = assembled(seed, dice, volume, corner, edges, made, lit)
    if dice.chance(0.05) and volume.samples.size < 2000:
        made.scene["mesh"] = {"kuhn": True} if dice.chance(0.5) else {"tolerance": dice.log_between(0.005, 0.3),
                                                                      "max_tets": 3000}
        made.labels["data"] += " as a mesh"
    made.scene["render"] = projecting(dice) if "mesh" in made.scene else slicing(dice)
    made.arguments += omissions(dice)
    voxels = Dice(seed + (1 << 36))  # of their own, so that other scenes stay as they were
    if voxels.chance(0.15) and "mesh" not in made.scene and "lighting" not in made.scene:
        take_nearest(made)
    return made


def take_nearest(made):
    """Makes the field constant in each voxel, which exact segments alone draw."""
    made.volume.nearest = True
    made.scene["volume"] = {"path": "volume.nrrd", "lookup": "nearest"}
    made.labels["data"] += ", voxels"
    settings = made.scene["render"]["slice"]
    settings.pop("filter", None)
    if settings["classification"] != "auto":
        settings["classification"] = "exact"


def around_mesh(seed, dice, mesh, shown, lit):
    """A scene of a mesh, and the edges of its box. `shown`: what the range that counts is taken of."""
    corner = mesh.points.min(0)
    edges = numpy.diag(mesh.points.max(0) - corner)
    name, files = meshes.files(mesh, dice)
    scene = {"version": 1, "mesh": name}
    if not numpy.isfinite(mesh.values).all():
        scene["nan"] = "transparent"
        mesh.kind += ", NaN"
    made = RandomScene(seed, scene, files, [], mesh=mesh, labels={"data": f"{mesh.kind} mesh"})
    return assembled(seed, dice, shown, corner, edges, made, lit), edges


def mesh_scene(seed, dice, lit):
    mesh = meshes.make(dice, world_scale(dice))
    made, edges = around_mesh(seed, dice, mesh, mesh, lit)
    if dice.chance(0.1):  # on a corner
        eye = mesh.points[dice.whole(0, len(mesh.points) - 1)]
        if numpy.linalg.norm(eye - made.scene["camera"]["center"]) > 1e-3 * numpy.abs(edges).max():
            made.scene["camera"]["eye"] = eye.tolist()
            made.labels["camera"] = "corner of a tet"
            made.scene["camera"]["up"] = cameras.up_for(
                (eye - made.scene["camera"]["center"]) / numpy.linalg.norm(eye - made.scene["camera"]["center"]), dice)
    made.scene["render"] = projecting(dice)
    made.arguments += omissions(dice) if dice.chance(0.5) else []
    return made


class Values:
    """Data as far as their range counts."""

    def __init__(self, value_range):
        self.value_range = value_range

    def finite_range(self):
        return self.value_range


def marked_scene(seed, lit):
    """A mesh with values far from all others (markers.py)."""
    dice = Dice(seed + (1 << 35))
    mesh = meshes.make(dice, world_scale(dice))
    shown = markers.window(mesh, dice) if dice.chance(0.2) else markers.mark(mesh, dice)
    made, _ = around_mesh(seed, dice, mesh, Values(shown), lit)
    made.marked = True
    if dice.chance(0.15):
        made.scene["transfer_function"], made.labels["transfer"] = "auto", "auto"
    elif dice.chance(0.2):  # the values far away show, too
        point = dict(made.scene["transfer_function"]["points"][-1])
        point["value"] = float(numpy.nanmax(mesh.values))
        if point["value"] > made.scene["transfer_function"]["points"][-1]["value"]:
            made.scene["transfer_function"]["points"].append(point)
    made.scene["render"] = projecting(dice)
    made.arguments += omissions(dice) if dice.chance(0.5) else []
    return made


def flat_volume_scene(seed, lit):
    """Samples of one value, and a table of many points around it: what is left out of such a scene is easy to miss."""
    dice = Dice(seed + (1 << 35))
    size = [dice.whole(2, 4) for _ in range(3)]
    kind = dice.pick("int16", "uint16", "float")
    value = float(dice.whole(1000, 32000))
    samples = numpy.full(size, value).astype(volumes.TYPES[kind])
    steps, origin = volumes.steps_and_origin(size, dice, world_scale(dice))
    volume = volumes.Volume(samples, kind, [dice.chance(0.5) for _ in range(3)], origin, steps, "flat")
    low, high = volume.corners()
    made = RandomScene(seed, {"version": 1, "volume": "volume.nrrd"}, {"volume.nrrd": volumes.nrrd(volume, dice)}, [],
                       volume=volume, labels={"data": f"{kind} flat"})
    made = assembled(seed, dice, Values((value - 1, value + 1)), volume.to_world(low), steps * (high - low), made, lit)
    made.scene["render"] = slicing(dice)
    made.scene["render"]["slice"]["classification"] = dice.pick("preintegrated", "preintegrated", "post", "exact")
    made.arguments += ["--no-omit"]
    return made


def make(seed, lit=False, marked=False):
    if marked:
        return flat_volume_scene(seed, lit) if seed % 10 == 0 else marked_scene(seed, lit)
    dice = Dice(seed)
    return volume_scene(seed, dice, lit) if dice.chance(0.68) else mesh_scene(seed, dice, lit)
