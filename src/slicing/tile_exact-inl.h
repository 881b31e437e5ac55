// SPDX-License-Identifier: Apache-2.0
// Exact segments: rays are walked through the cells of the grid and integrated cell by cell
// (docs/numerics.md, section 9). The result does not depend on where slabs begin.
#if defined(LAMINA_SLICING_TILE_EXACT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_EXACT_INL_H_
#undef LAMINA_SLICING_TILE_EXACT_INL_H_
#else
#define LAMINA_SLICING_TILE_EXACT_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_block-inl.h"
#include "slicing/tile_cell_walk-inl.h"
#include "slicing/tile_cut_parts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The associated colour, opacity and optical depth of a part of each ray.
struct PartSum {
    Floats color[3];
    Floats opacity, depth;
};

HWY_INLINE PartSum no_part() {
    const Floats zero = hn::Zero(FloatTag());
    return {{zero, zero, zero}, zero, zero};
}

HWY_INLINE void put_behind(const PartSum& part, PartSum& sum) {
    const FloatTag d;
    const Floats kept = hn::Sub(hn::Set(d, 1.0f), sum.opacity);
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = mul_add(kept, part.color[channel], sum.color[channel]);
    sum.opacity = mul_add(kept, part.opacity, sum.opacity);
    sum.depth = hn::Add(sum.depth, part.depth);
}

// Integrates the rays of some packets through one brick.
class CellIntegrator {
  public:
    static constexpr std::size_t most_packets = CellParts::most_packets;

    // `colored`: colours are wanted, too.
    CellIntegrator(const TileSlabs& slabs, bool colored) : slabs_(slabs), colored_(colored) {}

    // Begins at the front of slab `slab`, where the rays are in what is drawn, and ends where they
    // leave it. `packets`: up to most_packets of them.
    void begin(const TileBrickView& view, const PacketRays* packets, std::size_t count, int slab) {
        view_ = &view;
        packets_ = count;
        for (std::size_t i = 0; i < count; ++i) {
            spans_[i] = span_from(packets[i], slab);
            walks_[i].begin(*slabs_.cells, view, packets[i], spans_[i], slabs_.light);
        }
    }
    // Ends at the front of slab `slab`, which lies behind what was integrated.
    void set_end(int slab) {
        for (std::size_t i = 0; i < packets_; ++i)
            walks_[i].set_end(boundary(slabs_.rays, spans_[i], slab));
    }
    // Ends the rays of a packet of which `depths` has reached a limit.
    void end_where(std::size_t packet, const TwoDoubles& depths, double limit) {
        walks_[packet].end_where(depths, limit);
    }
    bool done() const {
        for (std::size_t i = 0; i < packets_; ++i) {
            if (!walks_[i].done()) return false;
        }
        return true;
    }

    // The sums over the next few cells of each ray, for each packet.
    void next(PartSum* sums) {
        walk();
        count_ += static_cast<std::int64_t>(parts_.count);
        if (parts_.count > 0) {
            set_cubics();
            with_lookup(*slabs_.transfer, [&](auto kind) HWY_ATTR {
                if (slabs_.transfer->bend[0].empty()) {
                    integrate<decltype(kind)::value, false>(*slabs_.transfer);
                } else {
                    integrate<decltype(kind)::value, true>(*slabs_.transfer);
                }
            });
        }
        if (colored_) {
            sum_parts<true>(sums);
        } else {
            sum_parts<false>(sums);
        }
    }

    std::int64_t parts() const { return count_; }

  private:
    DepthSpan span_from(const PacketRays& rays, int slab) const {
        const auto later = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Max(a, b); };
        const auto earlier = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Min(a, b); };
        const TwoDoubles front = all(slab * slabs_.rays.slab_thickness);
        const TwoDoubles enter = each_half<FloatTag>(later, rays.enter, rays.drawn.enter);
        const TwoDoubles leave = each_half<FloatTag>(earlier, rays.leave, rays.drawn.leave);
        DepthSpan span;
        span.enter = each_half<FloatTag>(later, front, enter);
        span.leave = each_half<FloatTag>(later, span.enter, leave);
        return span;
    }

    void walk() {
        parts_.clear();
        for (std::size_t i = 0; i < packets_; ++i) walks_[i].begin_run();
        for (bool some = true; some && parts_.steps < CellParts::most_steps;) {
            some = false;
            for (std::size_t i = 0; i < packets_; ++i) {
                StoredLanes& lanes = parts_.lanes[parts_.steps][i];
                lanes.set = 0;
                if (walks_[i].run_done()) continue;
                lanes = walks_[i].step(parts_);
                some = true;
            }
            parts_.steps += some;
        }
        for (std::size_t i = 0; i < packets_; ++i) walks_[i].end_run();
    }

    void set_cubics() {
        const TileBrick& brick = view_->brick;
        // Samples have no neighbour along x; those of pages always have one.
        const bool flat = brick.last_sample[0] == 0 && brick.pages == nullptr;
        switch (brick.layout) {
            case TileLayout::bytes:
                return flat ? set_cubics_by_gathers<TileLayout::bytes>(brick)
                            : set_cubics_of<TileLayout::bytes>(brick);
            case TileLayout::words:
                return flat ? set_cubics_by_gathers<TileLayout::words>(brick)
                            : set_cubics_of<TileLayout::words>(brick);
            case TileLayout::floats:
                return flat ? set_cubics_by_gathers<TileLayout::floats>(brick)
                            : set_cubics_of<TileLayout::floats>(brick);
        }
        unreachable_enum();
    }

    // Fetches pairs of neighbours along x one by one, which is faster than gathers, some vectors of
    // parts at a time.
    template <TileLayout layout>
    void set_cubics_of(const TileBrick& brick) {
        using Pair = typename PairOf<layout>::Type;
        Pair pairs[4][fetched_together];
        for (std::size_t from = 0; from < parts_.count; from += fetched_together) {
            const std::size_t count = std::min(fetched_together, parts_.count - from);
            fetch_pairs(brick, parts_.index + from, count, pairs);
            for (std::size_t i = 0; i < count; i += hn::Lanes(FloatTag())) {
                const Corners corners = unpack_pairs<layout>(brick, pairs, i);
                set_cubic(brick, corners, from + i);
            }
        }
    }

    template <TileLayout layout>
    void set_cubics_by_gathers(const TileBrick& brick) {
        for_each_vector([&](std::size_t i) HWY_ATTR {
            const Ints index = hn::Load(IntTag(), parts_.index + i);
            const auto stored = hn::RebindMask(IntTag(), members_from(i));
            set_cubic(brick, fetch_corners<layout>(brick, hn::IfThenElseZero(stored, index)), i);
        });
    }

    HWY_INLINE void set_cubic(const TileBrick& brick, const Corners& corners, std::size_t i) {
        const Number place[3] = {load_number(parts_.place[0] + i), load_number(parts_.place[1] + i),
                                 load_number(parts_.place[2] + i)};
        const Number change[3] = {load_number(parts_.change[0] + i),
                                  load_number(parts_.change[1] + i),
                                  load_number(parts_.change[2] + i)};
        // Floats are normalised, with an offset of 0. The scale is a power of two (exact_range()).
        const Number base(-brick.offset / brick.scale);
        CubicLanes cubic = cubic_along(corners, base, place, change);
        for (Number& c : cubic.c) c = c * Number(brick.scale);
        if (slabs_.plan->nan_transparent) set_transparent(corners, cubic, i);
        for (std::size_t power = 0; power < 4; ++power)
            store_number(cubic.c[power], parts_.cubic[power] + i);
    }

    // Cells with a corner that is not finite.
    HWY_INLINE void set_transparent(const Corners& corners, CubicLanes& cubic, std::size_t i) {
        Number sum(0);
        for (int corner = 0; corner < 4; ++corner)
            sum = sum + (Number(corners.lower[corner]) + Number(corners.upper[corner]));
        const FloatMask finite = sum == sum;
        for (Number& c : cubic.c) c = zero_unless(finite, c);
        store_number(zero_unless(finite, load_number(parts_.length + i)), parts_.length + i);
    }

    // Parts in one interval of the transfer function are integrated by one rule; the others are
    // cut.
    template <Lookup kind, bool curved>
    void integrate(const TileTransfer& transfer) {
        const FloatTag d;
        cut_.clear();
        for_each_vector([&](std::size_t i) HWY_ATTR {
            const CubicLanes cubic{
                {load_number(parts_.cubic[0] + i), load_number(parts_.cubic[1] + i),
                 load_number(parts_.cubic[2] + i), load_number(parts_.cubic[3] + i)}};
            const RangeLanes range = range_of(cubic);
            const Floats lowest = clamp01(d, range.lo.v);
            const Ints number = find_interval<kind>(transfer, lowest);
            const IntervalLanes<curved> interval = interval_lanes<kind, curved>(transfer, number);
            const FloatMask crosses = range.hi > interval.right_end;
            const Number length = load_number(parts_.length + i);
            const RayPart<curved> part(interval, interval.share_along(cubic), length);
            const Number depth = part.depth();
            const FloatMask stored = members_from(i);
            FloatMask hard = crosses;
            if (!hn::AllFalse(d, crosses))
                hard = hn::And(crosses,
                               shows_something<kind>(transfer, number, clamp01(d, range.hi.v)));
            const Number shown_depth = zero_unless(hn::Not(crosses), depth);
            if (colored_) hard = hn::Or(hard, shown_depth > Number(largest_part_depth));
            hard = hn::And(stored, hard);
            store_number(shown_depth, parts_.depth + i);
            if (colored_) set_colors(interval, part, shown_depth, i);
            const bool lit = slabs_.light != nullptr && colored_;
            Number longest(1);
            GradientLanes gradient;
            if (lit) longest = add_light_to(interval, part, shown_depth, i, gradient, hard);
            if (!hn::AllFalse(d, hard))
                cut_.add(hard, cubic, length, longest, i, lit ? &gradient : nullptr);
        });
        if (!cut_.empty()) cut_.run<kind, curved>(transfer, slabs_.light, colored_, parts_);
    }

    // Adds light to the colours of parts that show something, and those whose light bends to the
    // `hard` ones. Returns how long their pieces may be.
    template <bool curved>
    HWY_INLINE Number add_light_to(const IntervalLanes<curved>& interval,
                                   const RayPart<curved>& part, Number depth, std::size_t i,
                                   GradientLanes& gradient, FloatMask& hard) {
        const FloatTag d;
        const FloatMask seen = hn::And(members_from(i), depth > Number(0));
        if (hn::AllFalse(d, hn::Or(seen, hard))) return Number(1);
        gradient = set_gradients(view_->brick, hn::Or(seen, hard), i, *slabs_.light, parts_,
                                 gradient_rows_);
        Number color[3] = {load_number(parts_.color[0] + i), load_number(parts_.color[1] + i),
                           load_number(parts_.color[2] + i)};
        const Number opacity = load_number(parts_.opacity + i);
        const Number bend =
            add_light(*slabs_.light, gradient,
                      LitPart<curved>{part, interval, Number(0), Number(1), depth, opacity}, color);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store_number(zero_unless(seen, color[channel]), parts_.color[channel] + i);
        hard = hn::Or(hard, hn::And(seen, bends(*slabs_.light, bend, opacity)));
        return longest_piece(*slabs_.light, bend);
    }

    template <bool curved>
    HWY_INLINE void set_colors(const IntervalLanes<curved>& interval, const RayPart<curved>& part,
                               Number depth, std::size_t i) {
        const FloatTag d;
        const FloatMask seen = depth > Number(0);
        if (hn::AllFalse(d, seen)) {
            for (auto& channel : parts_.color) store_number(Number(0), channel + i);
            store_number(Number(0), parts_.opacity + i);
            return;
        }
        const Number opacity = opacity_from_depth(d, depth.v);
        const Number share = zero_unless(seen, seen_share<4>(part, depth, opacity));
        store_number(opacity, parts_.opacity + i);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store_number(interval.color(channel, opacity, share), parts_.color[channel] + i);
    }

    // Composites each ray's parts front to back.
    template <bool colored>
    void sum_parts(PartSum* sums) const {
        for (std::size_t packet = 0; packet < packets_; ++packet) sums[packet] = no_part();
        std::size_t from = 0;
        for (int i = 0; i < parts_.steps; ++i) {
            for (std::size_t packet = 0; packet < packets_; ++packet) {
                const StoredLanes& lanes = parts_.lanes[i][packet];
                if (lanes.set == 0) continue;
                add_parts<colored>(lanes, from, sums[packet]);
                from += static_cast<std::size_t>(std::popcount(lanes.set));
            }
        }
    }
    template <bool colored>
    HWY_INLINE void add_parts(const StoredLanes& lanes, std::size_t from, PartSum& sum) const {
        PartSum part = no_part();
        part.depth = load_members(parts_.depth + from, lanes);
        if constexpr (colored) {
            part.opacity = load_members(parts_.opacity + from, lanes);
            for (int channel = 0; channel < 3; ++channel)
                part.color[channel] = load_members(parts_.color[channel] + from, lanes);
            put_behind(part, sum);
        } else {
            sum.depth = hn::Add(sum.depth, part.depth);
        }
    }

    template <class Body>
    HWY_INLINE void for_each_vector(const Body& body) {
        for (std::size_t i = 0; i < parts_.count; i += hn::Lanes(FloatTag())) body(i);
    }

    // The lanes that hold a part, of the vector from part i on.
    HWY_INLINE FloatMask members_from(std::size_t i) const {
        return hn::FirstN(FloatTag(), parts_.count - i);
    }

    static constexpr std::size_t fetched_together = 8 * most_lanes;

    const TileSlabs& slabs_;
    bool colored_;
    const TileBrickView* view_ = nullptr;
    std::size_t packets_ = 0;
    DepthSpan spans_[most_packets];
    CellWalk walks_[most_packets];
    CellParts parts_;
    CutParts cut_;
    alignas(64) GradientRows gradient_rows_ = {};  // of lit parts
    std::int64_t count_ = 0;
};

// Sets optical depths and colours of the slabs of a block that are wanted.
inline std::int64_t set_exact_segments(const TileBrickView& brick, const PacketRays& packet,
                                       bool colored, CellIntegrator& cells, SlabBlock& block) {
    const FloatTag d;
    const std::int64_t before = cells.parts();
    for_each_run(block.wanted, [&](int first, int end) HWY_ATTR {
        cells.begin(brick, &packet, 1, block.first_slab + first);
        for (int i = first; i < end; ++i) {
            cells.set_end(block.first_slab + i + 1);
            PartSum sum = no_part();
            while (!cells.done()) {
                PartSum part;
                cells.next(&part);
                put_behind(part, sum);
            }
            hn::Store(sum.depth, d, block.depths + at(i));
            if (!colored) continue;
            const Floats opacity = hn::Max(sum.opacity, hn::Set(d, 1e-37f));
            for (int channel = 0; channel < 3; ++channel)
                hn::Store(hn::Div(sum.color[channel], opacity), d, block.colors[channel] + at(i));
        }
    });
    return cells.parts() - before;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
