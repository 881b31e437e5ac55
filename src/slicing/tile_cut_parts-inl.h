// SPDX-License-Identifier: Apache-2.0
// Parts of rays that cross points of the transfer function, or that are too deep for one rule. They
// are cut, and their pieces composited front to back. Parts need different numbers of steps: a lane
// that has finished one takes the next.
#if defined(LAMINA_SLICING_TILE_CUT_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#undef LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#else
#define LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_cell_optics-inl.h"
#include "slicing/tile_cell_parts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

class CutParts {
  public:
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    void add(std::size_t part) { waiting_[count_++] = static_cast<std::int32_t>(part); }

    // Sets colour, opacity and depth of the parts that were added.
    template <Lookup kind>
    void run(const TileTransfer& transfer, bool colored, CellParts& parts) {
        const std::size_t lanes = hn::Lanes(FloatTag());
        next_ = 0;
        busy_ = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) take(parts, lane);
        while (busy_ > 0) {
            const FloatMask done = step<kind>(transfer, colored);
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(FloatTag(), done, bits);
            for (unsigned set = bits[0] | static_cast<unsigned>(bits[1]) << 8; set != 0;
                 set &= set - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                if (part_[lane] < 0) continue;
                put(lane, parts);
                --busy_;
                take(parts, lane);
            }
        }
    }

  private:
    // What is behind this transmittance cannot be seen.
    static constexpr float least_transmittance = 1e-9f;
    // A part this short has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;

    void take(const CellParts& parts, std::size_t lane) {
        part_[lane] = -1;
        at_[lane] = 1;
        length_[lane] = 0;
        if (next_ == count_) return;
        const std::int32_t part = waiting_[next_++];
        const auto from = static_cast<std::size_t>(part);
        part_[lane] = part;
        ++busy_;
        for (std::size_t i = 0; i < 4; ++i) cubic_[i][lane] = parts.cubic[i][from];
        length_[lane] = parts.length[from];
        at_[lane] = 0;
        scalar_[lane] = parts.cubic[0][from];
        fresh_[lane] = 1;
        depth_[lane] = 0;
        transmittance_[lane] = 1;
        opacity_[lane] = 0;
        for (auto& channel : color_) channel[lane] = 0;
    }

    void put(std::size_t lane, CellParts& parts) const {
        const auto to = static_cast<std::size_t>(part_[lane]);
        parts.depth[to] = depth_[lane];
        parts.opacity[to] = opacity_[lane];
        for (std::size_t channel = 0; channel < 3; ++channel)
            parts.color[channel][to] = color_[channel][lane];
    }

    // The lanes that took a part since the last step: where it turns, and in which interval it
    // begins. At an end of an interval it begins on the side to which it goes.
    template <Lookup kind>
    HWY_INLINE void begin(const TileTransfer& transfer, const CubicLanes& cubic, Ints& interval) {
        const FloatTag d;
        const IntTag di;
        const FloatMask fresh = load_number(fresh_) > Number(0);
        if (hn::AllFalse(d, fresh)) return;
        const Turns turns = turns_of(cubic);
        store_number(select(fresh, turns.first, load_number(turns_[0])), turns_[0]);
        store_number(select(fresh, turns.second, load_number(turns_[1])), turns_[1]);
        const Number start = cubic.c[0];
        const FloatMask falling = cubic.at(turns.first) < start;
        Ints first = find_interval<kind>(transfer, clamp01(d, start.v));
        const FloatMask at_end = look_up<kind>(transfer.end, first) == start.v;
        const auto below = hn::And(hn::RebindMask(di, hn::And(falling, at_end)),
                                   hn::Gt(first, hn::Zero(di)));
        first = hn::Sub(first, hn::IfThenElseZero(below, hn::Set(di, 1)));
        interval = hn::IfThenElse(hn::RebindMask(di, fresh), first, interval);
        store_number(Number(0), fresh_);
    }

    // Composites the next piece of each lane. Returns the lanes that have reached the end.
    template <Lookup kind>
    HWY_INLINE FloatMask step(const TileTransfer& transfer, bool colored) {
        const FloatTag d;
        const IntTag di;
        const CubicLanes cubic{{load_number(cubic_[0]), load_number(cubic_[1]),
                                load_number(cubic_[2]), load_number(cubic_[3])}};
        Ints number = hn::Load(di, interval_);
        begin<kind>(transfer, cubic, number);
        const IntervalLanes<kind> interval{transfer, number};
        const Number at = load_number(at_), scalar = load_number(scalar_);
        const Number turn[2] = {load_number(turns_[0]), load_number(turns_[1])};
        // A monotone stretch, and the end of the interval where that is on it.
        const Number stretch_end =
            select(at < turn[0], turn[0], select(at < turn[1], turn[1], Number(1)));
        const Number at_stretch_end = cubic.at(stretch_end);
        const FloatMask rising = at_stretch_end >= scalar;
        const FloatMask first =
            hn::RebindMask(d, hn::Eq(number, hn::Zero(di)));
        const Number left_end = select(first, Number(-3e38f), interval.left_end());
        const Number knot = select(rising, interval.right_end(), left_end);
        const FloatMask crosses =
            hn::Or(hn::And(rising, knot < at_stretch_end),
                   hn::AndNot(rising, knot > at_stretch_end));
        const Number crossing =
            solve_monotone(cubic, knot, at, stretch_end, scalar, at_stretch_end, crosses);
        const Number to = select(crosses, crossing, stretch_end);
        const Number at_to = select(crosses, knot, at_stretch_end);

        Number extent = max(to - at, Number(0));
        LinearPart part = part_in<kind>(interval, cubic, at, extent, scalar, at_to);
        const FloatMask whole = shorten(part, extent);
        const Number depth = part.depth();
        composite<kind>(interval, part, depth, colored);

        const Number place = select(whole, to, max(at + extent, at + Number(6e-8f)));
        store_number(place, at_);
        store_number(select(whole, at_to, cubic.at(place)), scalar_);
        const Ints one = hn::Set(di, 1), next =
            hn::IfThenElse(hn::RebindMask(di, rising), hn::Add(number, one), hn::Sub(number, one));
        const auto leaves = hn::RebindMask(di, hn::And(whole, crosses));
        hn::Store(hn::IfThenElse(leaves, next, number), di, interval_);
        return hn::Or(place >= Number(1),
                      load_number(transmittance_) < Number(least_transmittance));
    }

    // The piece of `extent` from `at` on, with the given scalars at its ends.
    template <Lookup kind>
    HWY_INLINE LinearPart part_in(const IntervalLanes<kind>& interval, const CubicLanes& cubic,
                                  Number at, Number extent, Number scalar, Number at_to) const {
        CubicLanes piece;
        piece.c[0] = scalar;
        piece.c[1] = cubic.slope(at) * extent;
        piece.c[2] = (cubic.c[2] + Number(3) * cubic.c[3] * at) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (at_to - scalar) - (piece.c[2] + piece.c[3]);
        const Number length = load_number(length_) * extent;
        return {interval.share_along(piece), interval.left(3) * length,
                interval.change(3) * length};
    }

    // Shortens pieces that are too deep, from their backs. Returns the lanes that stay whole.
    static HWY_INLINE FloatMask shorten(LinearPart& part, Number& extent) {
        const FloatTag d;
        FloatMask whole = hn::FirstN(d, hn::Lanes(d));
        while (true) {
            const Number depth = part.depth();
            const FloatMask deep = hn::And(depth > Number(largest_part_depth),
                                           extent > Number(shortest));
            if (hn::AllFalse(d, deep)) return whole;
            whole = hn::AndNot(deep, whole);
            // Optical depth grows at least with the first power of the extent from where it is 0;
            // a root does not overshoot where it grows with the second.
            const Number least = Number(shortest) / max(extent, Number(shortest));
            Number share = min(hn::Sqrt((Number(0.7f) / max(depth, Number(1e-3f))).v), Number(0.5f));
            share = select(deep, max(share, min(least, Number(0.5f))), Number(1));
            extent = extent * share;
            part.extinction = part.extinction * share;
            part.change = part.change * share;
            Number power = share;
            for (std::size_t i = 1; i < 4; ++i) {
                part.share.c[i] = part.share.c[i] * power;
                power = power * share;
            }
        }
    }

    template <Lookup kind>
    HWY_INLINE void composite(const IntervalLanes<kind>& interval, const LinearPart& part,
                              Number depth, bool colored) {
        const Number transmittance = load_number(transmittance_);
        const Number weight = transmittance * Number(opacity_from_depth(FloatTag(), depth.v));
        store_number(load_number(depth_) + depth, depth_);
        store_number(transmittance - weight, transmittance_);
        // Summed up by itself, so that parts of small opacity keep their digits.
        store_number(load_number(opacity_) + weight, opacity_);
        if (!colored) return;
        const Number share = mean_share(part);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Number color = interval.left(channel) + share * interval.change(channel);
            store_number(load_number(color_[channel]) + weight * color, color_[channel]);
        }
    }

    std::int32_t waiting_[CellParts::capacity];
    std::size_t count_ = 0, next_ = 0, busy_ = 0;
    // The lanes.
    alignas(64) float cubic_[4][most_lanes] = {};
    alignas(64) float turns_[2][most_lanes] = {};
    alignas(64) float at_[most_lanes] = {}, scalar_[most_lanes] = {};
    alignas(64) float length_[most_lanes] = {}, fresh_[most_lanes] = {};
    alignas(64) float color_[3][most_lanes] = {};
    alignas(64) float depth_[most_lanes] = {}, opacity_[most_lanes] = {};
    alignas(64) float transmittance_[most_lanes] = {};
    alignas(64) std::int32_t interval_[most_lanes] = {};
    std::int32_t part_[most_lanes] = {};  // -1: the lane has none
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
