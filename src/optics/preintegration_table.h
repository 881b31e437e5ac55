// SPDX-License-Identifier: Apache-2.0
// Pre-integrated transfer functions (docs/numerics.md, section 5). Tables store quantities that do
// not scale with length. So opacity is exact at every length, and colour has a finite limit at
// length 0.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/front_parts.h"
#include "optics/segment_integral.h"

namespace lamina {

struct PreintegrationRequest {
    double lo = 0, hi = 1;   // scalars, lo <= hi, both finite
    double max_length = 1;   // longest segment in world units, finite, >= 0
    int scalar_nodes = 256;  // approximate number of nodes, >= 2
    int length_layers = 1;   // >= 1
    bool colored = true;     // false only where transfer_function.single_color(lo, hi)
    bool lit = false;        // with front parts; needs `colored`

    friend bool operator==(const PreintegrationRequest&, const PreintegrationRequest&) = default;
};

// Tables over the scalars at the front and the back of a segment. Nodes are aligned with the
// transfer function's knots, so that within one linear piece the mean extinction is exactly
// bilinear, and nothing is interpolated across a step. Where front and back lie close on both sides
// of a step, no table is right; there the corner holds the mean of both sides.
struct PreintegrationTable {
    struct Anchor {
        double value;
        int node;
    };

    // S scalars over [lo, hi], in non-decreasing order. A step's value occurs twice (left, right).
    std::vector<double> nodes;
    // The scalars lo, the knots in (lo, hi) (steps twice), and hi. Between two anchors lie one or
    // more equally spaced nodes. For lo == hi there is one node and one anchor.
    std::vector<Anchor> anchors;
    // L >= 1 lengths, equally spaced from lengths[0] = 0 (the limit) to max_length.
    std::vector<double> lengths;
    bool colored = true;
    glm::dvec3 single_color{0};  // the colour where colored is false
    // S * S values tbar = optical depth / length, index back * S + front.
    std::vector<float> mean_extinction;
    // L * S * S * 3 values E = tbar * C / alpha, index ((layer * S + back) * S + front) * 3 +
    // channel; empty where colored is false. Look-ups need pairs of nodes within one linear piece
    // and pairs of anchors. For all other pairs every layer holds the limit.
    std::vector<float> emission;
    // Of lit tables L * S * S * 4 values tbar * FrontParts / alpha: of the colour, then of the
    // opacity; in the order of `emission`, and looked up as that is. Otherwise empty.
    std::vector<float> front_parts;
    bool lit() const { return !front_parts.empty(); }

    // The node coordinate of a scalar (clamped to [lo, hi]): whole numbers are nodes. At a step it
    // is the right node.
    double coordinate(double value) const;

    // Computes what shaders do (optics/preintegration.glsl): it interpolates bilinearly in the
    // scalars and linearly in length (clamped to max_length), then alpha = -expm1(-tbar * length)
    // and C = alpha * E / tbar. tbar and E are smooth only within a linear piece. So a segment is
    // cut at the first and at the last anchor between its ends and composed of at most three
    // look-ups. Each of these is within smooth cells or, between anchors, exact in the scalars.
    SegmentIntegral lookup(double front, double back, double length) const {
        return lookup_lit(front, back, length).whole;
    }
    // The same with the front parts of lit tables.
    LitIntegral lookup_lit(double front, double back, double length) const;

    std::int64_t byte_count() const {
        const std::size_t numbers = mean_extinction.size() + emission.size() + front_parts.size();
        return static_cast<std::int64_t>(numbers * sizeof(float));
    }
};

// Builds a table in parallel. It has at most 1.5 * scalar_nodes + 3 * (knots in (lo, hi) + 1)
// nodes. Throws Error where more than 1024 knots lie in (lo, hi) or the emission would exceed 1
// GiB. Extinctions beyond the largest float are clamped to it.
PreintegrationTable build_preintegration_table(const TransferFunction& transfer_function,
                                               const PreintegrationRequest& request);

}  // namespace lamina
