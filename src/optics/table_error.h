// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "optics/segment_integral.h"
#include "optics/transfer_function.h"

namespace lamina {

// Rays through tets that a table is tried on.
struct TableRays {
    double lo = 0, hi = 1;                // scalars
    double shortest = 0.01, longest = 1;  // segments, world units, 0 < shortest <= longest
    double ray_length = 16;  // no ray is longer, world units, >= longest: the mesh's diagonal
};

using SegmentLookup = std::function<SegmentIntegral(double front, double back, double length)>;

// How wrong a way of integrating segments makes a ray: the largest error of associated colour and
// opacity, in units of 1/255 of full scale (of the largest colour of the transfer function where
// that is above 1), over a fixed set of rays with 1 to 1024 segments: straight runs through the
// scalars, up and down, over all of them and over parts from 1/2 to 1/2048 of them around each
// point of the transfer function (24 points at most), cut into equal and into random segments with
// lengths from `shortest` to `longest`. Against integrate_segment. Deterministic, parallel, a
// fraction of a second.
double table_error(const TransferFunction& transfer_function, const TableRays& rays,
                   const SegmentLookup& lookup);

}  // namespace lamina
