// SPDX-License-Identifier: Apache-2.0
// Parts of rays that cross points of the transfer function, or that are too deep for one rule. They
// are cut, and their pieces composited front to back, a piece of each part in every round. Parts
// that have ended leave the others to be packed anew, as parts have different numbers of pieces.
#if defined(LAMINA_SLICING_TILE_CUT_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#undef LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#else
#define LAMINA_SLICING_TILE_CUT_PARTS_INL_H_
#endif

#include "slicing/tile_cell_optics-inl.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_gradient_queue-inl.h"
#include "slicing/tile_light-inl.h"

LAMINA_SIMD_BEGIN

class CutParts {
  public:
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }

    // Adds the `members` of a vector of parts, of which `first` is the number of the first.
    // `longest`: share of the part that a piece may have; of lit parts alone.
    LAMINA_INLINE void add(FloatMask members, const CubicLanes& cubic, Float length, Float longest,
                           std::size_t first, const GradientLanes* gradient) {
        if (gradient != nullptr) gradients_.keep(*gradient, members, count_);
        append(members, cubic, length, longest, iota<Int>(static_cast<std::int32_t>(first)));
    }

    // Sets colour, opacity and depth of the parts that were added. `light`: null where nothing is
    // lit.
    template <Lookup kind, bool curved>
    void run(const TileTransfer& transfer, const TileLight* light, bool colored, CellParts& parts) {
        light_ = light;
        run_round<kind, curved, true>(transfer, colored, parts);
        while (count_ > 0) run_round<kind, curved, false>(transfer, colored, parts);
    }

  private:
    // Nothing behind this transmittance can be seen.
    static constexpr float least_transmittance = 1e-9f;
    // A part this short has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;
    // Vectors side by side, because each waits for its own results.
    static constexpr std::size_t vectors = 2;

    // The parts of a vector of lanes, and what is composited of them.
    struct Lanes {
        CubicLanes cubic;
        Float length, longest;
        Float turns[2];  // where the cubic turns
        // How far it is done: place, scalar, interval.
        Float at, scalar;
        Int interval;
        Float color[3], opacity, depth, transmittance;
        Int part;
        GradientLanes gradient;  // of lit parts alone
    };

    // The next monotone stretch of each part, as far as it stays in one interval.
    template <bool curved>
    struct Stretch {
        IntervalLanes<curved> interval;
        Float end, at_end, knot;
        FloatMask rising, crosses;
        RootLanes root;
    };

    LAMINA_INLINE void append(FloatMask members, const CubicLanes& cubic, Float length,
                              Float longest, Int part) {
        for (std::size_t i = 0; i < 4; ++i) store_members(cubic.c[i], members, cubic_[i] + count_);
        store_members(length, members, length_ + count_);
        store_members(longest, members, longest_ + count_);
        store_members(part, members, part_ + count_);
        count_ += count_of(members);
    }

    // Composites the next piece of each part.
    template <Lookup kind, bool curved, bool first>
    void run_round(const TileTransfer& transfer, bool colored, CellParts& parts) {
        const std::size_t count = count_, step = Float::lanes;
        count_ = 0;
        for (std::size_t from = 0; from < count; from += vectors * step) {
            const std::size_t used = from + step < count ? vectors : 1;
            Lanes lanes[vectors];
            for (std::size_t i = 0; i < used; ++i) {
                const std::size_t place = from + i * step;
                const FloatMask members = first_lanes<FloatMask>(count - place);
                lanes[i] = first ? begin<kind>(transfer, place, members) : resume(place, members);
            }
            FloatMask done[vectors];
            add_pieces<kind, curved>(transfer, colored, used, lanes, done);
            for (std::size_t i = 0; i < used; ++i) {
                const FloatMask members = first_lanes<FloatMask>(count - from - i * step);
                finish(lanes[i], members & done[i], parts);
                keep(lanes[i], without(members, done[i]));
            }
        }
    }

    // The lanes outside `members` have any values; what is computed of them is not used.
    LAMINA_INLINE Lanes load_parts(std::size_t from, FloatMask members) const {
        Lanes lanes;
        for (std::size_t i = 0; i < 4; ++i)
            lanes.cubic.c[i] = zero_unless(members, load_unaligned<Float>(cubic_[i] + from));
        lanes.length = zero_unless(members, load_unaligned<Float>(length_ + from));
        lanes.longest = load_unaligned<Float>(longest_ + from);
        if (light_ != nullptr) lanes.gradient = gradients_.kept(from);
        // Those outside `members` are places, too.
        lanes.part = zero_unless(members, load_unaligned<Int>(part_ + from));
        return lanes;
    }

    // Where the parts turn, and in which interval they begin. At an end of an interval they begin
    // on the side to which they go.
    template <Lookup kind>
    LAMINA_INLINE Lanes begin(const TileTransfer& transfer, std::size_t from,
                              FloatMask members) const {
        Lanes lanes = load_parts(from, members);
        const Turns turns = turns_of(lanes.cubic);
        lanes.turns[0] = turns.first;
        lanes.turns[1] = turns.second;
        const Float start = lanes.cubic.c[0];
        const FloatMask falling = lanes.cubic.at(turns.first) < start;
        const Int interval = find_interval<kind>(transfer, clamp01(start));
        const FloatMask at_end = look_up<kind>(transfer.end, interval) == start;
        const FloatMask below = falling & at_end & (interval > 0);
        lanes.interval = interval - zero_unless(below, Int(1));
        lanes.at = lanes.opacity = lanes.depth = Float(0);
        lanes.scalar = start;
        for (Float& channel : lanes.color) channel = Float(0);
        lanes.transmittance = Float(1);
        return lanes;
    }

    LAMINA_INLINE Lanes resume(std::size_t from, FloatMask members) const {
        Lanes lanes = load_parts(from, members);
        lanes.turns[0] = load_unaligned<Float>(turns_[0] + from);
        lanes.turns[1] = load_unaligned<Float>(turns_[1] + from);
        lanes.at = load_unaligned<Float>(at_ + from);
        lanes.scalar = load_unaligned<Float>(scalar_ + from);
        lanes.interval = zero_unless(members, load_unaligned<Int>(interval_ + from));
        for (std::size_t i = 0; i < 3; ++i)
            lanes.color[i] = load_unaligned<Float>(color_[i] + from);
        lanes.opacity = load_unaligned<Float>(opacity_ + from);
        lanes.depth = load_unaligned<Float>(depth_ + from);
        lanes.transmittance = load_unaligned<Float>(transmittance_ + from);
        return lanes;
    }

    // Keeps the `members` for the next round, behind those that were kept before: never beyond what
    // was loaded.
    LAMINA_INLINE void keep(const Lanes& lanes, FloatMask members) {
        if (none_of(members)) return;
        const std::size_t to = count_;
        if (light_ != nullptr) gradients_.keep(lanes.gradient, members, count_);
        append(members, lanes.cubic, lanes.length, lanes.longest, lanes.part);
        store_members(lanes.turns[0], members, turns_[0] + to);
        store_members(lanes.turns[1], members, turns_[1] + to);
        store_members(lanes.at, members, at_ + to);
        store_members(lanes.scalar, members, scalar_ + to);
        store_members(lanes.interval, members, interval_ + to);
        for (std::size_t i = 0; i < 3; ++i) store_members(lanes.color[i], members, color_[i] + to);
        store_members(lanes.opacity, members, opacity_ + to);
        store_members(lanes.depth, members, depth_ + to);
        store_members(lanes.transmittance, members, transmittance_ + to);
    }

    static void finish(const Lanes& lanes, FloatMask members, CellParts& parts) {
        alignas(64) float color[3][most_lanes], opacity[most_lanes], depth[most_lanes];
        alignas(64) std::int32_t part[most_lanes];
        for (std::size_t i = 0; i < 3; ++i) store(lanes.color[i], color[i]);
        store(lanes.opacity, opacity);
        store(lanes.depth, depth);
        store(lanes.part, part);
        for_each_lane(bits_of(members), [&](std::size_t lane) {
            const auto to = static_cast<std::size_t>(part[lane]);
            for (std::size_t i = 0; i < 3; ++i) parts.color[i][to] = color[i][lane];
            parts.opacity[to] = opacity[lane];
            parts.depth[to] = depth[lane];
        });
    }

    // Finds the lanes that have reached the end.
    template <Lookup kind, bool curved>
    LAMINA_INLINE void add_pieces(const TileTransfer& transfer, bool colored, std::size_t used,
                                  Lanes (&lanes)[vectors], FloatMask (&done)[vectors]) {
        constexpr int usual_steps = 2, most_steps = 30;
        static_assert(vectors == 2);
        Stretch<curved> stretches[vectors];
        for (std::size_t i = 0; i < used; ++i)
            stretches[i] = next_stretch<kind, curved>(transfer, lanes[i]);
        const auto found = [&] LAMINA_LAMBDA {
            return stretches[0].root.found() && (used == 1 || stretches[1].root.found());
        };
        for (int i = 0; i < usual_steps || (i < most_steps && !found()); ++i) {
            for (std::size_t j = 0; j < used; ++j) stretches[j].root.refine(lanes[j].cubic);
        }
        for (std::size_t i = 0; i < used; ++i) done[i] = add_piece(colored, stretches[i], lanes[i]);
    }

    template <Lookup kind, bool curved>
    static LAMINA_INLINE Stretch<curved> next_stretch(const TileTransfer& transfer,
                                                      const Lanes& lanes) {
        Stretch<curved> next;
        next.end = select(lanes.at < lanes.turns[0], lanes.turns[0],
                          select(lanes.at < lanes.turns[1], lanes.turns[1], 1));
        next.at_end = lanes.cubic.at(next.end);
        next.rising = next.at_end >= lanes.scalar;
        next.interval = interval_lanes<kind, curved>(transfer, lanes.interval);
        const FloatMask lowest = lanes.interval == 0;
        const Float left_end = select(lowest, Float(-3e38f), next.interval.left_end);
        next.knot = select(next.rising, next.interval.right_end, left_end);
        next.crosses = (next.rising & (next.knot < next.at_end)) |
                       without(next.knot > next.at_end, next.rising);
        next.root.begin(next.knot, lanes.at, next.end, lanes.scalar, next.at_end, next.crosses);
        return next;
    }

    // Returns the lanes that have reached the end.
    template <bool curved>
    LAMINA_INLINE FloatMask add_piece(bool colored, const Stretch<curved>& stretch,
                                      Lanes& lanes) const {
        const Float to = select(stretch.crosses, stretch.root.t, stretch.end);
        const Float at_to = select(stretch.crosses, stretch.knot, stretch.at_end);
        Float extent = max(to - lanes.at, 0), at_back = at_to;
        FloatMask whole(true);
        if (light_ != nullptr) {
            whole = extent <= lanes.longest;
            extent = min(extent, lanes.longest);
            at_back = select(whole, at_to, lanes.cubic.at(lanes.at + extent));
        }
        RayPart<curved> part(stretch.interval,
                             share_of_piece(stretch.interval, lanes, extent, at_back),
                             lanes.length * extent);
        whole = whole & shorten(stretch.interval, lanes.length, part, extent);
        if (light_ == nullptr || !colored) {
            composite(stretch.interval, part, colored, lanes);
        } else {
            const FloatMask again = composite_lit(stretch.interval, part, extent, lanes);
            lanes.longest = select(again, 0.5f * extent, max(lanes.longest, 2 * extent));
            // These stay where they are.
            whole = without(whole, again);
            extent = zero_unless(!again, extent);
        }

        const Float shortened = max(lanes.at + extent, lanes.at + 6e-8f);
        lanes.at = select(whole, to, shortened);
        lanes.scalar = select(whole, at_to, lanes.cubic.at(lanes.at));
        const Int number = lanes.interval;
        const Int next = select(stretch.rising, number + 1, number - 1);
        lanes.interval = select(whole & stretch.crosses, next, number);
        return (lanes.at >= 1) | (lanes.transmittance < least_transmittance);
    }

    // The share along the piece of `extent` from where the parts are, up to where the scalar is
    // `at_to`.
    template <bool curved>
    static LAMINA_INLINE CubicLanes share_of_piece(const IntervalLanes<curved>& interval,
                                                   const Lanes& lanes, Float extent, Float at_to) {
        const CubicLanes& cubic = lanes.cubic;
        CubicLanes piece;
        piece.c[0] = lanes.scalar;
        piece.c[2] = (cubic.c[2] + 3 * cubic.c[3] * lanes.at) * extent * extent;
        piece.c[3] = cubic.c[3] * extent * extent * extent;
        piece.c[1] = (at_to - lanes.scalar) - (piece.c[2] + piece.c[3]);
        return interval.share_along(piece);
    }

    // Shortens pieces that are too deep, from their backs. Returns the lanes that stay whole.
    template <bool curved>
    static LAMINA_INLINE FloatMask shorten(const IntervalLanes<curved>& interval, Float length,
                                           RayPart<curved>& part, Float& extent) {
        FloatMask whole(true);
        while (true) {
            const Float depth = part.depth();
            const FloatMask deep = (depth > largest_part_depth) & (extent > shortest);
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
                part.share.c[i] *= power;
                power *= share;
            }
            part = RayPart<curved>(interval, part.share, length * extent);
        }
    }

    template <bool curved>
    static LAMINA_INLINE void composite(const IntervalLanes<curved>& interval,
                                        const RayPart<curved>& part, bool colored, Lanes& lanes) {
        const Float depth = part.depth();
        const Float opacity = opacity_from_depth(depth);
        const Float transmittance = lanes.transmittance, weight = transmittance * opacity;
        lanes.depth += depth;
        lanes.transmittance = transmittance - weight;
        // Summed up by itself, so that parts of small opacity keep their digits.
        lanes.opacity += weight;
        if (!colored) return;
        // A piece of the least extent may be too deep even so: its colour hardly changes.
        const FloatMask deep = depth > largest_part_depth;
        const Float share = transmittance * select(deep, opacity * part.share.c[0],
                                                   seen_share<4>(part, depth, opacity));
        for (std::size_t channel = 0; channel < 3; ++channel)
            lanes.color[channel] += interval.color(channel, weight, share);
    }

    // The same of pieces that are lit. Returns those that are not composited, because their light
    // bends too much for one rule.
    template <bool curved>
    LAMINA_INLINE FloatMask composite_lit(const IntervalLanes<curved>& interval,
                                          const RayPart<curved>& part, Float extent,
                                          Lanes& lanes) const {
        const Float depth = part.depth();
        const Float opacity = opacity_from_depth(depth);
        const FloatMask deep = depth > largest_part_depth;
        const Float share =
            select(deep, opacity * part.share.c[0], seen_share<4>(part, depth, opacity));
        Float color[3];
        for (std::size_t channel = 0; channel < 3; ++channel)
            color[channel] = interval.color(channel, opacity, share);
        const Float bend =
            add_light(*light_, lanes.gradient,
                      LitPart<curved>{part, interval, lanes.at, extent, depth, opacity}, color);
        const Float transmittance = lanes.transmittance, weight = transmittance * opacity;
        const FloatMask again = (extent > shortest_lit_piece) & bends(*light_, bend, weight);
        lanes.depth += zero_unless(!again, depth);
        lanes.transmittance = transmittance - zero_unless(!again, weight);
        lanes.opacity += zero_unless(!again, weight);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            lanes.color[channel] += zero_unless(!again, transmittance * color[channel]);
        }
        return again;
    }

    static constexpr std::size_t capacity = CellParts::capacity;

    const TileLight* light_ = nullptr;
    std::size_t count_ = 0;
    GradientQueue gradients_;  // of lit parts
    alignas(64) float cubic_[4][capacity];
    alignas(64) float length_[capacity];
    alignas(64) float longest_[capacity];
    alignas(64) std::int32_t part_[capacity];
    // From the second round on:
    alignas(64) float turns_[2][capacity];
    alignas(64) float at_[capacity];
    alignas(64) float scalar_[capacity];
    alignas(64) std::int32_t interval_[capacity];
    alignas(64) float color_[3][capacity];
    alignas(64) float opacity_[capacity];
    alignas(64) float depth_[capacity];
    alignas(64) float transmittance_[capacity];
};

LAMINA_SIMD_END

#endif
