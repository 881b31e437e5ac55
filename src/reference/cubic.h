// SPDX-License-Identifier: Apache-2.0
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

// The ends of the intervals of [0, 1] on which the cubic is monotone: t[0] = 0 < ... < t[count] =
// 1.
struct MonotoneParts {
    std::array<double, 4> t{0, 1, 1, 1};
    int count = 1;
};
MonotoneParts monotone_parts(const Cubic& cubic);

// Newton's method for solve_monotone(): steps at most, and the share of t to which it is found.
inline constexpr int most_newton_steps = 200;
inline constexpr double root_precision = 0.5 * std::numeric_limits<double>::epsilon();

// The t in [from, to] where the cubic equals `value`. The cubic must be monotone there, and `value`
// must lie between its values at the ends. The result has full precision for all slopes.
double solve_monotone(const Cubic& cubic, double value, double from, double to);

// The cubic restricted to `from` .. `to`, as a cubic on [0, 1]. `start` and `end` are its values at
// the ends, which the caller knows better than they can be computed here. The result is exactly
// `start` at 0 and, up to one rounding, `end` at 1.
Cubic part_of(const Cubic& cubic, double from, double to, double start, double end);

}  // namespace lamina
