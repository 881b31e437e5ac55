# SPDX-License-Identifier: Apache-2.0
"""Random transfer functions, and what they mean at a value (written from docs/scene.md alone)."""
import math

import numpy


def color_source(dice):
    """A function that gives the next point's colour."""
    kind = dice.weighted(white=1, one=2, many=5, bright=1, very_bright=0.3)
    one = dice.vector(0, 1)
    if kind == "white":
        return lambda: [1, 1, 1]
    if kind == "one":
        return lambda: one
    if kind == "many":
        return lambda: dice.vector(0, 1)
    return lambda: dice.vector(0, 8 if kind == "bright" else 1000)


def as_written(color, dice):
    """Triples, now and then the nearest "#rrggbb"."""
    if max(color) > 1 or dice.chance(0.9):
        return color
    codes = [round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055)) for c in color]
    return "#" + "".join(f"{code:02x}" for code in codes)


def linear_light(color):
    """Returns the linear components of a colour as scenes have it (docs/scene.md, "Colours")."""
    if not isinstance(color, str):
        return color
    stored = [int(color[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in stored]


def points_of(kind, low, high, dice):
    """(value, strength 0..1), in order."""
    span = high - low

    def at(share):
        return low + share * span

    if kind == "constant":
        return [(at(0.5), 1)]
    if kind == "ramp":
        return [(at(dice.between(-0.2, 0.7)), 0), (at(dice.between(0.75, 1.2)), 1)]
    if kind == "peaks":
        found = []
        for _ in range(dice.whole(1, 3)):
            middle, half = dice.between(0.02, 0.98), dice.log_between(2e-5, 0.1)
            found += [(at(middle - half), 0), (at(middle), dice.between(0.3, 1)), (at(middle + half), 0)]
        return found
    if kind == "steps":
        found, strength = [], 0
        for share in sorted(dice.between(0, 1) for _ in range(dice.whole(1, 4))):
            value = at(share)
            if dice.chance(0.3):
                value = float(round(value))  # on a value of samples of whole numbers
            found.append((value, strength))
            strength = 0 if strength and dice.chance(0.5) else dice.between(0.1, 1)
            found.append((value, strength))
        return found
    if kind == "band":  # shows between two values, with steep sides
        middle, half = dice.between(0.05, 0.95), dice.log_between(1e-3, 0.1)
        side = half * dice.log_between(1e-3, 1)
        return [(at(middle - half - side), 0), (at(middle - half), 1),
                (at(middle + half), 1), (at(middle + half + side), 0)]
    count = dice.whole(3, 9) if kind == "few" else dice.whole(20, 300)
    return [(at(dice.between(-0.05, 1.05)), dice.pick(0, 0, dice.share())) for _ in range(count)]


def in_order(points):
    """At most two points at one value."""
    kept = []
    for point in sorted(points, key=lambda p: p[0]):
        if len(kept) < 2 or kept[-2][0] < point[0]:
            kept.append(point)
    return kept


def make(dice, value_range, length):
    """length: of the box's diagonal; the JSON object of the scene."""
    low, high = value_range or (0.0, 1.0)
    if not low < high:
        low, high = low - max(abs(low), 1e-3) * 0.5, high + max(abs(high), 1e-3) * 0.5
    kind = dice.weighted(constant=0.4, ramp=3, peaks=3, band=1, steps=2, few=3, many=1)
    points = in_order(points_of(kind, low, high, dice))
    color = color_source(dice)
    depth = {"faint": dice.log_between(1e-4, 0.1), "usual": dice.log_between(0.1, 30),
             "dense": dice.log_between(30, 3000)}[dice.weighted(faint=1, usual=7, dense=2)]
    result = {"points": []}
    opacities = dice.chance(0.15)
    opaque = dice.chance(0.3)  # if there are opacities
    if opacities:
        result["unit_length"] = float(length * dice.pick(1, 0.1, 0.01))
    if dice.chance(0.15):
        result["interpolation"] = "nearest"
    elif opacities and (kind == "many" or dice.chance(0.3)):  # many slopes would be too many pieces
        result["interpolation"] = "extinction"
    for value, strength in points:
        point = {"value": float(value), "color": as_written(color(), dice)}
        if opacities:
            point["opacity"] = 1 if opaque and strength > 0.9 else strength
        else:
            point["extinction"] = float(depth * strength / length)
        result["points"].append(point)
    return result, kind


SLOPE_PIECES = 400  # of a slope from opacity 0 to 1, here
STEEPEST = 17  # optical depth over unit_length


def slope(a, b):
    """Opacities between two, evenly in the root of the optical depth, which makes the errors of chords even: with steps
    of sqrt(STEEPEST) / 400 at most STEEPEST / (2 * 400^2) = 5.3e-5 of the depth."""
    low, high = (math.sqrt(min(-math.log1p(-x), STEEPEST)) if x < 1 else math.sqrt(STEEPEST) for x in (a, b))
    pieces = math.ceil(SLOPE_PIECES * abs(high - low) / math.sqrt(STEEPEST))
    depths = numpy.linspace(low, high, pieces + 1)[1:-1] ** 2
    return -numpy.expm1(-depths)


def knots_of(spec):
    """Values with colour and extinction, in order, where extinction is linear between them. docs/scene.md,
    "Transfer function", says what opacity means between points."""
    unit, points = spec.get("unit_length", 1), spec["points"]
    linear = spec.get("interpolation", "linear") == "linear"

    def extinction(point, beside=None):
        if "opacity" not in point:
            return point["extinction"]
        opacity = point["opacity"]
        depth = 1e7 if opacity == 1 else -math.log1p(-opacity)
        on_slope = linear and beside is not None and beside.get("opacity") != opacity
        return (min(depth, STEEPEST) if on_slope else depth) / unit

    found = []
    for i, point in enumerate(points):
        color, value = linear_light(point["color"]), point["value"]
        before = points[i - 1] if i else None
        after = points[i + 1] if i + 1 < len(points) else None
        if linear and before and "opacity" in before and "opacity" in point and before["value"] < value \
                and before["opacity"] != point["opacity"]:
            rise, start = point["opacity"] - before["opacity"], numpy.array(linear_light(before["color"]))
            for opacity in slope(before["opacity"], point["opacity"]):
                share = (opacity - before["opacity"]) / rise
                found.append((before["value"] + share * (value - before["value"]),
                              [*(start + share * (numpy.array(color) - start)), -math.log1p(-opacity) / unit]))
        sides = [extinction(point, side) for side in (before, after) if side is None or side["value"] != value]
        found += [(value, [*color, side]) for side in (sides if len(sides) == 2 and sides[0] != sides[1] else
                                                       sides[:1] or [extinction(point)])]
    return found


class Optics:
    """Knots with colour and extinction on both sides: linear between them, constant outside. off: how far lamina may be
    from it, of full scale (docs/precision.md, "Opacity that is linear")."""

    def __init__(self, spec):
        values, right = (list(part) for part in zip(*knots_of(spec)))
        if spec.get("interpolation") == "nearest":
            middles = [(a + b) / 2 for a, b in zip(values, values[1:])]
            self.knots = numpy.array(middles)
            table = numpy.array(right)
            self.at_low, self.at_high = table, table  # of the part before the first knot, between two, after the last
        else:
            table = numpy.array(right)
            # Parts between knots; of two points at one value the part between has no width.
            self.knots = numpy.array(values)
            self.at_low = numpy.vstack([table[:1], table])
            self.at_high = numpy.vstack([table, table[-1:]])
        self.brightest = max(1.0, float(numpy.array(right)[:, :3].max()))
        self.densest = float(numpy.array(right)[:, 3].max())
        follows = len(values) > 2 * len(spec["points"])
        self.off = 0.11 / 255 * self.brightest if follows else 0.0

    def part_at(self, scalars):
        """The number of the part; on a knot the one above it."""
        return numpy.searchsorted(self.knots, scalars, side="right")

    def in_part(self, part, scalars):
        """Colour and extinction [..., 4] of the line through a part, at these scalars."""
        padded = numpy.concatenate([[-numpy.inf], self.knots, [numpy.inf]])
        low, high = padded[part], padded[part + 1]
        inner = numpy.isfinite(low) & numpy.isfinite(high) & (low < high)
        span = numpy.where(inner, high - numpy.where(inner, low, 0), 1)
        share = numpy.where(inner, (scalars - numpy.where(inner, low, 0)) / span, 0)[..., None]
        return self.at_low[part] * (1 - share) + self.at_high[part] * share

    def at(self, scalars):
        return self.in_part(self.part_at(scalars), scalars)

    def shows(self, low, high):
        """Tells whether there is extinction anywhere between two scalars."""
        first, last = self.part_at(low), self.part_at(high)
        shown = (self.at_low[:, 3] > 0) | (self.at_high[:, 3] > 0)
        up_to = numpy.concatenate([[0], numpy.cumsum(shown)])
        between = up_to[last] > up_to[numpy.minimum(first + 1, last)]
        ends = (self.at(low)[..., 3] > 0) | (self.at(high)[..., 3] > 0)
        return ends | between | (first < last) & ((self.at_high[first, 3] > 0) | (self.at_low[last, 3] > 0))
