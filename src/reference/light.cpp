// SPDX-License-Identifier: Apache-2.0
#include "reference/light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "reference/integrate.h"

namespace lamina {
namespace {

double largest_component(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 value_at(const GradientAlong& gradient, double t) {
    return {gradient[0](t), gradient[1](t), gradient[2](t)};
}

Cubic dot(const GradientAlong& gradient, const glm::dvec3& direction) {
    Cubic sum;
    for (std::size_t i = 0; i < 4; ++i) {
        sum.c[i] = gradient[0].c[i] * direction.x + gradient[1].c[i] * direction.y +
                   gradient[2].c[i] * direction.z;
    }
    return sum;
}

// A ball that the gradient stays in between two places.
struct GradientBall {
    glm::dvec3 center;
    double radius;
};

// Around the value in the middle, so large that it holds the four Bernstein coefficients: a
// polynomial stays in their convex hull.
GradientBall ball_of(const GradientAlong& gradient, double from, double to) {
    const double h = to - from;
    const glm::dvec3 start = value_at(gradient, from), end = value_at(gradient, to);
    glm::dvec3 second, third;
    for (int c = 0; c < 3; ++c) {
        const Cubic& component = gradient[static_cast<std::size_t>(c)];
        second[c] = start[c] + component.slope(from) * h / 3;
        third[c] = end[c] - component.slope(to) * h / 3;
    }
    const glm::dvec3 center = value_at(gradient, 0.5 * (from + to));
    return {center, std::max({glm::distance(start, center), glm::distance(second, center),
                              glm::distance(third, center), glm::distance(end, center)})};
}

// Sums over a pair of nodes of w = extinction exp(-depth), and of light's effect times w.
struct LitNodeValues {
    double w[8];
    glm::dvec3 light[8];
};

struct LitRuleResult {
    double w = 0;
    glm::dvec3 light{0};
};

template <int Count>
LitRuleResult apply_lit_rule(const double (&weights)[Count], const LitNodeValues& values,
                             double length) {
    LitRuleResult sum;
    for (int i = 0; i < Count; ++i) {
        sum.w += weights[i] * values.w[i];
        sum.light += weights[i] * values.light[i];
    }
    return {sum.w * length, sum.light * length};
}

class LightIntegrator {
  public:
    LightIntegrator(const LitPiece& piece, const RayLights& lights, double error_per_t,
                    double error_per_opacity)
        : piece_(piece),
          lights_(lights),
          error_per_t_(error_per_t),
          error_per_opacity_(error_per_opacity),
          largest_effect_(lights.largest_effect(
              largest_component(glm::max(piece.color, piece.color + piece.color_change)))),
          most_turn_(lights.has_highlights()
                         ? std::min(most_growth, peak_widths / std::sqrt(lights.power()))
                         : most_growth) {}

    LightIntegral run() {
        const std::vector<double> ends = smooth_parts();
        double depth_from = 0;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double depth_to = piece_.emission.depth(ends[i + 1]);
            add(ends[i], ends[i + 1], depth_from, depth_to);
            depth_from = depth_to;
        }
        return result_;
    }

  private:
    // Of the gradient's least length in an interval, how far it may be from that in the middle: the
    // light's effect has its singularities where the length is 0 or i times the smallest gradient,
    // at complex places as far from the interval as half of it is long, or farther.
    static constexpr double most_growth = 0.5;
    // A highlight falls to exp(-1/2) at an angle of 1 / sqrt(power). An interval of six times that
    // has a node of three within 1.2 times that of any peak.
    static constexpr double peak_widths = 3;

    // 0, the kinks in order, 1.
    std::vector<double> smooth_parts() const {
        std::vector<double> ends{0, 1};
        for (const RayLights::Direction& direction : lights_.directions()) {
            append_roots(direction.light, ends);
            if (lights_.has_highlights()) append_roots(direction.halfway, ends);
        }
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        return ends;
    }

    void append_roots(const glm::dvec3& direction, std::vector<double>& roots) const {
        const Cubic cosine = dot(piece_.gradient, direction);
        const CubicTurns turns = turns_of(cosine);
        for (int i = 0; i < turns.count; ++i) {
            const double from = turns.t[i], to = turns.t[i + 1];
            const double start = cosine(from), end = cosine(to);
            if (!(std::min(start, end) < 0 && std::max(start, end) > 0)) continue;
            roots.push_back(std::clamp(solve_monotone(cosine, 0, from, to), from, to));
        }
    }

    glm::dvec3 effect_at(double t) const {
        const glm::dvec3 color = piece_.color + piece_.emission.position(t) * piece_.color_change;
        return lights_.effect(value_at(piece_.gradient, t)).on(color);
    }

    void accept(const glm::dvec3& value, double error) {
        result_.value += value;
        result_.error += error;
    }

    void add(double from, double to, double depth_from, double depth_to) {
        const double in_front = std::exp(-depth_from);
        const double opacity = in_front * -std::expm1(depth_from - depth_to);
        const double allowed = error_per_t_ * (to - from) + error_per_opacity_ * opacity;
        const double middle = 0.5 * (from + to);
        const GradientBall ball = ball_of(piece_.gradient, from, to);
        const double steepness = glm::length(ball.center);
        const double bound = largest_effect_ * lights_.weight(steepness + ball.radius);
        // The effect is somewhere between -bound and bound, and so is its value in the middle.
        const bool exhausted = --budget_ <= 0 || !(from < middle && middle < to);
        if (2 * bound * opacity <= allowed || exhausted)
            return accept(effect_at(middle) * opacity, 2 * bound * std::max(opacity, 0.0));
        constexpr double resolvable_depth = 8;  // by 15 nodes; beyond it bisection is cheaper
        if (ball.radius <= most_turn_ * steepness && depth_to - depth_from < resolvable_depth) {
            const double rounding = 1e-15 * bound * in_front * (depth_to + 1);
            if (try_rules(from, to, opacity, bound, std::max(allowed, rounding))) return;
        }
        const double depth_middle = piece_.emission.depth(middle);
        add(from, middle, depth_from, depth_middle);
        add(middle, to, depth_middle, depth_to);
    }

    void evaluate(double from, double to, int first, int last, LitNodeValues& values) const {
        const double middle = 0.5 * (from + to), length = to - from;
        for (int i = first; i < last; ++i) {
            values.w[i] = 0;
            values.light[i] = glm::dvec3(0);
            const double offset = patterson::node[i] * length;
            for (const double t : {middle - offset, middle + offset}) {
                const double w =
                    piece_.emission.extinction(t) * std::exp(-piece_.emission.depth(t));
                values.w[i] += w;
                values.light[i] += w * effect_at(t);
                if (i == 0) break;  // both are the centre
            }
        }
    }

    // Where a rule misses a boundary layer, the integral of w shows it.
    static double estimate(const LitRuleResult& fine, const LitRuleResult& coarse, double opacity,
                           double bound) {
        return std::max(largest_component(glm::abs(fine.light - coarse.light)),
                        bound * std::abs(fine.w - opacity));
    }

    bool try_rules(double from, double to, double opacity, double bound, double allowed) {
        LitNodeValues values;
        evaluate(from, to, 0, 4, values);
        const LitRuleResult three = apply_lit_rule(patterson::weight3, values, to - from);
        const LitRuleResult seven = apply_lit_rule(patterson::weight7, values, to - from);
        double error = estimate(seven, three, opacity, bound);
        if (error <= allowed) {
            accept(seven.light, error);
            return true;
        }
        evaluate(from, to, 4, 8, values);
        const LitRuleResult fifteen = apply_lit_rule(patterson::weight15, values, to - from);
        error = estimate(fifteen, seven, opacity, bound);
        if (error > allowed) return false;
        accept(fifteen.light, error);
        return true;
    }

    const LitPiece& piece_;
    const RayLights& lights_;
    double error_per_t_, error_per_opacity_;
    double largest_effect_;
    double most_turn_;
    LightIntegral result_;
    int budget_ = 20000;  // intervals
};

}  // namespace

LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity) {
    return LightIntegrator(piece, lights, error_per_t, error_per_opacity).run();
}

}  // namespace lamina
