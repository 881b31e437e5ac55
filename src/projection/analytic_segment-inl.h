// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/analytic_segment.glsl. It integrates segments on which the scalar
// is linear exactly, interval by interval of the transfer function.
#if defined(LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#undef LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#else
#define LAMINA_PROJECTION_ANALYTIC_SEGMENT_INL_H_
#endif

#include "executors/cpu_transfer-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

// The associated colour and the optical depth of a segment.
struct AnalyticSum {
    Float color[3];
    Float depth;
};

// The piece of a segment in one interval of the transfer function.
struct AnalyticPiece {
    const TileTransfer& transfer;
    FloatMask counted;  // lanes that have such a piece; the depth of others is 0
    FloatMask last;     // it ends at the end of the segment
    Int interval;
    Float share, next_share;    // of the interval, at the front and at the back
    Float scalar, next_scalar;  // at the front and at the back
    Float p, q, depth;          // extinction at the front and at the back times the piece's length;
                                // optical depth

    LAMINA_INLINE Float near(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, share);
    }
    LAMINA_INLINE Float far(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, next_share);
    }
};

// The weights of an AnalyticPiece's ends in its colour. They add up to its opacity.
struct EndWeights {
    Float near, far;
};

// Calls visit(AnalyticPiece) for the pieces of segments, front to back. Scalars may lie outside [0,
// 1], beyond which the first and the last interval go on.
template <class Visit>
LAMINA_INLINE void for_each_analytic_piece(const TileTransfer& transfer, Float front, Float back,
                                           Float world_length, const Visit& visit) {
    constexpr Lookup kind = Lookup::gather;
    Int interval = find_interval<kind>(transfer, clamp01(front));
    const Int last = find_interval<kind>(transfer, clamp01(back));
    const FloatMask rising = !(interval > last);
    const FloatMask one_piece = interval == last;
    // The share of an interval at which the ray leaves it.
    const Float end_share = zero_unless(rising, Float(1));
    const Int to_end = zero_unless(rising, Int(1));
    const Int step = to_end + to_end - 1;
    const Float per_scalar = world_length / abs(back - front);
    Int left = abs(last - interval);

    Float scalar = front, share = share_of_interval<kind>(transfer, interval, front);
    while (true) {
        const FloatMask counted = left > -1;
        if (none_of(counted)) return;
        // The segment goes on to the end of this interval.
        const FloatMask whole = left > 0;
        const Int end = min(interval + to_end, transfer.intervals - 1);
        const Float next_scalar = select(whole, look_up<kind>(transfer.left_end, end), back);
        const Float next_share =
            select(whole, end_share, share_of_interval<kind>(transfer, interval, back));
        const Float length =
            select(one_piece, world_length, per_scalar * abs(next_scalar - scalar));
        const Float p = optics_at<kind>(transfer, 3, interval, share) * length,
                    q = optics_at<kind>(transfer, 3, interval, next_share) * length;
        const Float depth = zero_unless(counted, 0.5f * p + 0.5f * q);
        visit(AnalyticPiece{transfer, counted, !whole, interval, share, next_share, scalar,
                            next_scalar, p, q, depth});
        scalar = next_scalar;
        share = 1 - end_share;
        interval += zero_unless(whole, step);
        left -= 1;
    }
}

LAMINA_INLINE EndWeights end_weights(const AnalyticPiece& piece, Float opacity) {
    const Float near = zero_unless(piece.counted, piece_front_weight(piece.p, piece.q));
    return {near, max(opacity - near, 0)};
}

// `colored`: otherwise only the optical depth is computed.
LAMINA_INLINE AnalyticSum integrate_analytic(const TileTransfer& transfer, bool colored,
                                             Float front, Float back, Float world_length) {
    Float transmittance(1);
    AnalyticSum sum{{0, 0, 0}, 0};
    const auto add = [&](const AnalyticPiece& piece) LAMINA_LAMBDA {
        sum.depth += piece.depth;
        if (!colored) return;
        const Float opacity = opacity_from_depth(piece.depth);
        const EndWeights weights = end_weights(piece, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Float shown =
                weights.near * piece.near(channel) + weights.far * piece.far(channel);
            sum.color[channel] += transmittance * shown;
        }
        transmittance *= 1 - opacity;
    };
    for_each_analytic_piece(transfer, front, back, world_length, add);
    return sum;
}

LAMINA_SIMD_END

#endif
