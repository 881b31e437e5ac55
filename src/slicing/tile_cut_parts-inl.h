// SPDX-License-Identifier: Apache-2.0
// Parts of rays that cross points of the transfer function, or that are too deep for one rule. They
// are cut, and their pieces composited front to back. Parts need different numbers of steps: a lane
// that has finished one takes the next. Two vectors of lanes go side by side, because each step
// waits for its own results.
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
        next_ = 0;
        static_assert(vectors == 2);
        for (Lanes& lanes : lanes_) {
            for (std::size_t lane = 0; lane < hn::Lanes(FloatTag()); ++lane)
                take(parts, lanes, lane);
        }
        while (lanes_[0].busy + lanes_[1].busy > 0) {
            std::uint32_t done[vectors] = {};
            step<kind>(transfer, colored, done);
            for (std::size_t i = 0; i < vectors; ++i) {
                for_each_lane(done[i], [&](std::size_t lane) { finish(lanes_[i], lane, parts); });
            }
        }
    }

  private:
    // Nothing behind this transmittance can be seen.
    static constexpr float least_transmittance = 1e-9f;
    // A part this short has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;

    static constexpr std::size_t vectors = 2;

    // The parts of a vector of lanes, and what is composited of them.
    struct Lanes {
        alignas(64) float cubic[4][most_lanes] = {};
        alignas(64) float length[most_lanes] = {};
        alignas(64) float fresh[most_lanes] = {};     // 1 before the first step
        alignas(64) float turns[2][most_lanes] = {};  // where the cubic turns
        // How far it is done: place, scalar, interval.
        alignas(64) float at[most_lanes] = {};
        alignas(64) float scalar[most_lanes] = {};
        alignas(64) std::int32_t interval[most_lanes] = {};
        alignas(64) float color[3][most_lanes] = {};
        alignas(64) float opacity[most_lanes] = {};
        alignas(64) float depth[most_lanes] = {};
        alignas(64) float transmittance[most_lanes] = {};
        std::int32_t part[most_lanes] = {};  // -1: none
        int busy = 0;                        // lanes with a part
    };

    // The next monotone stretch of each part, as far as it stays in one interval.
    struct Stretch {
        CubicLanes cubic;
        Ints number;  // of the interval
        Number at, scalar, end, at_end, knot;
        FloatMask rising, crosses;
        RootLanes root;
    };

    void take(const CellParts& parts, Lanes& lanes, std::size_t lane) {
        lanes.part[lane] = -1;
        lanes.at[lane] = 1;
        lanes.length[lane] = 0;
        if (next_ == count_) return;
        const std::int32_t part = waiting_[next_++];
        const auto from = static_cast<std::size_t>(part);
        ++lanes.busy;
        lanes.part[lane] = part;
        for (std::size_t i = 0; i < 4; ++i) lanes.cubic[i][lane] = parts.cubic[i][from];
        lanes.length[lane] = parts.length[from];
        lanes.fresh[lane] = 1;
        lanes.at[lane] = 0;
        lanes.scalar[lane] = parts.cubic[0][from];
        for (auto& channel : lanes.color) channel[lane] = 0;
        lanes.opacity[lane] = 0;
        lanes.depth[lane] = 0;
        lanes.transmittance[lane] = 1;
    }

    void finish(Lanes& lanes, std::size_t lane, CellParts& parts) {
        if (lanes.part[lane] < 0) return;
        const auto to = static_cast<std::size_t>(lanes.part[lane]);
        parts.depth[to] = lanes.depth[lane];
        parts.opacity[to] = lanes.opacity[lane];
        for (std::size_t channel = 0; channel < 3; ++channel)
            parts.color[channel][to] = lanes.color[channel][lane];
        --lanes.busy;
        take(parts, lanes, lane);
    }

    // Composites the next piece of each lane, and finds the lanes that have reached the end.
    template <Lookup kind>
    HWY_INLINE void step(const TileTransfer& transfer, bool colored,
                         std::uint32_t (&done)[vectors]) {
        constexpr int usual_steps = 2, most_steps = 30;
        Stretch stretches[vectors];
        // Parts are taken from the first vector on.
        const std::size_t used = lanes_[1].busy > 0 ? vectors : 1;
        for (std::size_t i = 0; i < used; ++i)
            stretches[i] = next_stretch<kind>(transfer, lanes_[i]);
        const auto found = [&] HWY_ATTR {
            return stretches[0].root.found() && (used == 1 || stretches[1].root.found());
        };
        for (int i = 0; i < usual_steps || (i < most_steps && !found()); ++i) {
            for (std::size_t j = 0; j < used; ++j) stretches[j].root.refine(stretches[j].cubic);
        }
        for (std::size_t i = 0; i < used; ++i) {
            done[i] = bits_of(add_piece<kind>(transfer, colored, stretches[i], lanes_[i]));
        }
    }

    // The lanes that took a part since the last step: where it turns, and in which interval it
    // begins. At an end of an interval it begins on the side to which it goes.
    template <Lookup kind>
    HWY_INLINE void begin(const TileTransfer& transfer, const CubicLanes& cubic, Lanes& lanes) {
        const FloatTag d;
        const IntTag di;
        const FloatMask fresh = load_number(lanes.fresh) > Number(0);
        if (hn::AllFalse(d, fresh)) return;
        const Turns turns = turns_of(cubic);
        store_number(select(fresh, turns.first, load_number(lanes.turns[0])), lanes.turns[0]);
        store_number(select(fresh, turns.second, load_number(lanes.turns[1])), lanes.turns[1]);
        const Number start = cubic.c[0];
        const FloatMask falling = cubic.at(turns.first) < start;
        Ints first = find_interval<kind>(transfer, clamp01(d, start.v));
        const FloatMask at_end = look_up<kind>(transfer.end, first) == start.v;
        const auto below =
            hn::And(hn::RebindMask(di, hn::And(falling, at_end)), hn::Gt(first, hn::Zero(di)));
        first = hn::Sub(first, hn::IfThenElseZero(below, hn::Set(di, 1)));
        const Ints before = hn::Load(di, lanes.interval);
        hn::Store(hn::IfThenElse(hn::RebindMask(di, fresh), first, before), di, lanes.interval);
        store_number(Number(0), lanes.fresh);
    }

    template <Lookup kind>
    HWY_INLINE Stretch next_stretch(const TileTransfer& transfer, Lanes& lanes) {
        const FloatTag d;
        const IntTag di;
        Stretch next;
        for (std::size_t i = 0; i < 4; ++i) next.cubic.c[i] = load_number(lanes.cubic[i]);
        begin<kind>(transfer, next.cubic, lanes);
        next.number = hn::Load(di, lanes.interval);
        next.at = load_number(lanes.at);
        next.scalar = load_number(lanes.scalar);
        const Number turn[2] = {load_number(lanes.turns[0]), load_number(lanes.turns[1])};
        next.end =
            select(next.at < turn[0], turn[0], select(next.at < turn[1], turn[1], Number(1)));
        next.at_end = next.cubic.at(next.end);
        next.rising = next.at_end >= next.scalar;
        const IntervalLanes<kind> interval{transfer, next.number};
        const FloatMask first = hn::RebindMask(d, hn::Eq(next.number, hn::Zero(di)));
        const Number left_end = select(first, Number(-3e38f), interval.left_end());
        next.knot = select(next.rising, interval.right_end(), left_end);
        next.crosses = hn::Or(hn::And(next.rising, next.knot < next.at_end),
                              hn::AndNot(next.rising, next.knot > next.at_end));
        next.root.begin(next.knot, next.at, next.end, next.scalar, next.at_end, next.crosses);
        return next;
    }

    // Returns the lanes that have reached the end.
    template <Lookup kind>
    HWY_INLINE FloatMask add_piece(const TileTransfer& transfer, bool colored,
                                   const Stretch& stretch, Lanes& lanes) {
        const IntTag di;
        const IntervalLanes<kind> interval{transfer, stretch.number};
        const Number to = select(stretch.crosses, stretch.root.t, stretch.end);
        const Number at_to = select(stretch.crosses, stretch.knot, stretch.at_end);
        Number extent = max(to - stretch.at, Number(0));
        LinearPart part =
            part_of<kind>(interval, stretch, extent, at_to, load_number(lanes.length) * extent);
        const FloatMask whole = shorten(part, extent);
        composite<kind>(interval, part, colored, lanes);

        const Number shortened = max(stretch.at + extent, stretch.at + Number(6e-8f));
        const Number place = select(whole, to, shortened);
        store_number(place, lanes.at);
        store_number(select(whole, at_to, stretch.cubic.at(place)), lanes.scalar);
        const Ints number = stretch.number, one = hn::Set(di, 1);
        const Ints next = hn::IfThenElse(hn::RebindMask(di, stretch.rising), hn::Add(number, one),
                                         hn::Sub(number, one));
        const auto leaves = hn::RebindMask(di, hn::And(whole, stretch.crosses));
        hn::Store(hn::IfThenElse(leaves, next, number), di, lanes.interval);
        return hn::Or(place >= Number(1),
                      load_number(lanes.transmittance) < Number(least_transmittance));
    }

    // The piece of a stretch of `extent` from its beginning, up to where the scalar is `at_to`.
    template <Lookup kind>
    HWY_INLINE LinearPart part_of(const IntervalLanes<kind>& interval, const Stretch& stretch,
                                  Number extent, Number at_to, Number length) const {
        const CubicLanes& cubic = stretch.cubic;
        CubicLanes piece;
        piece.c[0] = stretch.scalar;
        piece.c[2] = (cubic.c[2] + Number(3) * cubic.c[3] * stretch.at) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (at_to - stretch.scalar) - (piece.c[2] + piece.c[3]);
        return {interval.share_along(piece), interval.left(3) * length,
                interval.change(3) * length};
    }

    // Shortens pieces that are too deep, from their backs. Returns the lanes that stay whole.
    static HWY_INLINE FloatMask shorten(LinearPart& part, Number& extent) {
        const FloatTag d;
        FloatMask whole = hn::FirstN(d, hn::Lanes(d));
        while (true) {
            const Number depth = part.depth();
            const FloatMask deep =
                hn::And(depth > Number(largest_part_depth), extent > Number(shortest));
            if (hn::AllFalse(d, deep)) return whole;
            whole = hn::AndNot(deep, whole);
            // Optical depth grows at least with the first power of the extent from where it is 0;
            // a root does not overshoot where it grows with the second.
            const Number least = Number(shortest) / max(extent, Number(shortest));
            Number share =
                min(hn::Sqrt((Number(0.7f) / max(depth, Number(1e-3f))).v), Number(0.5f));
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
                              bool colored, Lanes& lanes) {
        const Number depth = part.depth(), transmittance = load_number(lanes.transmittance);
        const Number weight = transmittance * Number(opacity_from_depth(FloatTag(), depth.v));
        store_number(load_number(lanes.depth) + depth, lanes.depth);
        store_number(transmittance - weight, lanes.transmittance);
        // Summed up by itself, so that parts of small opacity keep their digits.
        store_number(load_number(lanes.opacity) + weight, lanes.opacity);
        if (!colored) return;
        // A piece of the least extent may be too deep even so: the mean is one of its shares.
        LinearPart shallow = part;
        const Number most = min(Number(1), Number(largest_part_depth) / max(depth, Number(1e-30f)));
        shallow.extinction = shallow.extinction * most;
        shallow.change = shallow.change * most;
        const Number share = mean_share(shallow);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Number color = weight * interval.at(channel, share);
            store_number(load_number(lanes.color[channel]) + color, lanes.color[channel]);
        }
    }

    std::int32_t waiting_[CellParts::capacity];
    std::size_t count_ = 0, next_ = 0;
    Lanes lanes_[vectors];
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
