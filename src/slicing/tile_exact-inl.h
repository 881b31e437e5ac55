// SPDX-License-Identifier: Apache-2.0
// Exact segments: rays are walked through the cells of the grid and integrated cell by cell
// (docs/numerics.md, section 9). The result does not depend on where slabs begin.
#if defined(LAMINA_SLICING_TILE_EXACT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_EXACT_INL_H_
#undef LAMINA_SLICING_TILE_EXACT_INL_H_
#else
#define LAMINA_SLICING_TILE_EXACT_INL_H_
#endif

#include "slicing/tile_block-inl.h"
#include "slicing/tile_cell_walk-inl.h"
#include "slicing/tile_cut_parts-inl.h"

LAMINA_SIMD_BEGIN

// The associated colour, opacity and optical depth of a part of each ray.
struct PartSum {
    Float color[3];
    Float opacity, depth;
};

LAMINA_INLINE PartSum no_part() {
    const Float zero(0);
    return {{zero, zero, zero}, zero, zero};
}

LAMINA_INLINE void put_behind(const PartSum& part, PartSum& sum) {
    const Float kept = 1.0f - sum.opacity;
    for (int channel = 0; channel < 3; ++channel) sum.color[channel] += kept * part.color[channel];
    sum.opacity += kept * part.opacity;
    sum.depth += part.depth;
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
    void end_where(std::size_t packet, const Float64& depths, double limit) {
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
            with_lookup(*slabs_.transfer, [&](auto kind) LAMINA_LAMBDA {
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
        const Float64 front = slab * slabs_.rays.slab_thickness;
        const Float64 enter = max(front, max(rays.enter, rays.drawn.enter));
        return {enter, max(enter, min(rays.leave, rays.drawn.leave))};
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
            for (std::size_t i = 0; i < count; i += Float::lanes) {
                const Corners corners = unpack_pairs<layout>(brick, pairs, i);
                set_cubic(brick, corners, from + i);
            }
        }
    }

    template <TileLayout layout>
    void set_cubics_by_gathers(const TileBrick& brick) {
        for_each_vector([&](std::size_t i) LAMINA_LAMBDA {
            const Int index = load<Int>(parts_.index + i);
            const FloatMask stored = members_from(i);
            set_cubic(brick, fetch_corners<layout>(brick, zero_unless(stored, index)), i);
        });
    }

    LAMINA_INLINE void set_cubic(const TileBrick& brick, const Corners& corners, std::size_t i) {
        const Float place[3] = {load<Float>(parts_.place[0] + i), load<Float>(parts_.place[1] + i),
                                load<Float>(parts_.place[2] + i)};
        const Float change[3] = {load<Float>(parts_.change[0] + i),
                                 load<Float>(parts_.change[1] + i),
                                 load<Float>(parts_.change[2] + i)};
        // Floats are normalised, with an offset of 0. The scale is a power of two (exact_range()).
        const Float base(-brick.offset / brick.scale);
        CubicLanes cubic = cubic_along(corners, base, place, change);
        for (Float& c : cubic.c) c *= brick.scale;
        if (slabs_.plan->nan_transparent) set_transparent(corners, cubic, i);
        for (std::size_t power = 0; power < 4; ++power)
            store(cubic.c[power], parts_.cubic[power] + i);
    }

    // Cells with a corner that is not finite.
    LAMINA_INLINE void set_transparent(const Corners& corners, CubicLanes& cubic, std::size_t i) {
        Float sum(0);
        for (int corner = 0; corner < 4; ++corner)
            sum += corners.lower[corner] + corners.upper[corner];
        const FloatMask finite = sum == sum;
        for (Float& c : cubic.c) c = zero_unless(finite, c);
        store(zero_unless(finite, load<Float>(parts_.length + i)), parts_.length + i);
    }

    // Parts in one interval of the transfer function are integrated by one rule; the others are
    // cut.
    template <Lookup kind, bool curved>
    void integrate(const TileTransfer& transfer) {
        cut_.clear();
        for_each_vector([&](std::size_t i) LAMINA_LAMBDA {
            const CubicLanes cubic{
                {load<Float>(parts_.cubic[0] + i), load<Float>(parts_.cubic[1] + i),
                 load<Float>(parts_.cubic[2] + i), load<Float>(parts_.cubic[3] + i)}};
            const RangeLanes range = range_of(cubic);
            const Float lowest = clamp01(range.lo);
            const Int number = find_interval<kind>(transfer, lowest);
            const IntervalLanes<curved> interval = interval_lanes<kind, curved>(transfer, number);
            const FloatMask crosses = range.hi > interval.right_end;
            const Float length = load<Float>(parts_.length + i);
            const RayPart<curved> part(interval, interval.share_along(cubic), length);
            const Float depth = part.depth();
            const FloatMask stored = members_from(i);
            FloatMask hard = crosses;
            if (any_of(crosses))
                hard = crosses & shows_something<kind>(transfer, number, clamp01(range.hi));
            const Float shown_depth = zero_unless(!crosses, depth);
            if (colored_) hard = hard | (shown_depth > largest_part_depth);
            hard = stored & hard;
            store(shown_depth, parts_.depth + i);
            if (colored_) set_colors(interval, part, shown_depth, i);
            const bool lit = slabs_.light != nullptr && colored_;
            Float longest(1);
            GradientLanes gradient;
            if (lit) longest = add_light_to(interval, part, shown_depth, i, gradient, hard);
            if (any_of(hard)) cut_.add(hard, cubic, length, longest, i, lit ? &gradient : nullptr);
        });
        if (!cut_.empty()) cut_.run<kind, curved>(transfer, slabs_.light, colored_, parts_);
    }

    // Adds light to the colours of parts that show something, and those whose light bends to the
    // `hard` ones. Returns how long their pieces may be.
    template <bool curved>
    LAMINA_INLINE Float add_light_to(const IntervalLanes<curved>& interval,
                                     const RayPart<curved>& part, Float depth, std::size_t i,
                                     GradientLanes& gradient, FloatMask& hard) {
        const FloatMask seen = members_from(i) & (depth > 0);
        if (none_of(seen | hard)) return Float(1);
        gradient =
            set_gradients(view_->brick, seen | hard, i, *slabs_.light, parts_, gradient_rows_);
        Float color[3] = {load<Float>(parts_.color[0] + i), load<Float>(parts_.color[1] + i),
                          load<Float>(parts_.color[2] + i)};
        const Float opacity = load<Float>(parts_.opacity + i);
        const Float bend =
            add_light(*slabs_.light, gradient,
                      LitPart<curved>{part, interval, Float(0), Float(1), depth, opacity}, color);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store(zero_unless(seen, color[channel]), parts_.color[channel] + i);
        hard = hard | (seen & bends(*slabs_.light, bend, opacity));
        return longest_piece(*slabs_.light, bend);
    }

    template <bool curved>
    LAMINA_INLINE void set_colors(const IntervalLanes<curved>& interval,
                                  const RayPart<curved>& part, Float depth, std::size_t i) {
        const FloatMask seen = depth > 0;
        if (none_of(seen)) {
            for (auto& channel : parts_.color) store(Float(0), channel + i);
            store(Float(0), parts_.opacity + i);
            return;
        }
        const Float opacity = opacity_from_depth(depth);
        const Float share = zero_unless(seen, seen_share<4>(part, depth, opacity));
        store(opacity, parts_.opacity + i);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store(interval.color(channel, opacity, share), parts_.color[channel] + i);
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
    LAMINA_INLINE void add_parts(const StoredLanes& lanes, std::size_t from, PartSum& sum) const {
        PartSum part = no_part();
        part.depth = load_members(parts_.depth + from, lanes);
        if constexpr (colored) {
            part.opacity = load_members(parts_.opacity + from, lanes);
            for (int channel = 0; channel < 3; ++channel)
                part.color[channel] = load_members(parts_.color[channel] + from, lanes);
            put_behind(part, sum);
        } else {
            sum.depth += part.depth;
        }
    }

    template <class Body>
    LAMINA_INLINE void for_each_vector(const Body& body) {
        for (std::size_t i = 0; i < parts_.count; i += Float::lanes) body(i);
    }

    // The lanes that hold a part, of the vector from part i on.
    LAMINA_INLINE FloatMask members_from(std::size_t i) const {
        return first_lanes<FloatMask>(parts_.count - i);
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
    const std::int64_t before = cells.parts();
    for_each_run(block.wanted, [&](int first, int end) LAMINA_LAMBDA {
        cells.begin(brick, &packet, 1, block.first_slab + first);
        for (int i = first; i < end; ++i) {
            cells.set_end(block.first_slab + i + 1);
            PartSum sum = no_part();
            while (!cells.done()) {
                PartSum part;
                cells.next(&part);
                put_behind(part, sum);
            }
            store(sum.depth, block.depths + at(i));
            if (!colored) continue;
            const Float opacity = max(sum.opacity, 1e-37f);
            for (int channel = 0; channel < 3; ++channel)
                store(sum.color[channel] / opacity, block.colors[channel] + at(i));
        }
    });
    return cells.parts() - before;
}

LAMINA_SIMD_END

#endif
