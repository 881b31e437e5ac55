# SPDX-License-Identifier: Apache-2.0
"""Emission and absorption along rays, by code that shares nothing with lamina's: pieces of cubics in Bernstein form
are halved until each lies between two knots of the transfer function; there optical depth is exact, and colour is
integrated by Gauss's rule over pieces that are thin enough."""
from dataclasses import dataclass

import numpy

HALVINGS = 44  # of a cell: what is left of a crossing is 2^-44 of it
SPREADS = 0.5  # optical depth of a piece under Gauss's rule
HIDDEN = 45.0  # optical depth behind which nothing shows: e^-45 is 3e-20


@dataclass
class Pieces:
    """Pieces of all rays together: from `start`, `length` world units long; scalars: Bernstein coefficients [piece, 4]."""
    ray: numpy.ndarray
    start: numpy.ndarray
    length: numpy.ndarray
    scalars: numpy.ndarray

    def at(self, chosen):
        return Pieces(self.ray[chosen], self.start[chosen], self.length[chosen], self.scalars[chosen])


def joined(*parts):
    return Pieces(*(numpy.concatenate([getattr(part, name) for part in parts])
                    for name in ("ray", "start", "length", "scalars")))


def halves(b):
    """de Casteljau at the middle."""
    ab, bc, cd = (b[:, 0] + b[:, 1]) / 2, (b[:, 1] + b[:, 2]) / 2, (b[:, 2] + b[:, 3]) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    middle = (abc + bcd) / 2
    return numpy.stack([b[:, 0], ab, abc, middle], 1), numpy.stack([middle, bcd, cd, b[:, 3]], 1)


def halved(pieces):
    first, second = halves(pieces.scalars)
    half = pieces.length / 2
    return joined(Pieces(pieces.ray, pieces.start, half, first),
                  Pieces(pieces.ray, pieces.start + half, half, second))


def part_of(pieces, optics):
    """Number of the part of the transfer function; -1 if a piece reaches over a knot."""
    low, high = pieces.scalars.min(1), pieces.scalars.max(1)
    below = numpy.searchsorted(optics.knots, low, side="right")
    above = numpy.searchsorted(optics.knots, high, side="left")
    # A piece that is constant on a knot belongs above it.
    return numpy.where(low == high, below, numpy.where(below >= above, numpy.maximum(below, above), -1))


def cut_at_knots(pieces, optics):
    """Pieces, their parts, and for each ray the optical depth that is left undecided."""
    done, parts = [], []
    for step in range(HALVINGS + 1):
        part = part_of(pieces, optics)
        ready = part >= 0
        done.append(pieces.at(ready))
        parts.append(part[ready])
        pieces = pieces.at(~ready)
        if step < HALVINGS and len(pieces.ray):
            pieces = halved(pieces)
    undecided = pieces
    middle = optics.part_at(undecided.scalars.mean(1))
    return joined(*done, undecided), numpy.concatenate([*parts, middle]), undecided


def integrate(pieces, optics, rays):
    """RGBA [rays, 4], and of each ray a bound on what the cuts at knots left undecided."""
    thin, doubt = thin_pieces(pieces, optics, rays)
    return emitted(thin, rays), doubt


def thin_pieces(pieces, optics, rays):
    """Arguments of emitted(): for each piece its ray, length, values and the optical depth before it, in the order of the
    rays; and the bound of integrate()."""
    pieces, part, undecided = cut_at_knots(pieces, optics)
    doubt = numpy.bincount(undecided.ray, undecided.length * optics.densest, rays) * optics.brightest
    # [piece, coefficient, RGB and extinction]: linear in the scalar, so Bernstein coefficients, too.
    values = optics.in_part(part[:, None], pieces.scalars)
    shows = values[..., 3].max(1) > 0
    ray, start, length, values = pieces.ray[shows], pieces.start[shows], pieces.length[shows], values[shows]
    while True:
        order = numpy.lexsort((start, ray))
        ray, start, length, values = ray[order], start[order], length[order], values[order]
        depth = length * values[..., 3].mean(1)
        before = numpy.cumsum(depth) - depth
        first = numpy.searchsorted(ray, ray, side="left")
        before = before - before[first] if len(ray) else before
        seen = before < HIDDEN
        ray, start, length, values, depth, before = (x[seen] for x in (ray, start, length, values, depth, before))
        thick = depth > SPREADS
        if not thick.any():
            break
        low, high = zip(*(halves(values[thick, :, channel]) for channel in range(4)))
        half = length[thick] / 2
        ray = numpy.concatenate([ray[~thick], ray[thick], ray[thick]])
        start = numpy.concatenate([start[~thick], start[thick], start[thick] + half])
        length = numpy.concatenate([length[~thick], half, half])
        values = numpy.concatenate([values[~thick], numpy.stack(low, 2), numpy.stack(high, 2)])
    return (ray, length, values, before), doubt


def emitted(thin, rays, nodes=8):
    """The sum over pieces of optical depth up to SPREADS: RGBA [rays, 4]."""
    ray, length, values, before = thin
    places, weights = numpy.polynomial.legendre.leggauss(nodes)
    colors = numpy.zeros((len(ray), 3))
    for place, weight in zip((places + 1) / 2, weights / 2):
        here, front = split_at(values, place)
        depth = before + length * place * front[..., 3].mean(1)
        share = weight * length * here[:, 3] * numpy.exp(-depth)
        colors += share[:, None] * here[:, :3]
    picture = numpy.empty((rays, 4))
    for channel in range(3):
        picture[:, channel] = numpy.bincount(ray, colors[:, channel], rays)
    total = numpy.bincount(ray, length * values[..., 3].mean(1), rays)
    picture[:, 3] = -numpy.expm1(-total)
    return picture


def split_at(b, t):
    """The value at t, and the coefficients of what lies before it."""
    ab, bc, cd = (b[:, i] * (1 - t) + b[:, i + 1] * t for i in range(3))
    abc, bcd = ab * (1 - t) + bc * t, bc * (1 - t) + cd * t
    middle = abc * (1 - t) + bcd * t
    return middle, numpy.stack([b[:, 0], ab, abc, middle], 1)
