// SPDX-License-Identifier: Apache-2.0
// Segments that cross points of the transfer function, or that are too deep for one rule, cut into
// pieces (docs/numerics.md, section 9.3; numbers in brackets are equations there). A knot is a
// point of the transfer function; it ends an interval.
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
// Vectors have a segment in each lane. Segments have different numbers of pieces, so each round
// takes one piece of all of them, and packs those that go on anew.
#if defined(LAMINA_SLICING_CPU_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_CUT_INL_H_
#undef LAMINA_SLICING_CPU_CUT_INL_H_
#else
#define LAMINA_SLICING_CPU_CUT_INL_H_
#endif

#include "slicing/cpu_light-inl.h"

LAMINA_SIMD_BEGIN

// A vector of segments to cut.
struct CutSegment {
    CubicLanes scalar;
    Float length;
    Int place;  // in CellSegments
};
struct LitCutSegment : CutSegment {
    Float longest;  // largest extent of a piece; a first guess, which composite_lit() corrects
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

    // Sets colour, opacity and depth of the segments that were added. `light`: for lit ones alone.
    template <Lookup kind, bool curved>
    void run(const CpuTransfer& transfer, const CpuLight* light, bool colored, CellSegments& all) {
        light_ = light;
        run_round<kind, curved, true>(transfer, colored, all);
        while (count_ > 0) run_round<kind, curved, false>(transfer, colored, all);
    }

  private:
    // Transmittance behind which nothing is visible.
    static constexpr float least_transmittance = 1e-9f;
    // Extent, a difference of t, at which a piece has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;
    // Number of vectors that are computed side by side, to hide the latency of their chains of
    // operations.
    static constexpr std::size_t vectors = 2;

    // The place that a segment has reached, and the composite of its pieces up to there.
    struct Progress {
        Float turns[2];  // the t at which the scalar turns
        Float t, s;
        Int interval;
        Float color[3], opacity, depth, transmittance;
    };
    struct Lanes {
        Segment segment;
        Progress done;
    };

    // The part of a segment up to the next turn of its scalar; if the scalar `crosses` the knot in
    // this part, the segment leaves the interval there.
    template <bool curved>
    struct Stretch {
        IntervalLanes<curved> interval;
        Float t_end, s_end, knot;
        FloatMask rising, crosses;
        RootLanes root;
    };

    // Composites the next piece of each segment.
    template <Lookup kind, bool curved, bool first>
    void run_round(const CpuTransfer& transfer, bool colored, CellSegments& all) {
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
                lanes[i].done =
                    first ? begin<kind>(transfer, lanes[i].segment) : resume(place, members[i]);
            }
            add_pieces<kind, curved>(transfer, colored, used, lanes, ended);
            for (std::size_t i = 0; i < used; ++i) {
                finish(lanes[i], members[i] & ended[i], all);
                keep(lanes[i], without(members[i], ended[i]));
            }
        }
    }

    // Zeroes the lanes outside `members`, so that they hold numbers and places.
    LAMINA_INLINE Segment load(std::size_t from, FloatMask members) const {
        Segment segment = segments_.load(from);
        for (Float& c : segment.scalar.c) c = zero_unless(members, c);
        segment.length = zero_unless(members, segment.length);
        segment.place = zero_unless(members, segment.place);
        return segment;
    }

    // Begins at the front. On a knot a segment begins in the interval to which its scalar goes.
    template <Lookup kind>
    static LAMINA_INLINE Progress begin(const CpuTransfer& transfer, const Segment& segment) {
        const Turns turns = turns_of(segment.scalar);
        const Float start = segment.scalar.c[0];
        const FloatMask falling = segment.scalar.at(turns.first) < start;
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

    // Packs the `members` for the next round, behind those that were kept before: it overwrites
    // only what has been loaded.
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

    // Adds a piece to each segment; `ended` gets the lanes that are done.
    template <Lookup kind, bool curved>
    LAMINA_INLINE void add_pieces(const CpuTransfer& transfer, bool colored, std::size_t used,
                                  Lanes (&lanes)[vectors], FloatMask (&ended)[vectors]) {
        // Most roots are found in two steps of the third order; asking earlier costs more.
        constexpr int usual_steps = 2, most_steps = 30;
        static_assert(vectors == 2);
        Stretch<curved> stretches[vectors];
        for (std::size_t i = 0; i < used; ++i)
            stretches[i] = next_stretch<kind, curved>(transfer, lanes[i]);
        const auto found = [&] LAMINA_LAMBDA {
            return stretches[0].root.found() && (used == 1 || stretches[1].root.found());
        };
        for (int i = 0; i < usual_steps || (i < most_steps && !found()); ++i) {
            for (std::size_t j = 0; j < used; ++j)
                stretches[j].root.refine(lanes[j].segment.scalar);
        }
        for (std::size_t i = 0; i < used; ++i)
            ended[i] = add_piece(colored, stretches[i], lanes[i]);
    }

    template <Lookup kind, bool curved>
    static LAMINA_INLINE Stretch<curved> next_stretch(const CpuTransfer& transfer,
                                                      const Lanes& lanes) {
        const auto& [segment, done] = lanes;
        Stretch<curved> next;
        next.t_end = select(done.t < done.turns[0], done.turns[0],
                            select(done.t < done.turns[1], done.turns[1], 1));
        next.s_end = segment.scalar.at(next.t_end);
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

    // Returns the lanes that are done. `extent`: that of the piece, whose world length is this
    // share of the segment's.
    template <bool curved>
    LAMINA_INLINE FloatMask add_piece(bool colored, const Stretch<curved>& stretch,
                                      Lanes& lanes) const {
        auto& [segment, done] = lanes;
        const Float t_to = select(stretch.crosses, stretch.root.t, stretch.t_end);
        const Float s_to = select(stretch.crosses, stretch.knot, stretch.s_end);
        Float extent = max(t_to - done.t, 0), s_back = s_to;
        FloatMask whole(true);
        if constexpr (lit) {
            whole = extent <= segment.longest;
            extent = min(extent, segment.longest);
            s_back = select(whole, s_to, segment.scalar.at(done.t + extent));
        }
        PieceOptics<curved> piece(stretch.interval,
                                  share_of_piece(stretch.interval, lanes, extent, s_back),
                                  segment.length * extent);
        whole = whole & shorten(stretch.interval, segment.length, piece, extent);
        if (!lit || !colored) {
            composite(stretch.interval, piece, colored, done);
        } else if constexpr (lit) {
            const FloatMask again = composite_lit(stretch.interval, piece, extent, lanes);
            segment.longest = select(again, 0.5f * extent, max(segment.longest, 2 * extent));
            // Nothing was added for these lanes: the next round tries shorter pieces.
            whole = without(whole, again);
            extent = zero_unless(!again, extent);
        }

        // At least one float (2^-24) further, so that every round makes progress.
        const Float shortened = max(done.t + extent, done.t + 6e-8f);
        done.t = select(whole, t_to, shortened);
        done.s = select(whole, s_to, segment.scalar.at(done.t));
        const Int next = select(stretch.rising, done.interval + 1, done.interval - 1);
        done.interval = select(whole & stretch.crosses, next, done.interval);
        return (done.t >= 1) | (done.transmittance < least_transmittance);
    }

    // Returns the place in the interval along the piece of `extent`: the scalar there, a cubic of 0
    // .. 1, rescaled. c[1] makes it end at `s_to` exactly, so that pieces meet on the knot.
    template <bool curved>
    static LAMINA_INLINE CubicLanes share_of_piece(const IntervalLanes<curved>& interval,
                                                   const Lanes& lanes, Float extent, Float s_to) {
        const auto& [segment, done] = lanes;
        const CubicLanes& cubic = segment.scalar;
        CubicLanes piece;
        piece.c[0] = done.s;
        piece.c[2] = (cubic.c[2] + 3 * cubic.c[3] * done.t) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (s_to - done.s) - (piece.c[2] + piece.c[3]);
        return interval.share_along(piece);
    }

    // Shortens pieces that are too deep, from their backs. Returns the lanes that stay whole.
    template <bool curved>
    static LAMINA_INLINE FloatMask shorten(const IntervalLanes<curved>& interval, Float length,
                                           PieceOptics<curved>& piece, Float& extent) {
        FloatMask whole(true);
        while (true) {
            const Float depth = piece.depth();
            const FloatMask deep = (depth > largest_piece_depth) & (extent > shortest);
            if (none_of(deep)) return whole;
            whole = without(whole, deep);
            // If depth grows with the power p = 1 .. 2 of the extent, this factor leaves at least a
            // depth of .7; it may have to be applied again.
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

    // Returns Q of (9.4). A piece of the least extent may still be too deep for the rule, but its
    // colour hardly changes.
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
        // Summed by itself, so that pieces of small opacity keep their digits.
        done.opacity += weight;
        if (!colored) return;
        const Float seen = transmittance * seen_of(piece, depth, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel)
            done.color[channel] += interval.color(channel, weight, seen);
    }

    // Composites lit pieces. Returns those that are left out, because their light bends too much
    // for one rule.
    template <bool curved>
    LAMINA_INLINE FloatMask composite_lit(const IntervalLanes<curved>& interval,
                                          const PieceOptics<curved>& piece, Float extent,
                                          Lanes& lanes) const {
        auto& [segment, done] = lanes;
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
    Columns<Progress, CellSegments::capacity> progress_;  // from the second round on
};

LAMINA_SIMD_END

#endif
