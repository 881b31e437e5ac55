#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes integral_cases.json: segment integrals computed with 50 digits, by a form that shares nothing with the C++.

The colour of a linear piece is integrated over the optical depth y instead of the position x: C = int_0^D c(x(y))
exp(-y) dy, where x(y) = 2y / (p + sqrt(p^2 + 4ky)) inverts y = px + kx^2. Tanh-sinh quadrature on a graded mesh; no
closed form of the Gaussian integral is used. Every double of the input counts as the exact number that it is.

Usage: make_integral_cases.py integral_cases.json (takes some minutes; needs python3-mpmath)
"""

import json
import math
import random
import sys

from mpmath import mp, mpf

mp.dps = 50
MESH = [mpf(0)] + [mpf(10) ** e for e in (-24, -16, -10, -6, -3, -1)] + [mpf(n) for n in (1, 4, 12, 30, 60, 130)]


def first_moment(p, q):
    """int_0^D x(y) exp(-y) dy"""
    depth, k = (p + q) / 2, (q - p) / 2
    if depth == 0:
        return mpf(0)

    # The unknown is t = y / scale, and x is multiplied by magnify: mp.quad looks at absolute errors.
    scale, magnify = min(depth, 1), max(depth, 1)
    end = depth / scale

    def integrand(t):
        y = scale * t
        # The largest y of the last cell may exceed D by a rounding.
        return magnify * 2 * y / (p + mp.sqrt(max(mpf(0), p * p + 4 * k * y))) * mp.exp(-y)

    # Graded towards both ends, since x(y) has roots of y and of D - y.
    nodes = [m for m in MESH if m < end]
    if end < 130:
        tail = [end * (1 - mpf(t)) for t in ("0.1", "1e-6", "1e-16", "0")]
        nodes = [n for n in nodes if n < tail[0]] + tail
    total = uncertain = mpf(0)
    for a, b in zip(nodes, nodes[1:]):
        value, error = mp.quad(integrand, [a, b], error=True)
        total += value
        uncertain += error
    first_moment.worst = max(first_moment.worst, uncertain / total)
    return total * scale / magnify


first_moment.worst = mpf(0)


def optics(knots, piece, s):
    if piece == 0:
        return knots[0][1:]
    if piece == len(knots):
        return knots[-1][1:]
    (va, ca, ta), (vb, cb, tb) = knots[piece - 1], knots[piece]
    x = (s - va) / (vb - va)
    return [a + (b - a) * x for a, b in zip(ca, cb)], ta + (tb - ta) * x


def integrate(knots, sf, sb, length):
    """alpha and colour; knots as (value, [r, g, b], extinction)"""
    knots = [(mpf(v), [mpf(c) for c in color], mpf(tau)) for v, color, tau in knots]
    sf, sb, length = mpf(sf), mpf(sb), mpf(length)
    lo, hi = min(sf, sb), max(sf, sb)
    pieces = []
    if lo == hi:
        last = sum(1 for knot in knots if knot[0] <= lo)
        end = optics(knots, last, lo)
        pieces.append((length, end, end))
    else:
        bounds = [-mp.inf] + [knot[0] for knot in knots] + [mp.inf]
        for i in range(len(knots) + 1):
            a, b = max(lo, bounds[i]), min(hi, bounds[i + 1])
            if a < b:
                pieces.append((length * (b - a) / (hi - lo), optics(knots, i, a), optics(knots, i, b)))
        if sf > sb:
            pieces = [(h, b, a) for h, a, b in reversed(pieces)]
    before = mpf(0)
    color = [mpf(0)] * 3
    for h, (c0, tau0), (c1, tau1) in pieces:
        p, q = h * tau0, h * tau1
        depth = (p + q) / 2
        moment = first_moment(p, q)
        for i in range(3):
            color[i] += mp.exp(-before) * (c0[i] * -mp.expm1(-depth) + (c1[i] - c0[i]) * moment)
        before += depth
    return -mp.expm1(-before), color


def scaled(knots, factor):
    return [(v, c, tau * factor) for v, c, tau in knots]


def cases():
    rng = random.Random(1)
    color = lambda: [round(rng.random(), 3) * rng.choice((0, 1, 1, 1)) for _ in range(3)]
    tag = "homogeneous"
    for e in (-300, -100, -20, -8, -3, -1, 0, 1, 2, 6, 300):
        yield tag, [(0, [0.25, 0.5, 1], 1.0)], 0, 1, 10.0**e
    tag = "ramp"
    for t0, t1 in ((0, 1), (1, 0), (1, 10), (1, 1 + 1e-9), (1 + 1e-13, 1), (1, 1e-6), (0.3, 0.31)):
        for e in (-8, -5, -2.3, -1.3, -0.7, -0.2, 0.1, 0.4, 0.58, 0.63, 0.9, 1.3, 2, 4, 6):
            yield tag, [(0, [1, 0, 0.3], t0 * 10.0**e), (255, [0, 1, 0.9], t1 * 10.0**e)], 0, 255, 1.0
    tag = "close scalars"
    for width in (1e-9, 3e-7, 1e-4, 0.01):
        for e in (-8, -1, 1, 3, 6):
            knots = [(100, color(), 0.2), (150, color(), 0.7), (151, color(), 0.0), (200, color(), 1.0)]
            sf = rng.choice((120.3, 150 - width / 3, 151 + width / 3, 180.5))
            yield tag, scaled(knots, 10.0**e), sf, sf + rng.choice((-1, 1)) * width, 1.0
    tag = "spike"
    for height in (1e-4, 1.0, 1e4, 1e7, 1e10):
        for sf, sb in ((0, 1), (1, 0), (0.49997, 0.50001), (0.50005, 0.3), (0.2, 0.49996)):
            knots = [(0, [0, 0, 0.5], 0), (0.49995, [0, 1, 0.2], 0), (0.5, [1, 0.5, 0], height),
                     (0.50005, [0.1, 0, 1], 0), (1, [1, 0, 0], 0.01)]
            yield tag, knots, sf, sb, rng.choice((0.5, 1, 3.7))
    tag = "step"
    for e in (-6, -1, 0.5, 1.5, 4):
        knots = scaled([(10, [1, 0, 0], 0), (20, [1, 0.5, 0], 1), (20, [0, 0, 1], 0.2), (30, [0, 1, 0.1], 0.2),
                        (30, [0.3, 0.3, 0.3], 2), (40, [1, 1, 0], 0)], 10.0**e)
        for sf, sb in ((20, 25), (25, 20), (20, 15), (15, 20), (5, 45), (45, 5), (20, 20), (30, 30), (19, 30), (33, 8)):
            yield tag, knots, sf, sb, 1.25
    tag = "far behind"
    for depth in (50, 300, 500, 700):
        for sf, sb in ((0, 3), (0, 2.0001)):
            yield tag, [(1, [0.5, 0, 0], depth), (2, [0.5, 0, 0], depth), (2, [0, 0, 1], 1.0), (3, [0, 1, 0], 5.0)], sf, sb, 1.0
    tag = "many"
    for i in range(60):
        lo, hi = rng.choice(((0, 255), (-1000, 3000), (0, 1), (-1e-6, 1e-6)))
        values = sorted(rng.uniform(lo, hi) for _ in range(rng.randint(2, 6)))
        knots = [(v, color(), rng.choice((0, 1, 1)) * 10 ** rng.uniform(-2, 1)) for v in values]
        if i % 3 == 0:
            knots.insert(1, (values[0], color(), rng.random()))
        sf, sb = (rng.uniform(lo, hi) for _ in range(2))
        yield tag, scaled(knots, 10.0 ** rng.uniform(-8, 5)), sf, sb, 10 ** rng.uniform(-2, 2)
    tag = "extreme"
    for tau, length in ((1e-300, 1.0), (1.0, 1e-300), (1e150, 1e-150), (1e-150, 1e150), (1e300, 1.0), (1e150, 1e150)):
        yield tag, [(0, [1, 0.5, 0], tau), (1, [0.25, 0, 1], 0.5 * tau)], 0, 1, length


def as_double(x):
    x = float(x)
    return 0.0 if abs(x) < sys.float_info.min else x


def main():
    lines = []
    for tag, knots, sf, sb, length in cases():
        knots = [(float(v), [float(c) for c in color], float(tau)) for v, color, tau in knots]
        alpha, color = integrate(knots, float(sf), float(sb), float(length))
        lines.append(json.dumps({
            "kind": tag, "points": [[v, *c, tau] for v, c, tau in knots],
            "sf": float(sf), "sb": float(sb), "length": float(length),
            "alpha": as_double(alpha), "color": [as_double(c) for c in color]}))
        assert all(math.isfinite(c) for c in color)
    assert first_moment.worst < mpf("1e-25"), first_moment.worst
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write("[\n" + ",\n".join(lines) + "\n]\n")
    print(f"{len(lines)} cases, quadrature error estimate {mp.nstr(first_moment.worst, 3)}", file=sys.stderr)


if __name__ == "__main__":
    main()
