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

// The part of a segment in one interval of the transfer function.
struct AnalyticPiece {
    const TileTransfer& transfer;
    FloatMask counted;  // lanes that have such a part; the depth of others is 0
    FloatMask last;     // it ends where the segment does
    Ints interval;
    Floats share, next_share;    // of the interval, at the front and at the back
    Floats scalar, next_scalar;  // there
    Floats p, q, depth;          // extinction there times the part's length; optical depth

    HWY_INLINE Floats near(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, share);
    }
    HWY_INLINE Floats far(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, next_share);
    }
};

// The weights of an AnalyticPiece's ends in its colour. They add up to its opacity.
struct EndWeights {
    Floats near, far;
};

// Calls visit(AnalyticPiece) for the parts of segments, front to back. Scalars may lie outside
// [0, 1], where the first and the last interval go on.
template <class Visit>
HWY_INLINE void for_each_analytic_piece(const TileTransfer& transfer, Floats front, Floats back,
                                        Floats world_length, const Visit& visit) {
    constexpr Lookup kind = Lookup::gather;
    const FloatTag d;
    const IntTag di;
    const Floats one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    const Ints one_int = hn::Set(di, 1), most = hn::Set(di, transfer.intervals - 1);
    Ints interval = find_interval<kind>(transfer, clamp01(d, front));
    const Ints last = find_interval<kind>(transfer, clamp01(d, back));
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
    while (true) {
        const auto counted = hn::RebindMask(d, hn::Gt(left, hn::Set(di, -1)));
        if (hn::AllFalse(d, counted)) return;
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
        visit(AnalyticPiece{transfer, counted, hn::Not(whole), interval, share, next_share, scalar,
                            next_scalar, p, q, depth});
        scalar = next_scalar;
        share = hn::Sub(one, end_share);
        interval = hn::Add(interval, hn::IfThenElseZero(whole_int, step));
        left = hn::Sub(left, one_int);
    }
}

HWY_INLINE EndWeights end_weights(const AnalyticPiece& piece, Floats opacity) {
    const FloatTag d;
    const Floats near = hn::IfThenElseZero(piece.counted, piece_front_weight(d, piece.p, piece.q));
    return {near, hn::Max(hn::Sub(opacity, near), hn::Zero(d))};
}

// `colored`: otherwise only the optical depth is computed.
HWY_INLINE AnalyticSum integrate_analytic(const TileTransfer& transfer, bool colored, Floats front,
                                          Floats back, Floats world_length) {
    const FloatTag d;
    const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    Floats transmittance = one;
    AnalyticSum sum{{zero, zero, zero}, zero};
    const auto add = [&](const AnalyticPiece& piece) HWY_ATTR {
        sum.depth = hn::Add(sum.depth, piece.depth);
        if (!colored) return;
        const Floats opacity = opacity_from_depth(d, piece.depth);
        const EndWeights weights = end_weights(piece, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Floats shown = hn::Add(hn::Mul(weights.near, piece.near(channel)),
                                         hn::Mul(weights.far, piece.far(channel)));
            sum.color[channel] = mul_add(transmittance, shown, sum.color[channel]);
        }
        transmittance = hn::Mul(transmittance, hn::Sub(one, opacity));
    };
    for_each_analytic_piece(transfer, front, back, world_length, add);
    return sum;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
