# SPDX-License-Identifier: Apache-2.0
"""A random scene's pictures against what lamina claims of them, or its documents promise."""
import json
import platform
from dataclasses import dataclass, field

import numpy

from . import cameras, emission, lights, mesh_oracle, transfer, volume_oracle
from .program import Program

EXACT = 0.05  # of exact segments, in 1/255
CURVES = 0.17  # of cubics in place of pieces (docs/omissions.md, smooth_points), in 1/255
CODES = {"float32": 2.0 ** -24, "float16": 2.0 ** -11, "fixed16": 0.5 / 65535, "fixed8": 0.5 / 255}
TRACE = ["--method", "trace", "--set", "render.trace.tolerance=1e-7"]
OF_MESH = ["--set", "render.trace.of=mesh"]
PLAIN = ["--method", "trace", "--plain"]
PLAIN_SIZE = ["--set", "image.width=48", "--set", "image.height=36"]
ORACLE_PIXELS = 8
SLAB_PIXELS = 300
STRAIGHT_PIXELS = 60


@dataclass
class Verdict:
    seed: int
    labels: dict
    findings: list = field(default_factory=list)
    checks: dict = field(default_factory=dict)  # by name: how many times its bound was used at most
    refusal: str = ""
    doubted: bool = False  # `samples: auto` that said that max_error is not kept, or not surely
    commands: list = field(default_factory=list)


# A run's seconds are for a picture of so many pixels; larger ones get more.
MANY_PIXELS = 64 * 64


class Judge:
    def __init__(self, made, lamina, folder, seconds):
        self.made, self.folder = made, folder
        size = made.scene["image"]
        pixels = size["width"] * size["height"]
        self.program = Program(lamina, folder, seconds * max(1, pixels / MANY_PIXELS))
        self.verdict = Verdict(made.seed, made.labels, self.program.findings, commands=self.program.commands)
        self.optics = None
        if made.scene["transfer_function"] != "auto":
            self.take_optics()
        self.lit = "lighting" in made.scene
        self.render = made.scene["render"]
        self.max_error = self.render.get("max_error", 1)
        self.rays = cameras.Rays(made.scene["camera"], size["width"], size["height"])

    def take_optics(self):
        self.optics = transfer.Optics(self.made.scene["transfer_function"])
        if "lighting" in self.made.scene:
            self.optics.brightest = lights.brightest(self.made.scene["lighting"], self.optics.brightest)

    def choose_transfer_function(self):
        """Takes the one that lamina chooses; False if it chooses none."""
        chosen = self.program.chosen_scene("chosen_scene.json")
        if chosen is None:
            return False
        self.made.scene["transfer_function"] = chosen["transfer_function"]
        self.made.write(self.folder)
        self.take_optics()
        return True

    def check(self, name, error, bound, text=""):
        """In parts of full scale; error and bound as arrays of the same shape, or numbers."""
        with numpy.errstate(divide="ignore", invalid="ignore"):
            shares = numpy.nan_to_num(numpy.asarray(error / bound), nan=0.0, posinf=1e300)
        share = float(shares.max()) if shares.size else 0.0
        self.verdict.checks[name] = max(share, self.verdict.checks.get(name, 0.0))
        if share <= 1:
            return
        at = numpy.unravel_index(shares.argmax(), shares.shape)
        worst = float(numpy.broadcast_to(error, shares.shape)[at]) * 255
        allowed = float(numpy.broadcast_to(bound, shares.shape)[at]) * 255
        self.program.report(name, f"{worst:.4g} / 255, allowed {allowed:.4g}{text}", share)

    def run(self):
        self.made.write(self.folder)
        if self.optics is None and not self.choose_transfer_function():
            self.verdict.refusal = getattr(self.program, "refusal", "")
            return self.verdict
        traced = self.program.render("traced", TRACE, ".npy")
        drawn = self.program.render("drawn", self.made.arguments)
        if drawn is None:
            self.verdict.refusal = getattr(self.program, "refusal", "")
        if traced is not None and not self.lit:  # lit rays have cases of their own (tests/reference/lit_cases.json)
            self.tracer(traced)
        if traced is not None:
            self.plain([])
            if self.made.volume and "mesh" in self.made.scene:
                self.plain(OF_MESH)
        if traced is not None and drawn is not None:
            self.drawn(drawn, traced)
        return self.verdict

    def plain(self, of):
        """The tracer against its plain twin, whose time is not judged."""
        name = "mesh" if of else "scene"
        traced = self.program.render(f"{name}_traced", TRACE + of + PLAIN_SIZE, ".npy")
        plain = self.program.render(f"{name}_plain", PLAIN + of + PLAIN_SIZE, ".npy", patience=20)
        if traced is None or plain is None:
            return
        error, bound = numpy.abs(traced.picture - plain.picture).max(2), 1e-5
        if error.max() > bound:  # the last digits of the eye may decide on opaque data along a ray in their face
            bound = bound + 4 * self.change_by_moving(self.rounding(), TRACE + of + PLAIN_SIZE, traced.picture)
        self.check("plain", error, bound, f" (estimates {255 * traced.stats['error_estimate']:.2g} and "
                                          f"{255 * plain.stats['error_estimate']:.2g})")

    def drawn(self, drawn, traced):
        if self.made.seed % 8 == 0 and platform.machine() == "x86_64" and drawn.stats["context"].startswith("cpu"):
            self.same(drawn)
        if self.render["method"] == "slice":
            return self.slices(drawn, traced.picture)
        if self.made.volume:  # a mesh made from it
            traced = self.program.render("traced_mesh", TRACE + OF_MESH, ".npy")
        return traced and self.tets(drawn, traced.picture)

    def same(self, drawn):
        """Neither instructions nor threads change a picture (docs/architecture.md)."""
        least = self.program.render("least", self.made.arguments, least=True)
        if least is not None:
            differ = int((least.picture != drawn.picture).any(2).sum())
            self.check("same", float(differ), 1e-9, f" is nothing: {differ} pixels differ with SSE4 on one processor")

    # The tracer against code that shares nothing with it.
    def tracer(self, traced):
        pixels = self.oracle_pixels(traced.picture)
        data = self.made.volume or self.made.mesh
        pieces_of = volume_oracle.pieces if self.made.volume else mesh_oracle.pieces
        origins, directions = self.rays.of(*pixels)
        count = len(origins)
        shifts = [numpy.zeros(3), *self.ways(self.rounding())]
        pieces = pieces_of(data, numpy.concatenate([origins + shift for shift in shifts]),
                           numpy.tile(directions, (len(shifts), 1)), self.made.scene.get("clip"))
        thin, doubt = emission.thin_pieces(pieces, self.optics, count * len(shifts))
        colors, coarser = (emission.emitted(thin, count * len(shifts), nodes).reshape(len(shifts), count, 4)
                           for nodes in (8, 6))
        doubt = numpy.minimum(doubt.reshape(len(shifts), count).max(0), self.optics.brightest)
        spread = numpy.abs(colors - colors[0]).max((0, 2))
        converged = numpy.abs(colors - coarser).max((0, 2))
        # Beside these, double precision: some 1e-10 of full scale if a peak is 1e-4 of the values' range wide.
        bound = (traced.stats["error_estimate"] + 4 * spread + 4 * converged + doubt + 1e-9 * self.optics.brightest
                 + self.optics.off)
        error = numpy.abs(traced.picture[pixels[1], pixels[0]] - colors[0]).max(1)
        self.check("tracer", error, bound, f" (estimate {255 * traced.stats['error_estimate']:.2g})")

    def rounding(self):
        """How much the roundings of the eye's and the data's own coordinates may move a ray."""
        data = self.made.volume or self.made.mesh
        largest = numpy.abs(data.origin if self.made.volume else data.points).max()
        reach = max(largest, numpy.abs(self.rays.eye).max(), numpy.linalg.norm(
            self.rays.eye - numpy.array(self.made.scene["camera"]["center"])))
        return 2.0 ** -49 * reach

    def ways(self, length):
        """To all sides."""
        return [length * (a * self.rays.right + b * self.rays.up + c * self.rays.forward)
                for a, b, c in ((1, 1, 1), (-1, 1, -1), (1, -1, -1), (-1, -1, 1))]

    def oracle_pixels(self, picture):
        """Spread over those that show something, and two more."""
        seen = numpy.flatnonzero(picture[..., 3].ravel() > 0)
        steps = numpy.linspace(0, len(seen) - 1, ORACLE_PIXELS).astype(int) if len(seen) else []
        chosen = numpy.unique(numpy.concatenate([seen[steps], [self.made.seed % picture[..., 3].size, 0]]).astype(int))
        rows, columns = numpy.divmod(chosen, picture.shape[1])
        return columns, rows

    # Slicing.
    def slices(self, drawn, traced):
        plan, settings = drawn.stats["plan"], self.render["slice"]
        self.verdict.labels["slabs"] = plan["slabs"]
        error = numpy.abs(drawn.picture - traced).max(2)
        automatic = "samples" not in settings
        claims = automatic and not any("max_error" in line for line in drawn.messages)
        self.verdict.doubted = automatic and not claims
        figure = drawn.stats["error"]
        if figure["kind"] in ("derived", "estimated"):
            self.check("bound" if figure["kind"] == "derived" else "figure", error, figure["value"] / 255 + 1e-7,
                       f" by {plan['classification']} in {plan['target']}")
        elif figure["kind"] == "trials":
            self.check("figure", error, figure["value"] / 255 + 1e-7,
                       f" by {plan['slabs']} slabs, {plan['classification']}, trials on {figure['rays']} rays")
        rounding = self.rounding_bound(plan)
        if claims and rounding is not None and settings.get("filter") != "hardware":
            self.check("auto", error, self.max_error / 255 + rounding + 1e-7, f" by {plan['slabs']} slabs")
        exact = settings.get("filter", "exact") == "exact"
        if rounding is None:
            return
        if plan["target"] == "float32" and plan["classification"] == "exact":
            # Rays that graze a surface where extinction jumps may be off by more (docs/precision.md).
            most = numpy.quantile(error, 0.99)
            promised = EXACT + (self.max_error if self.lit else 0) + (CURVES if "smooth_points" in self.names(drawn) else 0)
            self.check("exact", most, promised / 255 + self.left_out(plan), f" in all but a hundredth of {error.size} pixels")
        elif plan["target"] == "float32" and exact and not self.lit:
            self.slabs(drawn, plan)
        if plan["target"] != "float32":
            self.codes(drawn, plan, rounding)
        elif plan["target"] == "float32" and not self.made.arguments[2:]:
            self.omitted(drawn, plan, traced)

    def rounding_bound(self, plan):
        """Largest error that compositing in the plan's target may add if the scene asked for it (plan/tree_choice.cpp has the
        same bounds for what is automatic, which max_error counts); None if nothing is promised."""
        target, tree = self.render.get("target", "float32"), plan.get("tree")
        asked_tree = self.render["slice"].get("tree")
        levels = tree and (len(tree["factors"]) > 1 or tree["factors"][0] < plan["slabs"])
        if levels and tree["nodes"] == "shader" and tree["code"] != "minimax":
            return None  # the other codes are there to be compared with
        if target == "auto" or asked_tree == "auto" or plan["target"] == "float32":
            return 3 * 2.0 ** -24 * plan["slabs"] * self.optics.brightest if plan["target"] == "float32" else 0.0
        if levels or tree and tree["nodes"] == "fixed":
            return None
        code = CODES.get(target) or 0.5 / (2 ** self.render["emulate"]["bits"] - 1)
        dither = plan.get("dither")
        opacity = 1
        if dither:
            opacity = 2 * dither["increment"]
        elif target == "emulated" and self.render["emulate"]["alpha"] != "nearest":
            opacity = 2
        roundings = plan["slabs"] * (2 + opacity + (plan["order"] == "front_to_back"))
        roundings += 2 * dither["increment"] if dither and dither["color"] else target == "emulated"
        if tree:
            roundings = 1 + plan["slabs"] * 3 * 2.0 ** -24 / code
        brightest = self.optics.brightest
        return min(roundings * code * brightest if target == "float16" else roundings * code + brightest - 1, brightest)

    def left_out(self, plan):
        """Largest difference between two pictures of the same slabs in float32: float32's roundings (docs/precision.md,
        "Opacity in float32"), what lies behind the depth where marching ends (max_error / 1024), empty bricks
        (.026 / 255)."""
        return ((self.max_error / 1024 + 0.026) / 255
                + self.optics.brightest * (1e-5 + plan["slabs"] * 2.0 ** -22))

    def slabs(self, drawn, plan):
        """So many slabs are a definite picture."""
        straight = plan["classification"] == "preintegrated"
        if plan["slabs"] > 400 or straight and not numpy.isfinite(self.made.volume.samples).all():
            return
        count = self.rays.width * self.rays.height
        chosen = numpy.arange(0, count, max(1, count // (STRAIGHT_PIXELS if straight else SLAB_PIXELS)))
        rows, columns = numpy.divmod(chosen, self.rays.width)
        cut = volume_oracle.SlabRays(self.made.volume, self.rays, (columns, rows), plan["slabs"],
                                     self.made.scene.get("clip"))
        wanted, doubt = (volume_oracle.preintegrated if straight else volume_oracle.post_classified)(cut, self.optics)
        bound = doubt + self.left_out(plan) + self.optics.off
        error = numpy.abs(drawn.picture[rows, columns] - wanted)
        error[cut.chord.tied] = 0
        by = f" by {plan['slabs']} slabs"
        table = plan.get("table", {}) if straight else {}
        # Tables hold opacity exactly, and colour as well as is found on some rays, which is no bound.
        if "off_on_trial_rays" in table:
            self.check("table", error.max(1), bound + 1.5 * table["off_on_trial_rays"] / 255, by)
        self.check("straight" if straight else "slabs", error[:, 3] if table else error.max(1), bound, by)

    def codes(self, drawn, plan, rounding):
        """A coarser target against the same slabs in float32."""
        slicing = {key: value for key, value in self.render["slice"].items() if key not in ("tree", "dither")}
        render = {**self.render, "target": "float32", "slice": {**slicing, "samples": plan["slabs"]}}
        (self.folder / "float32_scene.json").write_text(json.dumps({**self.made.scene, "render": render}, indent=1))
        exact = self.program.render("float32", self.made.arguments, scene="float32_scene.json")
        if exact is None:
            return
        bound = rounding
        if rounding == 0:  # chosen by the program
            bound = plan.get("error_bound", self.max_error if self.render["slice"].get("tree") == "auto"
                             else 0.15 * self.max_error) / 255
        self.check("codes", numpy.abs(drawn.picture - exact.picture).max(2), bound + 2 * self.left_out(plan),
                   f" by {plan['slabs']} slabs")

    @staticmethod
    def names(drawn):
        return {omission["name"] for omission in drawn.stats["omitted"]}

    def omitted(self, drawn, plan, traced):
        """docs/omissions.md says what each changes; of tables it is not said by how much."""
        names = self.names(drawn)
        if not names or names & {"table", "length_layers"}:
            return
        full = self.program.render("full", [*self.made.arguments, "--no-omit", "--set",
                                            f"render.slice.samples={plan['slabs']}"])
        if full is not None:
            bound = self.left_out(plan) + (CURVES / 255 if "smooth_points" in names else 0)
            # Light is cut at other places if other segments begin.
            bound += self.max_error / 255 if self.lit else 0
            error = numpy.abs(drawn.picture - full.picture).max(2)
            if plan["classification"] == "exact" and error.max() > bound:
                # A walk that begins elsewhere finds the faces of cells elsewhere, by a few roundings of float32 a cell.
                off = 2.0 ** -23 * sum(self.made.volume.samples.shape) * numpy.abs(self.made.volume.steps).max()
                bound = bound + 4 * self.change_by_moving(off, TRACE, traced)
            self.check("omit", error, bound, ": " + ", ".join(sorted(names)))

    # Projected tetrahedra.
    def coded_tets(self, drawn, plan):
        """Codes of OpenGL are those of the cpu engine, except beside a border between two."""
        cpu = self.program.render("codes_of_cpu", ["--context", "cpu"] + self.made.arguments[2:])
        if cpu is None:
            return
        codes = 2 ** plan["emulate"]["bits"] - 1 if "emulate" in plan else 0.5 / CODES[plan["target"]]
        error = numpy.quantile(numpy.abs(drawn.picture - cpu.picture), 0.99)
        self.check("coded", error, 2 / codes, f" in all but a hundredth, by {plan['source']}")

    def tets(self, drawn, traced):
        plan = drawn.stats["plan"]
        on_codes = "emulate" in plan or plan["dither"] == "after_blend"
        if on_codes and not drawn.stats["context"].startswith("cpu"):
            self.coded_tets(drawn, plan)
        triangles = plan["geometry"] == "triangles"
        # In float32 the scalars of triangles that begin at the eye keep few digits of a narrow window.
        touched = self.made.labels["camera"].split()[0] in ("inside", "face", "edge", "corner")
        promised = (plan["target"] == "float32" and plan["interpolation"] == "perspective"
                    and not (triangles and touched and self.made.marked)
                    and plan["thickness"] == "exact"
                    and self.render["project"]["coloring"] in ("preintegrated", "analytic")
                    and self.render["project"].get("order") in (None, "exact")
                    and drawn.stats["counts"].get("pairs_in_wrong_order", 0) == 0)
        if not promised:
            return
        error = numpy.abs(drawn.picture - traced).max(2)
        figure = drawn.stats["error"]
        if figure["kind"] != "unknown":
            self.check("figure", error, figure["value"] / 255 + 1e-7,
                       f" by {plan['source']}, {plan['geometry']}, {figure['kind']} on {figure.get('rays', 0)} rays")
        claimed = plan["off_on_trial_rays"] / 255
        if plan["source"] == "table":
            claimed *= 1.5  # of a table that the scene asks for it is what was found on trial rays, and no bound
        # Colour's weights are good to 5e-4 in opaque parts (docs/projection.md).
        claimed += self.optics.brightest * 5e-4 + (self.max_error / 255 if self.lit else 0)
        self.check("tets", error, claimed + self.placed(traced, triangles, error - claimed),
                   f" by {plan['source']}, {plan['geometry']}")

    def placed(self, traced, on_grid, wanted):
        """Faces are placed to 9e-6 of a tet's longest edge (docs/stability.md), at both ends of each tet. Where that is
        much, what it does is seen from eyes that are moved by some of it, in this pixel and its neighbours. Corners of
        triangles lie on a rasteriser's grid of 1/256 pixel. Beside a face that is seen edge-on, a small move is
        much."""
        edge = self.longest_edge()
        off = 9e-6 * edge
        if on_grid:
            off += self.rays.pixel / 256 * (1 if self.rays.parallel else self.farthest())
        most = min(1.0, 2 * off * self.optics.densest) * self.optics.brightest
        if most < 1e-3 * self.optics.brightest and (wanted <= most).all():
            return most
        change = self.change_by_moving(off, TRACE + (OF_MESH if self.made.volume else []), traced)
        height, width = change.shape
        wide = numpy.pad(change, 1)
        near = numpy.max([wide[i:i + height, j:j + width] for i in range(3) for j in range(3)], axis=0)
        return numpy.where(near > most, 4 * near, numpy.minimum(most, 4 * near + 1e-3 * self.optics.brightest))

    def longest_edge(self):
        if self.made.volume:  # no longer than its box
            low, high = self.made.volume.corners()
            return numpy.linalg.norm(self.made.volume.steps @ (high - low))
        corners = self.made.mesh.points[self.made.mesh.tets]
        return max(numpy.linalg.norm(corners[:, a] - corners[:, b], axis=1).max() for a in range(4) for b in range(a))

    def farthest(self):
        """Depth before the eye."""
        points = self.made.mesh.points if self.made.mesh else self.made.volume.world_corners()
        return max(float(((points - self.rays.eye) @ self.rays.forward).max()), 0.0)

    def change_by_moving(self, off, arguments, picture):
        """The largest change of each pixel by eyes that are moved this far."""
        moved = [self.moved_picture(number, way, arguments) for number, way in enumerate(self.ways(off))]
        return numpy.max([numpy.abs(other - picture).max(2) for other in moved], axis=0)

    def moved_picture(self, number, way, arguments):
        camera = dict(self.made.scene["camera"])
        for key in ("eye", "center"):
            camera[key] = (numpy.array(camera[key]) + way).tolist()
        name = f"moved{number}_scene.json"
        (self.folder / name).write_text(json.dumps({**self.made.scene, "camera": camera}, indent=1))
        moved = self.program.render(f"moved{number}", arguments, ".npy", scene=name)
        return numpy.full((1, 1, 1), numpy.inf) if moved is None else moved.picture
