// SPDX-License-Identifier: Apache-2.0
// Pre-integrated transfer functions (docs/numerics.md, section 5): what does not scale with length
// is stored, so that opacity is exact at every length and colour has a finite limit at length 0.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/segment_integral.h"

namespace lamina {

struct PreintegrationRequest {
    double lo = 0, hi = 1;   // scalars, lo <= hi, both finite
    double max_length = 1;   // longest segment in world units, finite, >= 0
    int scalar_nodes = 256;  // about so many nodes, >= 2
    int length_layers = 1;   // >= 1
    bool colored = true;     // false: only where transfer_function.single_color(lo, hi)

    friend bool operator==(const PreintegrationRequest&, const PreintegrationRequest&) = default;
};

// Tables over the scalars at the front and the back of a segment. Nodes are aligned with the
// transfer function's knots, so that within one linear piece the mean extinction is exactly
// bilinear, and nothing is mixed across a step. Where front and back lie close on both sides of a
// step, no table is right: there the corner holds the equal mix.
struct PreintegrationTable {
    struct Anchor {
        double value;
        int node;
    };

    std::vector<double> nodes;  // S scalars over [lo, hi], non-decreasing; a step's value stands
                                // twice (left, right)
    // Lo, the knots in (lo, hi) (steps twice), hi; equally spaced nodes between two of them, at
    // least one. lo == hi: one node, one anchor.
    std::vector<Anchor> anchors;
    // L >= 1, equally spaced from lengths[0] = 0, the limit, to max_length.
    std::vector<double> lengths;
    bool colored = true;
    glm::dvec3 single_color{0};  // the colour where colored is false
    // S * S, index back * S + front: tbar = optical depth / length.
    std::vector<float> mean_extinction;
    std::vector<float> emission;  // L * S * S * 3, index ((layer * S + back) * S + front) * 3 +
                                  // channel: E = tbar * C / alpha; empty where colored is false.
                                  // Look-ups meet pairs of nodes within one linear piece and pairs
                                  // of anchors; of all others every layer holds the limit

    // Node coordinate of a scalar (clamped to [lo, hi]): whole numbers are nodes. At a step: its
    // right node.
    double coordinate(double value) const;

    // What shaders do (optics/preintegration.glsl): between nodes bilinear in the scalars and
    // linear in length (clamped to max_length), alpha = -expm1(-tbar * length), C = alpha * E /
    // tbar. tbar and E are smooth only within a linear piece: a segment is cut at the first and at
    // the last anchor between its ends and composed of at most three look-ups, each within smooth
    // cells or, between anchors, exact in the scalars.
    SegmentIntegral lookup(double front, double back, double length) const;

    std::int64_t byte_count() const {
        return static_cast<std::int64_t>((mean_extinction.size() + emission.size()) *
                                         sizeof(float));
    }
};

// In parallel. The table has at most 1.5 * scalar_nodes + 3 * (knots in (lo, hi) + 1) nodes. Throws
// Error where more than 1024 knots lie in (lo, hi) or the emission would exceed 1 GiB. Extinctions
// beyond the largest float are cut to it.
PreintegrationTable build_preintegration_table(const TransferFunction& transfer_function,
                                               const PreintegrationRequest& request);
// The same, remembered by content (optics/table_memory.h).
std::shared_ptr<const PreintegrationTable> preintegration_table(
    const TransferFunction& transfer_function, const PreintegrationRequest& request);

}  // namespace lamina
