// SPDX-License-Identifier: Apache-2.0
#include "reference/light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

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

// A ball in which the gradient stays between two places.
struct GradientBall {
    glm::dvec3 center;
    double radius;
};

// Returns a ball around the value in the middle. It holds the four Bernstein coefficients: a
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

// Largest distance of gradients from that in the middle of an interval, as a share of their least
// length there: the light's effect has its singularities at lengths 0 and i times the smallest
// gradient, at complex places as far from the interval as half of it is long, or farther.
constexpr double most_growth = 0.5;
// Width of a highlight's peak, in units of 1 / sqrt(power), the angle at which it falls to
// exp(-1/2). Three nodes on six of these units have one within 1.2 units of any peak.
constexpr double peak_widths = 3;

// The effect of light on the colour of a piece.
class LightEffect {
  public:
    using Value = glm::dvec3;

    LightEffect(const LitPiece& piece, const RayLights& lights)
        : piece_(piece),
          lights_(lights),
          largest_effect_(lights.largest_effect(
              largest_component(glm::max(piece.color, piece.color + piece.color_change)))),
          most_turn_(lights.has_highlights()
                         ? std::min(most_growth, peak_widths / std::sqrt(lights.power()))
                         : most_growth) {}

    // Returns 0, the kinks in order, and 1.
    std::vector<double> smooth_intervals() const {
        std::vector<double> ends{0, 1};
        for (const RayLights::Direction& direction : lights_.directions()) {
            append_roots(direction.light, ends);
            if (lights_.has_highlights()) append_roots(direction.halfway, ends);
        }
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        return ends;
    }

    glm::dvec3 at(double t) const {
        const glm::dvec3 color = piece_.color + piece_.emission.position(t) * piece_.color_change;
        return lights_.effect(value_at(piece_.gradient, t)).on(color);
    }
    QuantityRange over(double from, double to) const {
        const GradientBall ball = ball_of(piece_.gradient, from, to);
        const double steepness = glm::length(ball.center);
        return {largest_effect_ * lights_.weight(steepness + ball.radius),
                ball.radius <= most_turn_ * steepness};
    }
    // The effect is between -bound and bound, and so is its value in the middle.
    bool is_faint(double opacity, double allowed, double bound) const {
        return 2 * bound * opacity <= allowed;
    }
    double spread(double opacity, double bound) const { return 2 * bound * std::max(opacity, 0.0); }
    double rounding(double in_front, double depth_to, double bound) const {
        return 1e-15 * bound * in_front * (depth_to + 1);
    }
    double largest(const glm::dvec3& effect) const { return largest_component(glm::abs(effect)); }

  private:
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

    const LitPiece& piece_;
    const RayLights& lights_;
    double largest_effect_;
    double most_turn_;  // as a share of the gradient's length
};

}  // namespace

LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity) {
    constexpr int most_intervals = 20000;
    const LightEffect effect(piece, lights);
    NestedIntegral integral(piece.emission, effect, error_per_t, error_per_opacity, most_intervals);
    const std::vector<double> ends = effect.smooth_intervals();
    double depth_from = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double depth_to = piece.emission.depth(ends[i + 1]);
        integral.add(ends[i], ends[i + 1], depth_from, depth_to);
        depth_from = depth_to;
    }
    return integral.result();
}

}  // namespace lamina
