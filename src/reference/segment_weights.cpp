// SPDX-License-Identifier: Apache-2.0
#include "reference/segment_weights.h"

#include "optics/gauss_rules.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/segment_weights.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Vector form of the sums in optics/segment_integral.cpp, which says why they are written so.
inline PieceWeights weights_by_rule(const GaussRule& rule, double p, double q) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<double, 4> d;
    const auto half_p = hn::Set(d, p / 2), half_q = hn::Set(d, q / 2), one = hn::Set(d, 1.0);
    auto front = hn::Zero(d), back = hn::Zero(d);
    for (std::size_t i = 0; i < rule.points; i += hn::Lanes(d)) {
        const auto x = hn::LoadU(d, rule.x + i), weight = hn::LoadU(d, rule.weight + i);
        const auto rest = hn::Sub(one, x);
        // x (p (1 - x / 2) + q x / 2), and (1 - x) (p (1 - x) / 2 + q (1 + x) / 2)
        const auto before = hn::Mul(x, hn::MulAdd(half_p, hn::Add(one, rest), hn::Mul(half_q, x)));
        const auto behind =
            hn::Mul(rest, hn::MulAdd(half_p, rest, hn::Mul(half_q, hn::Add(one, x))));
        const auto absorbed = hn::Neg(hn::Expm1(d, hn::Neg(before)));
        const auto absorbed_behind = hn::Neg(hn::Expm1(d, hn::Neg(behind)));
        front = hn::MulAdd(weight, absorbed, front);
        back = hn::MulAdd(hn::Mul(weight, hn::Sub(one, absorbed)), absorbed_behind, back);
    }
    return {hn::GetLane(hn::SumOfLanes(d, front)), hn::GetLane(hn::SumOfLanes(d, back))};
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(weights_by_rule);

PieceWeights segment_weights(double p, double q) {
    const double depth = p / 2 + q / 2;
    if (!(depth < largest_gauss_depth)) return piece_weights(p, q);
    return HWY_DYNAMIC_DISPATCH(weights_by_rule)(gauss_rule(depth), p, q);
}

}  // namespace lamina
#endif
