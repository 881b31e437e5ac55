// SPDX-License-Identifier: Apache-2.0
// The visible colour of a ray's pieces. On a piece of a cubic segment the position x(t) in the
// interval and the extinction e(t) are cubics, and D(t), the integral of e, is the optical depth
// (docs/numerics.md, section 9.2). The change of the colour is weighted by the integral of x e
// exp(-D):
//
//   integral(from, to):
//       opacity = exp(-D(from)) - exp(-D(to)), which is the integral of e exp(-D)
//       if the opacity is negligible beside the error that is allowed: x(middle) opacity
//       Patterson's rules of 3, 7 and 15 nodes of x e exp(-D), and of e exp(-D) to see their error
//       if two that follow each other differ by no more than is allowed: the finer one
//       otherwise integral(from, middle) + integral(middle, to)
//
// The rules on whole pieces are computed in vectors. Pieces of linear segments have closed forms
// (optics/segment_integral.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/cut.h"

namespace lamina {
namespace patterson {

// Patterson's nested extensions of the 3-point Gauss-Legendre rule (Patterson 1968, Math. Comp. 22,
// 847-856), exact to degree 5, 11 and 23: entry 0 is the centre, entry i > 0 the pair 1/2 +-
// node[i] of [0, 1].
inline constexpr double node[8] = {0,
                                   0.3872983346207416885,
                                   0.2171218746734012790,
                                   0.4802456343540101417,
                                   0.1116933432144834408,
                                   0.3105514733686132015,
                                   0.4442296164361284994,
                                   0.4969159816063775111};
inline constexpr double weight3[2] = {0.4444444444444444444, 0.2777777777777777778};
inline constexpr double weight7[4] = {0.2254582693292370712, 0.1342440449341667204,
                                      0.2006987073879811115, 0.0523281130132336326};
inline constexpr double weight15[8] = {
    0.1127552498991033437, 0.06720762762189211018, 0.1003142646884945105,  0.02580164149853986985,
    0.1095784292007937482, 0.08575595456819569039, 0.04646359765756226884, 0.00850085981497013017};

}  // namespace patterson

// Share of its allowed error below which a piece's opacity is so small that any of its colours will
// do.
inline constexpr double negligible_opacity = 1.0 / 1024;
// Depth that 15 nodes resolve. Deeper pieces are bisected, which is cheaper.
inline constexpr double resolvable_depth = 8;
// Rounding of a rule's sums, relative to the optical depth.
inline constexpr double emission_rounding = 1e-15;

// The integral of a quantity f(t), weighted by w = extinction exp(-depth), over [0, 1].
template <typename Value>
struct Integral {
    Value value{0};
    double error = 0;  // estimate of |error|, of the worst component; the true one is smaller
};
using EmissionIntegral = Integral<double>;

// Returns the integral of x(t) extinction(t) exp(-depth(t)) over [0, 1], which lies between 0 and 1
// - exp(-depth(1)). Each interval may contribute an error of `error_per_t` times its length plus
// `error_per_opacity` times its share of 1 - exp(-depth(1)). depth(1) may have any value: a
// boundary layer is found by bisection, and everything that it hides is not refined.
EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity);

// Sets the results of all pieces.
void integrate_emission(PieceBatch& batch);

// Sets the results of all pieces. The relative error of each weight is some 1e-13
// (optics/segment_integral.h).
void weigh_pieces(LinearPieces& pieces);

// Sums, over a pair of nodes or over those of a rule, of w and of f w.
template <typename Value>
struct WeightedSum {
    double w = 0;
    Value value{0};
};

// Bounds of f in an interval.
struct QuantityRange {
    double bound;  // of |f|, and of |f| of any component
    bool smooth;   // no dip and no peak of f fits between the nodes of a rule
};

// Integrates f(t) w(t) by Patterson's rules and bisection. The integral of w is known in closed
// form, which shows if a rule misses a boundary layer. Members of `Quantity`:
//
//   Value at(t)                                  f
//   QuantityRange over(from, to)
//   bool is_faint(opacity, allowed, bound)       any value of f will do for the interval's
//   double spread(opacity, bound)                largest error in that case
//   double rounding(in_front, depth_to, bound)   of a rule's sums; in_front: transmittance
//   double largest(Value)                        absolute value, of the largest component
template <class Quantity>
class NestedIntegral {
  public:
    using Value = typename Quantity::Value;

    // `most_intervals`: all intervals beyond these get any value.
    NestedIntegral(const EmissionPiece& piece, const Quantity& quantity, double error_per_t,
                   double error_per_opacity, int most_intervals)
        : piece_(piece),
          quantity_(quantity),
          error_per_t_(error_per_t),
          error_per_opacity_(error_per_opacity),
          budget_(most_intervals) {}

    // Adds the integral over an interval, with the depths in front of its ends.
    void add(double from, double to, double depth_from, double depth_to) {
        const double in_front = std::exp(-depth_from);
        const double opacity = in_front * -std::expm1(depth_from - depth_to);
        const double allowed = error_per_t_ * (to - from) + error_per_opacity_ * opacity;
        const double middle = 0.5 * (from + to);
        const QuantityRange range = quantity_.over(from, to);
        const bool exhausted = --budget_ <= 0 || !(from < middle && middle < to);
        if (quantity_.is_faint(opacity, allowed, range.bound) || exhausted) {
            return accept(quantity_.at(middle) * opacity, quantity_.spread(opacity, range.bound));
        }
        if (range.smooth && depth_to - depth_from < resolvable_depth) {
            const double rounding = quantity_.rounding(in_front, depth_to, range.bound);
            if (try_rules(from, to, opacity, range.bound, std::max(allowed, rounding))) return;
        }
        const double depth_middle = piece_.depth(middle);
        add(from, middle, depth_from, depth_middle);
        add(middle, to, depth_middle, depth_to);
    }

    const Integral<Value>& result() const { return result_; }

  private:
    using Sum = WeightedSum<Value>;

    void accept(const Value& value, double error) {
        result_.value += value;
        result_.error += error;
    }

    bool try_rules(double from, double to, double opacity, double bound, double allowed) {
        Sum nodes[8];
        evaluate(from, to, 0, 4, nodes);
        const Sum three = by_rule(patterson::weight3, nodes, to - from);
        const Sum seven = by_rule(patterson::weight7, nodes, to - from);
        double error = difference(seven, three, opacity, bound);
        if (error <= allowed) {
            accept(seven.value, error);
            return true;
        }
        evaluate(from, to, 4, 8, nodes);
        const Sum fifteen = by_rule(patterson::weight15, nodes, to - from);
        error = difference(fifteen, seven, opacity, bound);
        if (error > allowed) return false;
        accept(fifteen.value, error);
        return true;
    }

    void evaluate(double from, double to, int first, int last, Sum (&nodes)[8]) const {
        const double middle = 0.5 * (from + to), length = to - from;
        for (int i = first; i < last; ++i) {
            const double offset = patterson::node[i] * length;
            for (const double t : {middle - offset, middle + offset}) {
                const double w = piece_.extinction(t) * std::exp(-piece_.depth(t));
                nodes[i].w += w;
                nodes[i].value += w * quantity_.at(t);
                if (i == 0) break;  // both are the centre
            }
        }
    }

    template <int count>
    static Sum by_rule(const double (&weights)[count], const Sum (&nodes)[8], double length) {
        Sum sum;
        for (int i = 0; i < count; ++i) {
            sum.w += weights[i] * nodes[i].w;
            sum.value += weights[i] * nodes[i].value;
        }
        return {sum.w * length, sum.value * length};
    }

    double difference(const Sum& fine, const Sum& coarse, double opacity, double bound) const {
        return std::max(quantity_.largest(fine.value - coarse.value),
                        bound * std::abs(fine.w - opacity));
    }

    const EmissionPiece& piece_;
    const Quantity& quantity_;
    double error_per_t_, error_per_opacity_;
    int budget_;  // intervals
    Integral<Value> result_;
};

}  // namespace lamina
