// SPDX-License-Identifier: Apache-2.0
// Segments that cross points of the transfer function, or that are too deep for one rule, cut into
// pieces (docs/numerics.md, section 9.3).
//
//   t = 0, in the interval on the side to which the scalar s (9.1) goes
//   while t < 1 and what is behind can be seen:
//       end = the next place at which s turns, or 1
//       k   = the point of the transfer function at which s leaves the interval on its way to `end`
//       to  = if k lies before s(end): where s is k (9.6); else `end`
//       shorten the piece t .. to until its depth (9.2) is at most largest_piece_depth, and until
//           light bends little enough in it (section 10.4)
//       composite the piece's colour (9.3) and opacity behind what is there
//       t = to; behind k in the next interval
//
// Vectors have a segment in each lane. Segments have different numbers of pieces, so each round
// takes one piece of all of them, and packs those that go on anew.
#if defined(LAMINA_SLICING_CPU_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_CUT_INL_H_
#undef LAMINA_SLICING_CPU_CUT_INL_H_
#else
#define LAMINA_SLICING_CPU_CUT_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "simd/columns-inl.h"
#include "slicing/cpu_light-inl.h"
#include "slicing/cpu_optics-inl.h"
#include "slicing/cpu_walk-inl.h"

LAMINA_SIMD_BEGIN

// A vector of segments to cut.
struct CutSegment {
    CubicLanes scalar;
    Float length;
    Int number;  // in CellSegments
};
struct LitCutSegment : CutSegment {
    Float longest;  // share of the segment that a piece may have
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

    // Sets colour, opacity and depth of the segments that were added. `light`: of lit ones alone.
    template <Lookup kind, bool curved>
    void run(const TileTransfer& transfer, const TileLight* light, bool colored,
             CellSegments& all) {
        light_ = light;
        run_round<kind, curved, true>(transfer, colored, all);
        while (count_ > 0) run_round<kind, curved, false>(transfer, colored, all);
    }

  private:
    // Nothing behind this transmittance can be seen.
    static constexpr float least_transmittance = 1e-9f;
    // A piece this short has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;
    // Vectors side by side, because each waits for its own results.
    static constexpr std::size_t vectors = 2;

    // How far segments are done, and what is composited of them.
    struct Progress {
        Float turns[2];  // where the scalar turns
        Float at, scalar;
        Int interval;
        Float color[3], opacity, depth, transmittance;
    };
    struct Lanes {
        Segment segment;
        Progress done;
    };

    // The way to the next turn of each segment, as far as it stays in one interval.
    template <bool curved>
    struct Stretch {
        IntervalLanes<curved> interval;
        Float end, at_end, knot;
        FloatMask rising, crosses;
        RootLanes root;
    };

    // Composites the next piece of each segment.
    template <Lookup kind, bool curved, bool first>
    void run_round(const TileTransfer& transfer, bool colored, CellSegments& all) {
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

    // The lanes outside `members` have any values that are places and intervals, too; what is
    // computed of them is not used.
    LAMINA_INLINE Segment load(std::size_t from, FloatMask members) const {
        Segment segment = segments_.load(from);
        for (Float& c : segment.scalar.c) c = zero_unless(members, c);
        segment.length = zero_unless(members, segment.length);
        segment.number = zero_unless(members, segment.number);
        return segment;
    }

    // Begins at the front. At an end of an interval segments begin on the side to which they go.
    template <Lookup kind>
    static LAMINA_INLINE Progress begin(const TileTransfer& transfer, const Segment& segment) {
        const Turns turns = turns_of(segment.scalar);
        const Float start = segment.scalar.c[0];
        const FloatMask falling = segment.scalar.at(turns.first) < start;
        const Int interval = find_interval<kind>(transfer, clamp01(start));
        const FloatMask at_end = look_up<kind>(transfer.end, interval) == start;
        const FloatMask below = falling & at_end & (interval > 0);
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

    // Keeps the `members` for the next round, behind those that were kept before: never beyond what
    // was loaded.
    LAMINA_INLINE void keep(const Lanes& lanes, FloatMask members) {
        if (none_of(members)) return;
        progress_.store_members(lanes.done, members, count_);
        add(lanes.segment, members);
    }

    static void finish(const Lanes& lanes, FloatMask members, CellSegments& all) {
        alignas(64) float color[3][most_lanes], opacity[most_lanes], depth[most_lanes];
        alignas(64) std::int32_t number[most_lanes];
        for (std::size_t i = 0; i < 3; ++i) store(lanes.done.color[i], color[i]);
        store(lanes.done.opacity, opacity);
        store(lanes.done.depth, depth);
        store(lanes.segment.number, number);
        for_each_lane(bits_of(members), [&](std::size_t lane) {
            const auto to = static_cast<std::size_t>(number[lane]);
            for (std::size_t i = 0; i < 3; ++i) all.color[i][to] = color[i][lane];
            all.opacity[to] = opacity[lane];
            all.depth[to] = depth[lane];
        });
    }

    // Finds the lanes that have reached the end.
    template <Lookup kind, bool curved>
    LAMINA_INLINE void add_pieces(const TileTransfer& transfer, bool colored, std::size_t used,
                                  Lanes (&lanes)[vectors], FloatMask (&ended)[vectors]) {
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
    static LAMINA_INLINE Stretch<curved> next_stretch(const TileTransfer& transfer,
                                                      const Lanes& lanes) {
        const auto& [segment, done] = lanes;
        Stretch<curved> next;
        next.end = select(done.at < done.turns[0], done.turns[0],
                          select(done.at < done.turns[1], done.turns[1], 1));
        next.at_end = segment.scalar.at(next.end);
        next.rising = next.at_end >= done.scalar;
        next.interval = interval_lanes<kind, curved>(transfer, done.interval);
        const FloatMask lowest = done.interval == 0;
        const Float left_end = select(lowest, Float(-3e38f), next.interval.left_end);
        next.knot = select(next.rising, next.interval.right_end, left_end);
        next.crosses = (next.rising & (next.knot < next.at_end)) |
                       without(next.knot > next.at_end, next.rising);
        next.root.begin(next.knot, done.at, next.end, done.scalar, next.at_end, next.crosses);
        return next;
    }

    // Returns the lanes that have reached the end.
    template <bool curved>
    LAMINA_INLINE FloatMask add_piece(bool colored, const Stretch<curved>& stretch,
                                      Lanes& lanes) const {
        auto& [segment, done] = lanes;
        const Float to = select(stretch.crosses, stretch.root.t, stretch.end);
        const Float at_to = select(stretch.crosses, stretch.knot, stretch.at_end);
        Float extent = max(to - done.at, 0), at_back = at_to;
        FloatMask whole(true);
        if constexpr (lit) {
            whole = extent <= segment.longest;
            extent = min(extent, segment.longest);
            at_back = select(whole, at_to, segment.scalar.at(done.at + extent));
        }
        PieceOptics<curved> piece(stretch.interval,
                                  share_of_piece(stretch.interval, lanes, extent, at_back),
                                  segment.length * extent);
        whole = whole & shorten(stretch.interval, segment.length, piece, extent);
        if (!lit || !colored) {
            composite(stretch.interval, piece, colored, done);
        } else if constexpr (lit) {
            const FloatMask again = composite_lit(stretch.interval, piece, extent, lanes);
            segment.longest = select(again, 0.5f * extent, max(segment.longest, 2 * extent));
            // These stay where they are.
            whole = without(whole, again);
            extent = zero_unless(!again, extent);
        }

        const Float shortened = max(done.at + extent, done.at + 6e-8f);
        done.at = select(whole, to, shortened);
        done.scalar = select(whole, at_to, segment.scalar.at(done.at));
        const Int next = select(stretch.rising, done.interval + 1, done.interval - 1);
        done.interval = select(whole & stretch.crosses, next, done.interval);
        return (done.at >= 1) | (done.transmittance < least_transmittance);
    }

    // The place in the interval along the piece of `extent` from where the segments are, up to
    // where the scalar is `at_to`.
    template <bool curved>
    static LAMINA_INLINE CubicLanes share_of_piece(const IntervalLanes<curved>& interval,
                                                   const Lanes& lanes, Float extent, Float at_to) {
        const auto& [segment, done] = lanes;
        const CubicLanes& cubic = segment.scalar;
        CubicLanes piece;
        piece.c[0] = done.scalar;
        piece.c[2] = (cubic.c[2] + 3 * cubic.c[3] * done.at) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (at_to - done.scalar) - (piece.c[2] + piece.c[3]);
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
            // Optical depth grows at least with the first power of the extent from where it is 0;
            // a root does not overshoot where it grows with the second.
            const Float least = shortest / max(extent, shortest);
            Float share = min(sqrt(0.7f / max(depth, 1e-3f)), 0.5f);
            share = select(deep, max(share, min(least, 0.5f)), 1);
            extent *= share;
            Float power = share;
            for (std::size_t i = 1; i < 4; ++i) {
                piece.share.c[i] *= power;
                power *= share;
            }
            piece = PieceOptics<curved>(interval, piece.share, length * extent);
        }
    }

    // The share of the interval's change of colour that is seen of a piece. A piece of the least
    // extent may be too deep even so: its colour hardly changes.
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
        // Summed up by itself, so that pieces of small opacity keep their digits.
        done.opacity += weight;
        if (!colored) return;
        const Float share = transmittance * seen_of(piece, depth, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel)
            done.color[channel] += interval.color(channel, weight, share);
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
        const Float share = seen_of(piece, depth, opacity);
        Float color[3];
        for (std::size_t channel = 0; channel < 3; ++channel)
            color[channel] = interval.color(channel, opacity, share);
        const Float bend =
            add_light(*light_, segment.gradient,
                      LitPiece<curved>{piece, interval, done.at, extent, depth, opacity}, color);
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

    const TileLight* light_ = nullptr;
    std::size_t count_ = 0;
    Columns<Segment, CellSegments::capacity> segments_;
    Columns<Progress, CellSegments::capacity> progress_;  // from the second round on
};

LAMINA_SIMD_END

#endif
