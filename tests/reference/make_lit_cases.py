#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes lit_cases.json: lit rays through small volumes and meshes, integrated with 30 digits by a program that shares
nothing with the C++. Every double of the input counts as the exact number that it is.

The formulas are those of docs/numerics.md, section 10. A ray is cut at faces, at the points of the transfer function,
at the kinks of the light and where the gradient is shortest; tanh-sinh quadrature of each part.

Usage: make_lit_cases.py lit_cases.json (takes some minutes; needs python3-mpmath)
"""

import json
import math
import random
import sys

from mpmath import mp, mpf

mp.dps = 40
DICE = random.Random(28)


def vector(values):
    return [mpf(v) for v in values]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = mp.sqrt(dot(a, a))
    return [x / length for x in a]


# Polynomials are lists of coefficients, lowest first.
def times(a, b):
    result = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def plus(a, b):
    size = max(len(a), len(b))
    return [(a[i] if i < len(a) else 0) + (b[i] if i < len(b) else 0) for i in range(size)]


def scaled(a, factor):
    return [x * factor for x in a]


def value(a, t):
    return mp.polyval(a[::-1], t)


def derivative(a):
    return [i * x for i, x in enumerate(a)][1:] or [mpf(0)]


def roots(a, lo, hi):
    """Real roots in (lo, hi), by the roots of the derivative: between two of them there is at most one."""
    largest = max(abs(x) for x in a)
    if largest == 0:
        return []
    a = [x for x in a]
    while len(a) > 1 and abs(a[-1]) <= largest * mpf(10) ** -36:
        a.pop()
    if len(a) == 1:
        return []
    ends = [lo] + roots(derivative(a), lo, hi) + [hi]
    found = []
    for left, right in zip(ends, ends[1:]):
        f, g = value(a, left), value(a, right)
        if f == 0 and left > lo:
            found.append(left)
        if f * g < 0:
            for _ in range(150):
                middle = (left + right) / 2
                if value(a, middle) * f > 0:
                    left = middle
                else:
                    right = middle
            found.append((left + right) / 2)
    return sorted(set(found))


class Model:
    """Transfer function, lighting and the ray that they are asked along."""

    def __init__(self, points, lighting, direction):
        self.points = [(mpf(p["value"]), vector(p["color"]), mpf(p["extinction"])) for p in points]
        self.lighting = lighting
        eye = scaled(unit(direction), -1)
        self.lights = []
        for light in lighting["lights"]:
            to_light = eye if light["direction"] == "headlight" else unit(vector(light["direction"]))
            halfway = plus(to_light, eye)
            opposite = dot(halfway, halfway) < mpf(10) ** -24
            self.lights.append((to_light, [mpf(0)] * 3 if opposite else unit(halfway), vector(light["color"])))

    def piece(self, s):
        """Colour and extinction as (lowest value, at it, slope) of the piece that holds s"""
        before = [p for p in self.points if p[0] <= s]
        after = [p for p in self.points if p[0] > s]
        if not before or not after:
            outer = before[-1] if before else after[0]
            return outer[0], outer[1], [mpf(0)] * 3, outer[2], mpf(0)
        a, b = before[-1], after[0]
        width = b[0] - a[0]
        return a[0], a[1], scaled(minus(b[1], a[1]), 1 / width), a[2], (b[2] - a[2]) / width

    def lit(self, color, gradient):
        square = dot(gradient, gradient)
        if square == 0:
            return color
        length = mp.sqrt(square)
        eps = mpf(self.lighting["smallest_gradient"])
        w = square / (square + eps * eps)
        ambient, diffuse = mpf(self.lighting["ambient"]), mpf(self.lighting["diffuse"])
        specular, power = mpf(self.lighting["specular"]), mpf(self.lighting["power"])
        result = []
        for c in range(3):
            d = sum(l[2][c] * abs(dot(gradient, l[0])) for l in self.lights) / length
            h = sum(l[2][c] * (abs(dot(gradient, l[1])) / length) ** power for l in self.lights)
            result.append(color[c] * (1 - w + w * (ambient + diffuse * d)) + specular * w * h)
        return result

    def add(self, ray, s, g, start, end, direction_length):
        """Adds start..end, where scalar s and gradient g are polynomials; ray = [depth, r, g, b]"""
        cuts = [start, end]
        for point in self.points:
            cuts += roots(plus(s, [-point[0]]), start, end)
        for light in self.lights:
            for axis in light[:2]:
                along = [mpf(0)]
                for c in range(3):
                    along = plus(along, scaled(g[c], axis[c]))
                cuts += roots(along, start, end)
        square = [mpf(0)]
        for c in range(3):
            square = plus(square, times(g[c], g[c]))
        cuts += roots(derivative(square), start, end)
        cuts = sorted(set(cuts))
        for a, b in zip(cuts, cuts[1:]):
            if b - a < mpf(10) ** -32:
                continue
            lo, color, color_slope, extinction, extinction_slope = self.piece(value(s, (a + b) / 2))
            x = plus(s, [-lo])
            tau = scaled(plus([extinction], scaled(x, extinction_slope)), direction_length)
            depth = [mpf(0)] + [c / (i + 1) for i, c in enumerate(tau)]
            before = value(depth, a)

            def emission(t, channel):
                position = value(x, t)
                c = [p + q * position for p, q in zip(color, color_slope)]
                shown = self.lit(c, [value(k, t) for k in g])[channel]
                return shown * value(tau, t) * mp.exp(before - value(depth, t))

            total = value(depth, b) - before
            if total > 0:
                for channel in range(3):
                    found, error = mp.quad(lambda t, c=channel: emission(t, c), [a, b], error=True, maxdegree=9)
                    Model.worst = max(Model.worst, error)
                    ray[channel + 1] += mp.exp(-ray[0]) * found
            ray[0] += total


Model.worst = mpf(0)


def polynomials_of(corners, start, step):
    """A trilinear function along start + t step, in coordinates of the cell"""
    result = [mpf(0)]
    for i, corner in enumerate(corners):
        term = [corner]
        for axis in range(3):
            near = [start[axis], step[axis]]
            term = times(term, near if i >> axis & 1 else plus([mpf(1)], scaled(near, -1)))
        result = plus(result, term)
    return result


def trace_volume(case, model, origin, direction):
    size, step = case["size"], [vector(v) for v in case["step"]]
    samples = vector(case["samples"])
    cell = case["centering"] == "cell"
    axes = [scaled(v, 1 / dot(v, v)) for v in step]  # of an index per world length
    length = mp.sqrt(dot(direction, direction))
    start = [dot(origin, a) for a in axes]
    slope = [dot(direction, a) for a in axes]

    def sample(index):
        i = [min(max(k, 0), n - 1) for k, n in zip(index, size)]
        return samples[(i[2] * size[1] + i[1]) * size[0] + i[0]]

    def gradient(index):
        i = [min(max(k, 0), n - 1) for k, n in zip(index, size)]
        total = [mpf(0)] * 3
        for axis in range(3):
            lower, upper = list(i), list(i)
            lower[axis], upper[axis] = max(i[axis] - 1, 0), min(i[axis] + 1, size[axis] - 1)
            if upper[axis] > lower[axis]:
                difference = (sample(upper) - sample(lower)) / (upper[axis] - lower[axis])
                total = plus(total, scaled(axes[axis], difference))
        return total

    margin = mpf(1) / 2 if cell else mpf(0)
    entry, leave, cuts = mpf(0), mp.inf, []
    for axis in range(3):
        for plane in [-margin] + list(range(size[axis])) + [size[axis] - 1 + margin]:
            if slope[axis] != 0:
                cuts.append((plane - start[axis]) / slope[axis])
        ends = sorted((p - start[axis]) / slope[axis] for p in (-margin, size[axis] - 1 + margin))
        entry, leave = max(entry, ends[0]), min(leave, ends[1])
    if not entry < leave:
        sys.exit("a ray misses its volume")
    cuts = sorted(set([entry, leave] + [t for t in cuts if entry < t < leave]))
    ray = [mpf(0)] * 4
    for a, b in zip(cuts, cuts[1:]):
        if b - a < mpf(10) ** -32:
            continue
        middle = [int(mp.floor(p + (a + b) / 2 * d)) for p, d in zip(start, slope)]
        local = minus(start, middle)
        corners = [[m + (i >> axis & 1) for axis, m in enumerate(middle)] for i in range(8)]
        s = polynomials_of([sample(c) for c in corners], local, slope)
        gradients = [gradient(c) for c in corners]
        g = [polynomials_of([v[c] for v in gradients], local, slope) for c in range(3)]
        model.add(ray, s, g, a, b, length)
    return ray


def trace_mesh(case, model, origin, direction):
    points, tets, scalar = [vector(p) for p in case["points_at"]], case["tets"], vector(case["scalar"])
    sums, weights = [[mpf(0)] * 3 for _ in points], [mpf(0)] * len(points)
    linear = []
    for tet in tets:
        a, b, c = (minus(points[i], points[tet[0]]) for i in tet[1:])
        volume = dot(a, cross(b, c))
        bary = [scaled(cross(b, c), 1 / volume), scaled(cross(c, a), 1 / volume), scaled(cross(a, b), 1 / volume)]
        linear.append((points[tet[0]], bary))
        gradient = [sum((scalar[tet[k + 1]] - scalar[tet[0]]) * bary[k][i] for k in range(3)) for i in range(3)]
        for i in tet:
            sums[i] = plus(sums[i], scaled(gradient, abs(volume)))
            weights[i] += abs(volume)
    gradients = [scaled(s, 1 / w) for s, w in zip(sums, weights)]
    length = mp.sqrt(dot(direction, direction))
    crossed = []
    for tet, (corner, bary) in zip(tets, linear):
        weight = [[dot(minus(origin, corner), n), dot(direction, n)] for n in bary]
        weight.insert(0, plus([mpf(1)], scaled([sum(w[i] for w in weight) for i in range(2)], -1)))
        lo, hi = mpf(0), mp.inf
        for w in weight:
            if w[1] > 0:
                lo = max(lo, -w[0] / w[1])
            elif w[1] < 0:
                hi = min(hi, -w[0] / w[1])
            elif w[0] < 0:
                hi = lo
        if hi > lo:
            crossed.append((lo, hi, tet, weight))
    ray = [mpf(0)] * 4
    for lo, hi, tet, weight in sorted(crossed, key=lambda c: c[0]):
        def along(values):
            total = [mpf(0), mpf(0)]
            for i, w in zip(tet, weight):
                total = plus(total, scaled(w, values[i]))
            return total
        model.add(ray, along(scalar), [along([g[c] for g in gradients]) for c in range(3)], lo, hi, length)
    return ray


def eighths(lo, hi):
    return DICE.randint(8 * lo, 8 * hi) / 8


def random_points(hidden):
    values = sorted(DICE.sample(range(1, 16), DICE.randint(1, 3)))
    points = [{"value": 0, "color": [1, 0.5, 0.25], "extinction": 0 if hidden else 0.5}]
    for v in values:
        points.append({"value": v / 16, "color": [DICE.random() for _ in range(3)], "extinction": DICE.choice([0, 1, 4, 30])})
    return points + [{"value": 1, "color": [0.25, 1, 0.5], "extinction": DICE.choice([0, 2, 8])}]


def random_lighting():
    lights = []
    for _ in range(DICE.randint(1, 3)):
        direction = "headlight" if DICE.random() < .4 else [DICE.uniform(-1, 1) for _ in range(3)]
        lights.append({"direction": direction, "color": [eighths(0, 1) for _ in range(3)]})
    return {"ambient": eighths(0, 1), "diffuse": eighths(0, 2), "specular": DICE.choice([0, .5, 1]),
            "power": DICE.choice([1, 2.5, 10, 64, 400]),
            "smallest_gradient": DICE.choice([1e-4, .01, .1, 1]), "lights": lights}


def random_volume(number):
    size = [DICE.randint(2, 4) for _ in range(3)]
    # A turned, mirrored grid with three spacings, orthogonal without rounding.
    axes = [[2, 1, 2], [-2, 2, 1], [1, 2, -2]]
    step = [[c * f for c in axis] for axis, f in zip(axes, DICE.sample([.125, .25, .5], 3))]
    samples = [DICE.randint(0, 64) / 64 for _ in range(math.prod(size))]
    centering = DICE.choice(["node", "cell"])
    index = [DICE.uniform(.2, .8) * (n - 1) for n in size]
    target = [sum(i * axis[c] for i, axis in zip(index, step)) for c in range(3)]
    return {"size": size, "step": step, "centering": centering, "samples": samples, "points": random_points(number % 2),
            "lighting": random_lighting(), "eye": [t + 12 * DICE.uniform(-1, 1) for t in target], "center": target}


def random_mesh(number):
    # A tet, and one more on each of two of its faces.
    base = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    points = [[c + DICE.uniform(-.2, .2) for c in p] for p in base]
    points += [[DICE.uniform(.8, 1.2)] * 3, [DICE.uniform(-.8, -.4), DICE.uniform(.2, .5), DICE.uniform(.2, .5)]]
    tets = [[0, 1, 2, 3], [4, 2, 1, 3], [5, 0, 2, 3]]
    middle = [sum(p[c] for p in points[:4]) / 4 for c in range(3)]
    return {"points_at": points, "tets": tets, "scalar": [DICE.randint(0, 64) / 64 for _ in points],
            "points": random_points(number % 2), "lighting": random_lighting(),
            "eye": [m + 4 * DICE.uniform(-1, 1) for m in middle], "center": middle}


def finished(case, trace):
    # The ray of the one pixel of an orthographic picture.
    origin, center = vector(case["eye"]), vector(case["center"])
    direction = unit(minus(center, origin))
    ray = trace(case, Model(case["points"], case["lighting"], direction), origin, direction)
    case["rgba"] = [float(c) for c in ray[1:]] + [float(-mp.expm1(-ray[0]))]
    print(case["rgba"], mp.nstr(Model.worst, 3), file=sys.stderr)
    return case


def main():
    cases = {"volumes": [finished(random_volume(i), trace_volume) for i in range(30)],
             "meshes": [finished(random_mesh(i), trace_mesh) for i in range(20)]}
    if Model.worst > mpf(10) ** -16:
        sys.exit(f"uncertain by {mp.nstr(Model.worst, 3)}")
    with open(sys.argv[1], "w") as file:
        file.write("{\n")
        for number, (name, rows) in enumerate(cases.items()):
            lines = ",\n".join("  " + json.dumps(row) for row in rows)
            file.write(f"\"{name}\": [\n{lines}\n]{',' if number == 0 else ''}\n")
        file.write("}\n")


if __name__ == "__main__":
    main()
