// SPDX-License-Identifier: Apache-2.0
#include "reference/emission_integral.h"

#include <algorithm>
#include <cmath>

#include "reference/patterson_rules.h"

namespace lamina {
namespace {

using namespace patterson;

// Sums over a pair of nodes of w = extinction exp(-depth) and of x w. The integral of w is known in
// closed form, which shows where a rule misses a boundary layer.
struct NodeValues {
    double w[8], xw[8];
};

void evaluate(const EmissionPiece& piece, double from, double to, int first, int last,
              NodeValues& values) {
    const double middle = 0.5 * (from + to), length = to - from;
    const auto weight_at = [&](double t) {
        return piece.extinction(t) * std::exp(-piece.depth(t));
    };
    for (int i = first; i < last; ++i) {
        const double left = middle - node[i] * length, right = middle + node[i] * length;
        const double w_left = weight_at(left), w_right = i == 0 ? 0 : weight_at(right);
        values.w[i] = w_left + w_right;
        values.xw[i] = piece.position(left) * w_left + piece.position(right) * w_right;
    }
}

struct RuleResult {
    double w = 0, xw = 0;
};

template <int Count>
RuleResult apply_rule(const double (&weights)[Count], const NodeValues& values, double length) {
    RuleResult sum;
    for (int i = 0; i < Count; ++i) {
        sum.w += weights[i] * values.w[i];
        sum.xw += weights[i] * values.xw[i];
    }
    return {sum.w * length, sum.xw * length};
}

double estimate(const RuleResult& fine, const RuleResult& coarse, double exact_w) {
    return std::max(std::abs(fine.xw - coarse.xw), std::abs(fine.w - exact_w));
}

class Integrator {
  public:
    Integrator(const EmissionPiece& piece, double error_per_t, double error_per_opacity)
        : piece_(piece), error_per_t_(error_per_t), error_per_opacity_(error_per_opacity) {}

    EmissionIntegral run() {
        add(0, 1, 0, piece_.depth(1));
        return result_;
    }

  private:
    void accept(double value, double error) {
        result_.value += value;
        result_.error += error;
    }

    void add(double from, double to, double depth_from, double depth_to) {
        const double in_front = std::exp(-depth_from);
        const double opacity = in_front * -std::expm1(depth_from - depth_to);
        const double allowed = error_per_t_ * (to - from) + error_per_opacity_ * opacity;
        const double middle = 0.5 * (from + to);
        // x is somewhere in [0, 1], so any of its values is within `opacity` of the integral.
        const bool exhausted = --budget_ <= 0 || !(from < middle && middle < to);
        if (opacity <= negligible_opacity * allowed || exhausted) {
            return accept(piece_.position(middle) * opacity, opacity);
        }
        if (depth_to - depth_from < resolvable_depth) {
            const double rounding = emission_rounding * in_front * depth_to;
            if (try_rules(from, to, opacity, std::max(allowed, rounding))) return;
        }
        const double depth_middle = piece_.depth(middle);
        add(from, middle, depth_from, depth_middle);
        add(middle, to, depth_middle, depth_to);
    }

    bool try_rules(double from, double to, double opacity, double allowed) {
        NodeValues values;
        evaluate(piece_, from, to, 0, 4, values);
        const RuleResult three = apply_rule(weight3, values, to - from);
        const RuleResult seven = apply_rule(weight7, values, to - from);
        double error = estimate(seven, three, opacity);
        if (error <= allowed) {
            accept(seven.xw, error);
            return true;
        }
        evaluate(piece_, from, to, 4, 8, values);
        const RuleResult fifteen = apply_rule(weight15, values, to - from);
        error = estimate(fifteen, seven, opacity);
        if (error > allowed) return false;
        accept(fifteen.xw, error);
        return true;
    }

    const EmissionPiece& piece_;
    double error_per_t_, error_per_opacity_;
    EmissionIntegral result_;
    int budget_ = 2000;  // parts; a boundary layer of optical depth 1e7 takes some 60
};

}  // namespace

EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity) {
    return Integrator(piece, error_per_t, error_per_opacity).run();
}

}  // namespace lamina
