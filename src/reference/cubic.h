// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace lamina {

// The polynomial c[0] + c[1] t + c[2] t^2 + c[3] t^3 on 0 <= t <= 1: what a trilinear field is
// along a straight line.
struct Cubic {
    std::array<double, 4> c{};

    double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    double slope(double t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3])); }
    bool constant() const { return c[1] == 0 && c[2] == 0 && c[3] == 0; }
};

// The ends of the parts of [0, 1] on which the cubic is monotone: t[0] = 0 < ... < t[count] = 1.
struct MonotoneParts {
    std::array<double, 4> t{0, 1, 1, 1};
    int count = 1;
};
MonotoneParts monotone_parts(const Cubic& cubic);

// The t in [from, to] where the cubic is `value`. The cubic is monotone there and `value` lies
// between its values at the ends. To full precision, for all slopes.
double solve_monotone(const Cubic& cubic, double value, double from, double to);

// The cubic's part from `from` to `to` (lengths > 0) as a cubic on [0, 1] that is exactly `start`
// and, to one rounding, `end` there: its values at the ends, where they are known better than they
// can be computed.
Cubic part_of(const Cubic& cubic, double from, double to, double start, double end);

}  // namespace lamina
