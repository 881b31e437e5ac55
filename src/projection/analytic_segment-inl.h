// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/analytic_segment.glsl. It integrates segments on which the scalar
// is linear exactly, interval by interval of the transfer function.
#if defined(LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#undef LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#else
#define LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_optics-inl.h"
#include "tiles/piece_weights-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The associated colour and the optical depth of a segment.
struct AnalyticSum {
    Floats color[3];
    Floats depth;
};

// `colored`: otherwise only the optical depth is computed. Scalars lie in [0, 1].
HWY_INLINE AnalyticSum integrate_analytic(const TileTransfer& transfer, bool colored, Floats front,
                                          Floats back, Floats world_length) {
    constexpr Lookup kind = Lookup::gather;
    const FloatTag d;
    const IntTag di;
    const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    const Ints one_int = hn::Set(di, 1), most = hn::Set(di, transfer.intervals - 1);
    Ints interval = find_interval<kind>(transfer, front);
    const Ints last = find_interval<kind>(transfer, back);
    const auto rising_int = hn::Not(hn::Gt(interval, last));
    const auto rising = hn::RebindMask(d, rising_int);
    const auto one_piece = hn::RebindMask(d, hn::Eq(interval, last));
    // The share of an interval at which the ray leaves it.
    const Floats end_share = hn::IfThenElseZero(rising, one);
    const Ints to_end = hn::IfThenElseZero(rising_int, one_int);
    const Ints step = hn::Sub(hn::Add(to_end, to_end), one_int);
    const Floats per_scalar = hn::Div(world_length, hn::Abs(hn::Sub(back, front)));
    Ints left = hn::Abs(hn::Sub(last, interval));

    Floats scalar = front, share = share_of_interval<kind>(transfer, interval, front);
    Floats transmittance = one;
    AnalyticSum sum{{zero, zero, zero}, zero};
    while (true) {
        const auto counted = hn::RebindMask(d, hn::Gt(left, hn::Set(di, -1)));
        if (hn::AllFalse(d, counted)) return sum;
        const auto whole_int = hn::Gt(left, hn::Zero(di));
        // The segment goes on to the end of this interval.
        const auto whole = hn::RebindMask(d, whole_int);
        const Ints end = hn::Min(hn::Add(interval, to_end), most);
        const Floats next_scalar = hn::IfThenElse(whole, look_up<kind>(transfer.end, end), back);
        const Floats next_share =
            hn::IfThenElse(whole, end_share, share_of_interval<kind>(transfer, interval, back));
        const Floats length = hn::IfThenElse(
            one_piece, world_length, hn::Mul(per_scalar, hn::Abs(hn::Sub(next_scalar, scalar))));
        const Floats p = hn::Mul(optics_at<kind>(transfer, 3, interval, share), length),
                     q = hn::Mul(optics_at<kind>(transfer, 3, interval, next_share), length);
        const Floats depth =
            hn::IfThenElseZero(counted, hn::Add(hn::Mul(half, p), hn::Mul(half, q)));
        sum.depth = hn::Add(sum.depth, depth);
        if (colored) {
            const Floats opacity = opacity_from_depth(d, depth);
            const Floats weight = hn::IfThenElseZero(counted, piece_front_weight(d, p, q));
            const Floats rest = hn::Max(hn::Sub(opacity, weight), zero);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const Floats near = optics_at<kind>(transfer, channel, interval, share),
                             far = optics_at<kind>(transfer, channel, interval, next_share);
                const Floats piece = hn::Add(hn::Mul(weight, near), hn::Mul(rest, far));
                sum.color[channel] = mul_add(transmittance, piece, sum.color[channel]);
            }
            transmittance = hn::Mul(transmittance, hn::Sub(one, opacity));
        }
        scalar = next_scalar;
        share = hn::Sub(one, end_share);
        interval = hn::Add(interval, hn::IfThenElseZero(whole_int, step));
        left = hn::Sub(left, one_int);
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
