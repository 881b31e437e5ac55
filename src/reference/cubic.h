// SPDX-License-Identifier: Apache-2.0
// A scalar along a ray in a cell is a cubic (docs/numerics.md, section 9.1). This finds the places
// at which it turns, and those at which it has a value:
//
//   turns: the roots of the derivative inside (0, 1), in the form that does not cancel
//
//   solve(value, from, to), between two turns:
//       t = the place in from .. to as if the cubic were straight
//       loop: keep the bracket's end whose sign is that of f = cubic(t) - value at t
//           next = t - f / slope, by Newton; the bracket's middle if that is outside or too slow
//           end if the error of the step, bend / slope * step^2 / 2, is below a rounding of t
//
// reference/cubic-inl.h has the vector form.
#pragma once

#include <array>
#include <limits>

namespace lamina {

// The polynomial c[0] + c[1] t + c[2] t^2 + c[3] t^3 on 0 <= t <= 1. A trilinear field along a
// straight line is such a cubic.
struct Cubic {
    std::array<double, 4> c{};

    double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    double slope(double t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3])); }
    bool constant() const { return c[1] == 0 && c[2] == 0 && c[3] == 0; }
};

// A gradient along a ray, component by component, in world space.
using GradientAlong = std::array<Cubic, 3>;

// The places at which a cubic turns, between 0 and 1: t[0] = 0 < ... < t[count] = 1. It is monotone
// between two of them.
struct CubicTurns {
    std::array<double, 4> t{0, 1, 1, 1};
    int count = 1;
};
CubicTurns turns_of(const Cubic& cubic);

// Largest number of steps of Newton's method, and the share of t to which it finds t.
inline constexpr int most_newton_steps = 200;
inline constexpr double root_precision = 0.5 * std::numeric_limits<double>::epsilon();

// Returns the t in [from, to] at which the cubic equals `value`. The cubic must be monotone there,
// and `value` must lie between its values at the ends. The result has full precision for all
// slopes.
double solve_monotone(const Cubic& cubic, double value, double from, double to);

// Returns the cubic between `from` and `to` as a cubic on [0, 1]. `start` and `end` are its values
// at the ends, which the caller knows better than they can be computed here. The result is exactly
// `start` at 0 and, up to one rounding, `end` at 1.
Cubic restricted(const Cubic& cubic, double from, double to, double start, double end);

}  // namespace lamina
