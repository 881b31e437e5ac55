// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include "lamina/transfer_function.h"

namespace lamina {

// Rounding of scalars, as a share of the window to which they are normalised: they and the transfer
// function's points are float32 numbers of the window, rounded a few times by at most half of 2^-23
// of it. For pieces of tets scalars are normalised to the piece, and this does not apply.
inline constexpr double scalar_rounding = 0x1p-22;

// Width, in roundings, up to which a ramp of the transfer function counts as a jump: on wider ones
// a rounding moves a scalar by less than a thousandth of the ramp.
inline constexpr double steep_width = 1024;

// Largest changes between two scalars, of what a ray of a given length shows.
struct OpticsChange {
    double extinction = 0;  // per world unit
    double color = 0;       // times the share of light that has this colour

    // Returns `share` of the change from a to b, for rays of this length.
    static OpticsChange between(const OpticalProperties& a, const OpticalProperties& b,
                                double length, double share) {
        const glm::dvec3 apart = glm::abs(b.color - a.color);
        const double seen = std::min(1.0, std::max(a.extinction, b.extinction) * length);
        return {share * std::abs(b.extinction - a.extinction),
                share * seen * std::max({apart.r, apart.g, apart.b})};
    }
    void enlarge(const OpticsChange& other) {
        extinction = std::max(extinction, other.extinction);
        color = std::max(color, other.color);
    }
    OpticsChange operator+(const OpticsChange& other) const {
        return {extinction + other.extinction, color + other.color};
    }
    // Returns a bound on the change of a ray of this length whose scalars are exchanged all along,
    // for colours up to 1, as a share of full scale (docs/numerics.md, equation (9.8)).
    double of_ray(double length) const {
        return std::min(1.0, -std::expm1(-extinction * length) + color);
    }
};

}  // namespace lamina
