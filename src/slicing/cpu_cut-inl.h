// SPDX-License-Identifier: Apache-2.0
// Cuts segments into pieces if they cross points of the transfer function or are too deep for one
// rule, and composites the pieces (docs/numerics.md, section 9.3; numbers in brackets are equations
// there). A knot is a point of the transfer function; it ends an interval.
//
//   t = 0, in the interval on the side to which the scalar s (9.1) goes
//   while t < 1 and something behind can be visible:
//       t_end = the next place at which s turns, or 1
//       knot  = the end of the interval that s reaches on its way to s(t_end)
//       t_to  = if the knot lies before s(t_end): the t at which s is there (9.6); else t_end
//       shorten the piece t .. t_to until its depth (9.2) is at most largest_piece_depth, and until
//           light bends little enough in it (section 10.4)
//       composite the piece's colour (9.3) and opacity behind those before
//       t = t_to; behind the knot in the next interval
//
// Each lane holds a segment. As numbers of pieces differ, each iteration composites one piece of
// every segment, and packs the segments that have more pieces into full vectors.
#if defined(LAMINA_SLICING_CPU_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_CUT_INL_H_
#undef LAMINA_SLICING_CPU_CUT_INL_H_
#else
#define LAMINA_SLICING_CPU_CUT_INL_H_
#endif

#include "slicing/cpu_light-inl.h"

LAMINA_SIMD_BEGIN

// A vector of segments to cut: scalar (9.1), world length, and number in CellSegments.
struct CutSegment {
    CubicLanes scalar;
    Float length;
    Int place;
};
struct LitCutSegment : CutSegment {
    Float longest;  // max extent of the next piece in t, 0 .. 1; add_piece() adapts it
    GradientLanes gradient;
};

template <bool lit>
class CutSegments {
  public:
    using Segment = std::conditional_t<lit, LitCutSegment, CutSegment>;

    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }

    LAMINA_INLINE void add(const Segment& segment, FloatMask members) {
        segments_.store_members(segment, members, count_);
        count_ += count_of(members);
    }

    // Sets colour, opacity and depth of the added segments in `all`. `light`: for lit ones alone.
    template <Lookup kind, bool curved>
    void run(const CpuTransfer& transfer, const CpuLight* light, bool colored, CellSegments& all) {
        light_ = light;
        composite_next_pieces<kind, curved, true>(transfer, colored, all);
        while (count_ > 0) composite_next_pieces<kind, curved, false>(transfer, colored, all);
    }

  private:
    // Transmittance behind which nothing is visible.
    static constexpr float least_transmittance = 1e-9f;
    // Extent (in t) below which pieces are not shortened: they have one colour, however deep.
    static constexpr float shortest = 1e-6f;
    // Vectors that are computed side by side, to hide the latency of chains of operations.
    static constexpr std::size_t vectors = 2;

    // How far a segment is done: t, the scalar and interval there, the composite in front of it.
    struct Progress {
        Float turns[2];  // the t at which the scalar turns
        Float t, s;
        Int interval;
        Float color[3], opacity, depth, transmittance;
    };
    struct Lanes {
        Segment segment;
        RangeLanes limits;  // of the scalar
        Progress done;
    };

    // The piece of a segment from its present place to the next turn of its scalar, at t_end. If
    // the scalar `crosses` the knot before that, the segment leaves the interval at `root`.
    template <bool curved>
    struct NextPiece {
        IntervalLanes<curved> interval;
        Float t_end, s_end, knot;
        FloatMask rising, crosses;
        RootLanes root;
    };

    template <Lookup kind, bool curved, bool first>
    void composite_next_pieces(const CpuTransfer& transfer, bool colored, CellSegments& all) {
        constexpr std::size_t step = Float::lanes;
        const std::size_t count = count_;
        count_ = 0;
        for (std::size_t from = 0; from < count; from += vectors * step) {
            const std::size_t used = from + step < count ? vectors : 1;
            Lanes lanes[vectors];
            FloatMask members[vectors], ended[vectors];
            for (std::size_t i = 0; i < used; ++i) {
                const std::size_t place = from + i * step;
                members[i] = first_lanes<FloatMask>(count - place);
                lanes[i].segment = load(place, members[i]);
                lanes[i].limits = limits_at(transfer, lanes[i].segment.place, all);
                lanes[i].done = first ? begin<kind>(transfer, lanes[i]) : resume(place, members[i]);
            }
            add_pieces<kind, curved>(transfer, colored, used, lanes, ended);
            for (std::size_t i = 0; i < used; ++i) {
                finish(lanes[i], members[i] & ended[i], all);
                keep(lanes[i], without(members[i], ended[i]));
            }
        }
    }

    // Loads segments; lanes outside `members` become 0, so that they hold valid numbers and places.
    LAMINA_INLINE Segment load(std::size_t from, FloatMask members) const {
        Segment segment = segments_.load(from);
        for (Float& c : segment.scalar.c) c = zero_unless(members, c);
        segment.length = zero_unless(members, segment.length);
        segment.place = zero_unless(members, segment.place);
        return segment;
    }

    // Returns limits_of() the cells if the transfer function has steps.
    static LAMINA_INLINE RangeLanes limits_at(const CpuTransfer& transfer, Int place,
                                              const CellSegments& all) {
        if (!transfer.steps) return {-beyond_all_scalars, beyond_all_scalars};
        return {gather(all.limits[0], place), gather(all.limits[1], place)};
    }

    // Returns the beginning, t = 0. A scalar on a knot is in the interval to which it goes.
    template <Lookup kind>
    static LAMINA_INLINE Progress begin(const CpuTransfer& transfer, const Lanes& lanes) {
        const Segment& segment = lanes.segment;
        const Turns turns = turns_of(segment.scalar);
        const Float start = lanes.limits.clamped(segment.scalar.c[0]);
        const FloatMask falling = lanes.limits.clamped(segment.scalar.at(turns.first)) < start;
        const Int interval = find_interval<kind>(transfer, clamp01(start));
        const FloatMask on_knot = look_up<kind>(transfer.left_end, interval) == start;
        const FloatMask below = falling & on_knot & (interval > 0);
        return {{turns.first, turns.second},
                0,
                start,
                interval - zero_unless(below, Int(1)),
                {0, 0, 0},
                0,
                0,
                1};
    }

    LAMINA_INLINE Progress resume(std::size_t from, FloatMask members) const {
        Progress done = progress_.load(from);
        done.interval = zero_unless(members, done.interval);
        return done;
    }

    // Stores `members` for the next iteration behind the others; overwrites only what was loaded.
    LAMINA_INLINE void keep(const Lanes& lanes, FloatMask members) {
        if (none_of(members)) return;
        progress_.store_members(lanes.done, members, count_);
        add(lanes.segment, members);
    }

    static void finish(const Lanes& lanes, FloatMask members, CellSegments& all) {
        alignas(64) float color[3][most_lanes], opacity[most_lanes], depth[most_lanes];
        alignas(64) std::int32_t place[most_lanes];
        for (std::size_t i = 0; i < 3; ++i) store(lanes.done.color[i], color[i]);
        store(lanes.done.opacity, opacity);
        store(lanes.done.depth, depth);
        store(lanes.segment.place, place);
        for_each_lane(bits_of(members), [&](std::size_t lane) {
            const auto to = static_cast<std::size_t>(place[lane]);
            for (std::size_t i = 0; i < 3; ++i) all.color[i][to] = color[i][lane];
            all.opacity[to] = opacity[lane];
            all.depth[to] = depth[lane];
        });
    }

    // Composites the next piece of each segment. Sets `ended` to the lanes whose segment is done.
    template <Lookup kind, bool curved>
    LAMINA_INLINE void add_pieces(const CpuTransfer& transfer, bool colored, std::size_t used,
                                  Lanes (&lanes)[vectors], FloatMask (&ended)[vectors]) {
        // Two steps (of third order) find most roots; to ask after each step would cost more.
        constexpr int usual_steps = 2, most_steps = 30;
        static_assert(vectors == 2);
        NextPiece<curved> next_pieces[vectors];
        for (std::size_t i = 0; i < used; ++i)
            next_pieces[i] = find_next_piece<kind, curved>(transfer, lanes[i]);
        const auto found = [&] LAMINA_LAMBDA {
            return next_pieces[0].root.found() && (used == 1 || next_pieces[1].root.found());
        };
        for (int i = 0; i < usual_steps || (i < most_steps && !found()); ++i) {
            for (std::size_t j = 0; j < used; ++j)
                next_pieces[j].root.refine(lanes[j].segment.scalar);
        }
        for (std::size_t i = 0; i < used; ++i)
            ended[i] = add_piece(colored, next_pieces[i], lanes[i]);
    }

    template <Lookup kind, bool curved>
    static LAMINA_INLINE NextPiece<curved> find_next_piece(const CpuTransfer& transfer,
                                                           const Lanes& lanes) {
        const auto& [segment, limits, done] = lanes;
        NextPiece<curved> next;
        next.t_end = select(done.t < done.turns[0], done.turns[0],
                            select(done.t < done.turns[1], done.turns[1], 1));
        next.s_end = limits.clamped(segment.scalar.at(next.t_end));
        next.rising = next.s_end >= done.s;
        next.interval = interval_lanes<kind, curved>(transfer, done.interval);
        const FloatMask lowest = done.interval == 0;
        const Float left_end = select(lowest, Float(-3e38f), next.interval.left_end);
        next.knot = select(next.rising, next.interval.right_end, left_end);
        next.crosses =
            (next.rising & (next.knot < next.s_end)) | without(next.knot > next.s_end, next.rising);
        next.root.begin(next.knot, done.t, next.t_end, done.s, next.s_end, next.crosses);
        return next;
    }

    // Composites a piece of each segment and moves behind it. Returns the lanes that are done.
    template <bool curved>
    LAMINA_INLINE FloatMask add_piece(bool colored, const NextPiece<curved>& next_piece,
                                      Lanes& lanes) const {
        auto& [segment, limits, done] = lanes;
        const Float t_to = select(next_piece.crosses, next_piece.root.t, next_piece.t_end);
        const Float s_to = select(next_piece.crosses, next_piece.knot, next_piece.s_end);
        Float extent = max(t_to - done.t, 0), s_back = s_to;
        FloatMask whole(true);
        if constexpr (lit) {
            whole = extent <= segment.longest;
            extent = min(extent, segment.longest);
            s_back = select(whole, s_to, limits.clamped(segment.scalar.at(done.t + extent)));
        }
        PieceOptics<curved> piece(next_piece.interval,
                                  share_of_piece(next_piece.interval, lanes, extent, s_back),
                                  segment.length * extent);
        whole = whole & shorten(next_piece.interval, segment.length, piece, extent);
        if (!lit || !colored) {
            composite(next_piece.interval, piece, colored, done);
        } else if constexpr (lit) {
            const FloatMask again = composite_lit(next_piece.interval, piece, extent, lanes);
            segment.longest = select(again, 0.5f * extent, max(segment.longest, 2 * extent));
            // Nothing was added in lanes `again`: the next iteration tries a piece half as long.
            whole = without(whole, again);
            extent = zero_unless(!again, extent);
        }

        // t grows by at least 2^-24, the spacing of floats below 1: every iteration makes progress.
        const Float shortened = max(done.t + extent, done.t + 6e-8f);
        done.t = select(whole, t_to, shortened);
        done.s = select(whole, s_to, limits.clamped(segment.scalar.at(done.t)));
        const Int next = select(next_piece.rising, done.interval + 1, done.interval - 1);
        done.interval = select(whole & next_piece.crosses, next, done.interval);
        return (done.t >= 1) | (done.transmittance < least_transmittance);
    }

    // Returns the share of the interval along a piece as a cubic of 0 .. 1, with c[1] such that the
    // scalar ends exactly at `s_to`, and pieces meet on the knot.
    template <bool curved>
    static LAMINA_INLINE CubicLanes share_of_piece(const IntervalLanes<curved>& interval,
                                                   const Lanes& lanes, Float extent, Float s_to) {
        const Progress& done = lanes.done;
        const CubicLanes& cubic = lanes.segment.scalar;
        CubicLanes piece;
        piece.c[0] = done.s;
        piece.c[2] = (cubic.c[2] + 3 * cubic.c[3] * done.t) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (s_to - done.s) - (piece.c[2] + piece.c[3]);
        return interval.share_along(piece);
    }

    // Moves the backs of too deep pieces forward. Returns the lanes that were not shortened.
    template <bool curved>
    static LAMINA_INLINE FloatMask shorten(const IntervalLanes<curved>& interval, Float length,
                                           PieceOptics<curved>& piece, Float& extent) {
        FloatMask whole(true);
        while (true) {
            const Float depth = piece.depth();
            const FloatMask deep = (depth > largest_piece_depth) & (extent > shortest);
            if (none_of(deep)) return whole;
            whole = without(whole, deep);
            // If depth grows with the power 1 to 2 of the extent, the root leaves a depth of .7 or
            // more; but at least half of the extent is cut off. This may have to be repeated.
            const Float least = shortest / max(extent, shortest);
            Float factor = min(sqrt(0.7f / max(depth, 1e-3f)), 0.5f);
            factor = select(deep, max(factor, min(least, 0.5f)), 1);
            extent *= factor;
            Float power = factor;
            for (std::size_t i = 1; i < 4; ++i) {
                piece.share.c[i] *= power;
                power *= factor;
            }
            piece = PieceOptics<curved>(interval, piece.share, length * extent);
        }
    }

    // Returns Q of (9.4). Pieces of extent `shortest` may be too deep, but hardly change colour.
    template <bool curved>
    static LAMINA_INLINE Float seen_of(const PieceOptics<curved>& piece, Float depth,
                                       Float opacity) {
        return select(depth > largest_piece_depth, opacity * piece.share.c[0],
                      seen_share<4>(piece, depth, opacity));
    }

    template <bool curved>
    static LAMINA_INLINE void composite(const IntervalLanes<curved>& interval,
                                        const PieceOptics<curved>& piece, bool colored,
                                        Progress& done) {
        const Float depth = piece.depth();
        const Float opacity = opacity_from_depth(depth);
        const Float transmittance = done.transmittance, weight = transmittance * opacity;
        done.depth += depth;
        done.transmittance = transmittance - weight;
        // Opacity is summed, and is not 1 - transmittance: faint pieces keep their digits.
        done.opacity += weight;
        if (!colored) return;
        const Float seen = transmittance * seen_of(piece, depth, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel)
            done.color[channel] += interval.color(channel, weight, seen);
    }

    // Composites lit pieces. Returns the lanes whose light bends too much; they stay unchanged.
    template <bool curved>
    LAMINA_INLINE FloatMask composite_lit(const IntervalLanes<curved>& interval,
                                          const PieceOptics<curved>& piece, Float extent,
                                          Lanes& lanes) const {
        const Segment& segment = lanes.segment;
        Progress& done = lanes.done;
        const Float depth = piece.depth();
        const Float opacity = opacity_from_depth(depth);
        const Float seen = seen_of(piece, depth, opacity);
        Float color[3];
        for (std::size_t channel = 0; channel < 3; ++channel)
            color[channel] = interval.color(channel, opacity, seen);
        const Float bend =
            add_light(*light_, segment.gradient,
                      LitPiece<curved>{piece, interval, done.t, extent, depth, opacity}, color);
        const Float transmittance = done.transmittance, weight = transmittance * opacity;
        const FloatMask again = (extent > shortest_lit_piece) & bends(*light_, bend, weight);
        const FloatMask added = !again;
        done.depth += zero_unless(added, depth);
        done.transmittance = transmittance - zero_unless(added, weight);
        done.opacity += zero_unless(added, weight);
        for (std::size_t channel = 0; channel < 3; ++channel)
            done.color[channel] += zero_unless(added, transmittance * color[channel]);
        return again;
    }

    const CpuLight* light_ = nullptr;
    std::size_t count_ = 0;
    Columns<Segment, CellSegments::capacity> segments_;
    Columns<Progress, CellSegments::capacity> progress_;  // set from the second iteration on
};

LAMINA_SIMD_END

#endif
