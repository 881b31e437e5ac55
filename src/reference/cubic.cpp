// SPDX-License-Identifier: Apache-2.0
#include "reference/cubic.h"

#include <algorithm>
#include <cmath>

namespace lamina {

CubicTurns turns_of(const Cubic& cubic) {
    // Derivative a t^2 + 2 b t + c, scaled so that no square of a coefficient underflows; the
    // quotient form has no cancellation (Press et al., Numerical Recipes, 5.6).
    double a = 3 * cubic.c[3], b = cubic.c[2], c = cubic.c[1];
    const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
    a /= largest;
    b /= largest;
    c /= largest;
    const double discriminant = b * b - a * c;
    CubicTurns turns;
    if (!(discriminant > 0)) return turns;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const auto [first, second] = std::minmax({q / a, c / q});  // infinite if a = 0: not kept
    for (const double root : {first, second}) {
        if (!(root > turns.t[turns.count - 1] && root < 1)) continue;
        turns.t[turns.count] = root;
        turns.t[++turns.count] = 1;
    }
    return turns;
}

// Uses Newton's method inside a bracket. The bracket is bisected if Newton's step would leave it or
// shrinks it too slowly. A step is the last one if the error that it leaves, at most its square
// times half of the second derivative by the slope, is less than a rounding of t.
double solve_monotone(const Cubic& cubic, double value, double from, double to) {
    Cubic shifted = cubic;
    shifted.c[0] -= value;
    double below = from, above = to;  // there the shifted cubic is negative, and positive
    const double at_from = shifted(from), at_to = shifted(to);
    if (at_from > at_to) std::swap(below, above);
    double t = from + (to - from) * (at_from / (at_from - at_to));  // as if it were straight
    if (!(t > from && t < to)) t = 0.5 * (from + to);
    double step = std::abs(to - from), previous_step = step;
    const double bend = std::abs(cubic.c[2]) + 3 * std::abs(cubic.c[3]);
    for (int i = 0; i < most_newton_steps; ++i) {
        const double f = shifted(t), slope = shifted.slope(t);
        if (f == 0) return t;
        (f < 0 ? below : above) = t;
        const double newton = t - f / slope;
        const bool inside = newton > std::min(below, above) && newton < std::max(below, above);
        const bool fast = std::abs(2 * f) <= std::abs(previous_step * slope);
        const bool by_newton = inside && fast;
        const double next = by_newton ? newton : 0.5 * (below + above);
        previous_step = step;
        step = std::abs(next - t);
        t = next;
        const double rounding = root_precision * std::abs(t);
        const double bent = bend / std::abs(slope) * step;
        const bool straight = bent * step <= rounding && 8 * bent <= 1;
        if (step <= rounding || (by_newton && straight)) break;
    }
    return t;
}

Cubic restricted(const Cubic& cubic, double from, double to, double start, double end) {
    const double h = to - from;
    Cubic inside;
    inside.c[0] = start;
    inside.c[1] = cubic.slope(from) * h;
    inside.c[2] = (cubic.c[2] + 3 * cubic.c[3] * from) * h * h;
    inside.c[3] = cubic.c[3] * h * h * h;
    inside.c[1] += (end - start) - (inside.c[1] + inside.c[2] + inside.c[3]);
    return inside;
}

}  // namespace lamina
