// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/cubic.h"

namespace lamina {

// A piece of a ray on which extinction and colour are the same linear function of a position x:
// with t from 0 (towards the eye) to 1, x(t) and the optical depth per unit of t are cubics.
struct EmissionPiece {
    Cubic position;    // 0 <= x <= 1 but for rounding
    Cubic extinction;  // times the length of the piece, >= 0 but for rounding

    double depth(double t) const {  // from the front to t
        const auto& e = extinction.c;
        return t * (e[0] + t * (e[1] / 2 + t * (e[2] / 3 + t * (e[3] / 4))));
    }
};

struct EmissionIntegral {
    double value = 0;
    double error = 0;  // estimate of |error|, above the true one but for rounding
};

// The integral of x(t) extinction(t) exp(-depth(t)) over [0, 1], between 0 and 1 - exp(-depth(1)).
// Each part of it may err by `error_per_t` times its length plus `error_per_opacity` times its
// share of 1 - exp(-depth(1)). Any depth(1): a boundary layer is found by bisection, and what it
// hides is not refined.
EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity);

}  // namespace lamina
