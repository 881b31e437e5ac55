# SPDX-License-Identifier: Apache-2.0
"""A mesh along rays: every tet is met with every ray, by its four planes."""
import numpy

from . import clips
from .emission import Pieces


def pieces(mesh, origins, directions, clip=None):
    corners = mesh.points[mesh.tets]  # [tet, corner, xyz]
    values = mesh.values[mesh.tets]
    finite = numpy.isfinite(values).all(1)
    corners, values = corners[finite], numpy.where(numpy.isfinite(values), values, 0)[finite]
    edges = corners[:, 1:] - corners[:, :1]
    volume = numpy.linalg.det(edges)
    flat = volume == 0
    edges, corners, values = edges[~flat], corners[~flat], values[~flat]
    inverse = numpy.linalg.inv(edges.transpose(0, 2, 1))  # to barycentric coordinates of corners 1 to 3
    world = numpy.linalg.norm(directions, axis=1)
    kept_near, kept_far, _ = clips.spans(clip, origins, directions)
    found = []
    for i in range(len(origins)):
        at_eye = numpy.einsum("tij,tj->ti", inverse, origins[i] - corners[:, 0])
        slope = numpy.einsum("tij,j->ti", inverse, directions[i])
        at_eye = numpy.concatenate([1 - at_eye.sum(1, keepdims=True), at_eye], 1)
        slope = numpy.concatenate([-slope.sum(1, keepdims=True), slope], 1)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            crossing = -at_eye / slope
        near = numpy.where(slope > 0, crossing, -numpy.inf).max(1)
        far = numpy.where(slope < 0, crossing, numpy.inf).min(1)
        missed = ((slope == 0) & (at_eye < 0)).any(1)
        near, far = numpy.maximum(near, kept_near[i]), numpy.minimum(far, kept_far[i])
        hit = numpy.flatnonzero(~missed & (near < far))
        ends = [numpy.einsum("tc,tc->t", numpy.clip(at_eye[hit] + z[hit, None] * slope[hit], 0, 1), values[hit])
                for z in (near, far)]
        scalars = numpy.stack([ends[0] + (ends[1] - ends[0]) * share for share in (0, 1 / 3, 2 / 3, 1)], 1)
        same = (values[hit] == values[hit][:, :1]).all(1)
        scalars[same] = values[hit][same, :1]
        found.append(Pieces(numpy.full(len(hit), i), near[hit] * world[i], (far - near)[hit] * world[i], scalars))
    return Pieces(*(numpy.concatenate([getattr(part, name) for part in found])
                    for name in ("ray", "start", "length", "scalars")))
