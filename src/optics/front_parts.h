// SPDX-License-Identifier: Apache-2.0
// Segments under light that changes linearly along them (docs/numerics.md, section 10; Lum, Wilson,
// Ma 2004).
#pragma once

#include <glm/vec3.hpp>

#include "lamina/transfer_function.h"
#include "optics/segment_integral.h"

namespace lamina {

// A segment's opacity and associated colour, and the share of both that remains if each of its
// points is multiplied by a factor that falls linearly from 1 at the front to 0 at the back.
struct FrontParts {
    double alpha = 0;
    glm::dvec3 color{0};
};

struct LitIntegral {
    SegmentIntegral whole;
    FrontParts front;
};

// Integrates a segment on which the scalar is linear, as integrate_segment() does. The front parts
// are accurate to about 1e-8 of the whole.
LitIntegral integrate_lit_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length);

// A part of a segment on which colour and extinction are linear. `from` and `to` are shares of the
// segment's length.
struct SegmentStretch {
    OpticalProperties front, back;
    double length = 0, from = 0, to = 1;
};
// Returns what the part contributes, seen from its own front.
FrontParts front_parts_of(const SegmentStretch& piece);

}  // namespace lamina
