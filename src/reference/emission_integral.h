// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/cubic.h"

namespace lamina {

// A piece of a ray on which extinction and colour are linear functions of one position x. With t
// from 0 (towards the eye) to 1, x(t) and the optical depth per unit of t are cubics.
struct EmissionPiece {
    Cubic position;    // 0 <= x <= 1 up to rounding
    Cubic extinction;  // extinction times the length of the piece, >= 0 up to rounding

    double depth(double t) const {  // optical depth from the front to t
        const auto& e = extinction.c;
        return t * (e[0] + t * (e[1] / 2 + t * (e[2] / 3 + t * (e[3] / 4))));
    }
};

// A piece whose opacity is this share of the error allowed to it has any of its colours.
inline constexpr double negligible_opacity = 1.0 / 1024;
// 15 nodes resolve this optical depth. Deeper pieces are bisected, which is cheaper.
inline constexpr double resolvable_depth = 8;
// The rounding of a rule's sums, relative to the optical depth.
inline constexpr double emission_rounding = 1e-15;

struct EmissionIntegral {
    double value = 0;
    double error = 0;  // estimate of |error|; the true error is smaller, up to rounding
};

// The integral of x(t) extinction(t) exp(-depth(t)) over [0, 1], which lies between 0 and 1 -
// exp(-depth(1)). Each interval may contribute an error of `error_per_t` times its length plus
// `error_per_opacity` times its share of 1 - exp(-depth(1)). depth(1) may have any value: a
// boundary layer is found by bisection, and what it hides is not refined.
EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity);

}  // namespace lamina
