// SPDX-License-Identifier: Apache-2.0
// Integrates the rays of some packets through one brick cell by cell, without slabs
// (docs/numerics.md, section 9; numbers in brackets are equations there).
//
//   repeat until the rays end:
//       walk some steps: a segment for each visible cell                      cpu_walk-inl.h
//       fetch the corners of their cells: the scalar as a cubic (9.1)       cpu_fetch-inl.h
//       for each segment:
//           if it stays in one interval of the transfer function (9.5) and is shallow:
//               depth, opacity and colour by one rule (9.2, 9.3)            cpu_optics-inl.h
//               add light (10.2); if that bends too much: cut it            cpu_light-inl.h
//           else: cut it                                                    cpu_cut-inl.h
//       composite each ray's segments front to back
//
// To draw something else of each cell, replace integrate(); RaySum, put_behind() and
// add_segments(), which add up its results; and what CellMap counts as empty and as constant.
#if defined(LAMINA_SLICING_CPU_CELLS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_CELLS_INL_H_
#undef LAMINA_SLICING_CPU_CELLS_INL_H_
#else
#define LAMINA_SLICING_CPU_CELLS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <variant>

#include "slicing/cpu_cut-inl.h"
#include "slicing/cpu_slab_block-inl.h"

LAMINA_SIMD_BEGIN

// Associated colour, opacity and optical depth that a part of each ray adds up to.
struct RaySum {
    Float color[3];
    Float opacity, depth;
};

LAMINA_INLINE RaySum empty_sum() {
    const Float zero(0);
    return {{zero, zero, zero}, zero, zero};
}

LAMINA_INLINE void put_behind(const RaySum& next, RaySum& sum) {
    const Float kept = 1 - sum.opacity;
    for (int channel = 0; channel < 3; ++channel) sum.color[channel] += kept * next.color[channel];
    sum.opacity += kept * next.opacity;
    sum.depth += next.depth;
}

// Integrates up to most_packets packets side by side. begin() and next() are compiled once for all
// callers, in cpu_cells.cpp.
template <bool lit>
class CellIntegrator {
  public:
    static constexpr std::size_t most_packets = CellSegments::most_packets;

    // `colored`: colours are needed, and not optical depths alone.
    CellIntegrator(const CpuSlabs& slabs, bool colored) : slabs_(slabs), colored_(colored) {}

    // Begins packets of rays at the front of a slab, or at the drawn box if that is farther away.
    void begin(const CpuBrickView& view, const PacketRays* packets, std::size_t count, int slab);
    // Ends rays at the front of slab `slab`, which must not lie in front of what was integrated.
    void set_end(int slab) {
        for (std::size_t i = 0; i < packets_; ++i)
            walks_[i].set_end(boundary(slabs_.rays, spans_[i], slab));
    }
    // Ends the rays of a packet whose value in `depths` is at least `limit`.
    void end_where(std::size_t packet, const Float64& depths, double limit) {
        walks_[packet].end_where(depths, limit);
    }
    bool done() const {
        for (std::size_t i = 0; i < packets_; ++i) {
            if (!walks_[i].done()) return false;
        }
        return true;
    }

    // Returns the sums over the next few cells of each ray, for each packet.
    void next(RaySum* sums);

    std::int64_t segments() const { return count_; }

  private:
    DepthSpan span_from(const PacketRays& rays, int slab) const {
        const Float64 front = slab * slabs_.rays.slab_thickness;
        const Float64 enter = max(front, max(rays.enter, rays.drawn.enter));
        return {enter, max(enter, min(rays.leave, rays.drawn.leave))};
    }

    void walk() {
        segments_.steps = 0;
        segments_.count = 0;
        for (std::size_t i = 0; i < packets_; ++i) walks_[i].begin_steps();
        for (bool some = true; some && segments_.steps < CellSegments::most_steps;) {
            some = false;
            for (std::size_t i = 0; i < packets_; ++i) {
                StoredLanes& lanes = segments_.lanes[segments_.steps][i];
                lanes.set = 0;
                if (walks_[i].steps_done()) continue;
                lanes = walks_[i].step(segments_);
                some = true;
            }
            segments_.steps += some;
        }
        for (std::size_t i = 0; i < packets_; ++i) walks_[i].end_steps();
    }

    void set_cubics() {
        const CpuBrick& brick = view_->brick;
        // True if samples have no neighbour along x. In pages they always have one.
        const bool flat = brick.last_sample[0] == 0 && brick.pages == nullptr;
        with_layout(brick.layout, [&](auto of_samples) LAMINA_LAMBDA {
            constexpr CpuLayout layout = decltype(of_samples)::value;
            flat ? set_cubics_by_gathers<layout>(brick) : set_cubics_of<layout>(brick);
        });
    }

    // Fetches pairs of neighbours along x one by one, some vectors at a time: faster than gathers.
    template <CpuLayout layout>
    void set_cubics_of(const CpuBrick& brick) {
        PairOf<layout> pairs[4][fetched_together];
        for (std::size_t from = 0; from < segments_.count; from += fetched_together) {
            const std::size_t count = std::min(fetched_together, segments_.count - from);
            fetch_pairs(brick, segments_.index + from, count, pairs);
            for (std::size_t i = 0; i < count; i += Float::lanes) {
                set_cubic(brick, unpack_pairs<layout>(brick, pairs, i), from + i);
            }
        }
    }

    // Sets the cubics of all segments of a brick whose samples have no neighbour along x.
    template <CpuLayout layout>
    void set_cubics_by_gathers(const CpuBrick& brick) {
        for_each_vector([&](std::size_t i) LAMINA_LAMBDA {
            const Int index = load<Int>(segments_.index + i);
            const FloatMask stored = members_from(i);
            set_cubic(brick, fetch_corners<layout>(brick, zero_unless(stored, index)), i);
        });
    }

    LAMINA_INLINE void set_cubic(const CpuBrick& brick, Corners corners, std::size_t i) {
        const auto [place, change] = segments_.paths_from(i);
        if (brick.nearest) take_sample(place, corners);
        // The cubic is computed from codes minus `base` and then scaled; scale is a power of two
        // (exact_range()), so that is exact. Floats are normalised already: scale 1, offset 0.
        const Float base(-brick.offset / brick.scale);
        CubicLanes cubic = cubic_along(corners, base, place, change);
        for (Float& c : cubic.c) c *= brick.scale;
        if (slabs_.transfer->steps) {
            const RangeLanes limits = limits_of(corners, base, brick.scale, place, change);
            store(limits.lo, segments_.limits[0] + i);
            store(limits.hi, segments_.limits[1] + i);
        }
        if (slabs_.plan->nan_transparent) set_transparent(corners, cubic, i);
        for (std::size_t power = 0; power < 4; ++power)
            store(cubic.c[power], segments_.cubic[power] + i);
    }

    // Gives all corners of a voxel the value of its sample, the corner at `place` (0 or 1).
    static LAMINA_INLINE void take_sample(const Float (&place)[3], Corners& corners) {
        const FloatMask upper_x = place[0] > 0.5f, upper_y = place[1] > 0.5f;
        const FloatMask upper_z = place[2] > 0.5f;
        Float value[4];
        for (int i = 0; i < 4; ++i) value[i] = select(upper_x, corners.upper[i], corners.lower[i]);
        const Float sample = select(upper_z, select(upper_y, value[3], value[2]),
                                    select(upper_y, value[1], value[0]));
        for (int i = 0; i < 4; ++i) corners.lower[i] = corners.upper[i] = sample;
    }

    // Removes segments of cells with a NaN at a corner: their length, scalar and limits become 0.
    LAMINA_INLINE void set_transparent(const Corners& corners, CubicLanes& cubic, std::size_t i) {
        Float sum(0);
        for (int corner = 0; corner < 4; ++corner)
            sum += corners.lower[corner] + corners.upper[corner];
        const FloatMask finite = sum == sum;
        for (Float& c : cubic.c) c = zero_unless(finite, c);
        const auto clear = [&](float* column) LAMINA_LAMBDA {
            store(zero_unless(finite, load<Float>(column + i)), column + i);
        };
        clear(segments_.length);
        if (!slabs_.transfer->steps) return;
        for (float* const limit : segments_.limits) clear(limit);
    }

    // Integrates segments by one rule. Those that leave their interval of the transfer function,
    // are too deep, or whose light bends too much are `hard`: they are cut into pieces instead.
    template <Lookup kind, bool curved>
    void integrate(const CpuTransfer& transfer) {
        cut_.clear();
        for_each_vector([&](std::size_t i) LAMINA_LAMBDA {
            const CubicLanes cubic = cubic_of(i);
            RangeLanes range = range_of(cubic);
            if (transfer.steps) {
                const RangeLanes limits{load<Float>(segments_.limits[0] + i),
                                        load<Float>(segments_.limits[1] + i)};
                range = {limits.clamped(range.lo), limits.clamped(range.hi)};
            }
            const Float lowest = clamp01(range.lo);
            const Int first = find_interval<kind>(transfer, lowest);
            const IntervalLanes<curved> interval = interval_lanes<kind, curved>(transfer, first);
            const FloatMask crosses = range.hi > interval.right_end;
            const Float length = load<Float>(segments_.length + i);
            const PieceOptics<curved> piece(interval, interval.share_along(cubic), length);
            const Float depth = piece.depth();
            const FloatMask stored = members_from(i);
            FloatMask hard = crosses;
            if (any_of(crosses))
                hard = crosses & shows_something<kind>(transfer, first, clamp01(range.hi));
            const Float shown_depth = zero_unless(!crosses, depth);
            if (colored_) hard = hard | (shown_depth > largest_piece_depth);
            hard = stored & hard;
            store(shown_depth, segments_.depth + i);
            if (colored_) set_colors(interval, piece, shown_depth, i);
            typename CutSegments<lit>::Segment segment;
            segment.scalar = cubic;
            segment.length = length;
            segment.place = iota<Int>(static_cast<std::int32_t>(i));
            if constexpr (lit) {
                segment.longest = 1;
                if (colored_) add_light_to(interval, piece, shown_depth, i, segment, hard);
            }
            if (any_of(hard)) cut_.add(segment, hard);
        });
        if (!cut_.empty())
            cut_.template run<kind, curved>(transfer, slabs_.light, colored_, segments_);
    }

    // Lights the colours of visible segments. Adds to `hard` the segments whose light bends too
    // much, and sets the gradient and the length of the first piece, with which they are cut.
    template <bool curved>
    LAMINA_INLINE void add_light_to(const IntervalLanes<curved>& interval,
                                    const PieceOptics<curved>& piece, Float depth, std::size_t i,
                                    LitCutSegment& segment, FloatMask& hard) {
        const FloatMask seen = members_from(i) & (depth > 0);
        if (none_of(seen | hard)) return;
        const CpuLight& light = *slabs_.light;
        segment.gradient =
            set_gradients(view_->brick, seen | hard, i, light, segments_, gradient_rows_);
        Float color[3];
        for (std::size_t channel = 0; channel < 3; ++channel)
            color[channel] = load<Float>(segments_.color[channel] + i);
        const Float opacity = load<Float>(segments_.opacity + i);
        const Float bend =
            add_light(light, segment.gradient,
                      LitPiece<curved>{piece, interval, 0, 1, depth, opacity}, color);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store(zero_unless(seen, color[channel]), segments_.color[channel] + i);
        hard = hard | (seen & bends(light, bend, opacity));
        segment.longest = longest_piece(light, bend);
    }

    // Sets opacity and colour of segments by one rule; 0 if they are invisible.
    template <bool curved>
    LAMINA_INLINE void set_colors(const IntervalLanes<curved>& interval,
                                  const PieceOptics<curved>& piece, Float depth, std::size_t i) {
        const FloatMask seen = depth > 0;
        if (none_of(seen)) {
            for (auto& channel : segments_.color) store(Float(0), channel + i);
            store(Float(0), segments_.opacity + i);
            return;
        }
        const Float opacity = opacity_from_depth(depth);
        const Float seen_color = zero_unless(seen, seen_share<4>(piece, depth, opacity));
        store(opacity, segments_.opacity + i);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store(interval.color(channel, opacity, seen_color), segments_.color[channel] + i);
    }

    template <bool colored>
    void sum_segments(RaySum* sums) const {
        for (std::size_t packet = 0; packet < packets_; ++packet) sums[packet] = empty_sum();
        std::size_t from = 0;
        for (int i = 0; i < segments_.steps; ++i) {
            for (std::size_t packet = 0; packet < packets_; ++packet) {
                const StoredLanes& lanes = segments_.lanes[i][packet];
                if (lanes.set == 0) continue;
                add_segments<colored>(lanes, from, sums[packet]);
                from += static_cast<std::size_t>(std::popcount(lanes.set));
            }
        }
    }
    template <bool colored>
    LAMINA_INLINE void add_segments(const StoredLanes& lanes, std::size_t from, RaySum& sum) const {
        RaySum next = empty_sum();
        next.depth = load_members(segments_.depth + from, lanes);
        if constexpr (colored) {
            next.opacity = load_members(segments_.opacity + from, lanes);
            for (int channel = 0; channel < 3; ++channel)
                next.color[channel] = load_members(segments_.color[channel] + from, lanes);
            put_behind(next, sum);
        } else {
            sum.depth += next.depth;
        }
    }

    template <class Body>
    LAMINA_INLINE void for_each_vector(const Body& body) {
        for (std::size_t i = 0; i < segments_.count; i += Float::lanes) body(i);
    }

    LAMINA_INLINE CubicLanes cubic_of(std::size_t i) const {
        CubicLanes cubic;
        for (std::size_t power = 0; power < 4; ++power)
            cubic.c[power] = load<Float>(segments_.cubic[power] + i);
        return cubic;
    }

    // Returns the lanes of the vector from segment i on that hold a segment.
    LAMINA_INLINE FloatMask members_from(std::size_t i) const {
        return first_lanes<FloatMask>(segments_.count - i);
    }

    static constexpr std::size_t fetched_together = 8 * most_lanes;

    const CpuSlabs& slabs_;
    bool colored_;
    const CpuBrickView* view_ = nullptr;
    std::size_t packets_ = 0;
    DepthSpan spans_[most_packets];
    CellWalk<lit> walks_[most_packets];
    CellSegments segments_;
    CutSegments<lit> cut_;
    struct Nothing {};
    alignas(64) std::conditional_t<lit, GradientRows, Nothing> gradient_rows_ = {};
    std::int64_t count_ = 0;
};

using AnyCellIntegrator = std::variant<CellIntegrator<false>, CellIntegrator<true>>;

LAMINA_INLINE AnyCellIntegrator cell_integrator(const CpuSlabs& slabs, bool colored) {
    if (slabs.light != nullptr)
        return AnyCellIntegrator(std::in_place_type<CellIntegrator<true>>, slabs, colored);
    return AnyCellIntegrator(std::in_place_type<CellIntegrator<false>>, slabs, colored);
}

// Sets depths and colours of a block's wanted slabs. Returns the number of segments, one a cell.
template <bool lit>
std::int64_t set_exact_segments(const CpuBrickView& brick, const PacketRays& packet, bool colored,
                                CellIntegrator<lit>& cells, SlabBlock& block) {
    const std::int64_t before = cells.segments();
    for_each_range(block.wanted, [&](int first, int end) LAMINA_LAMBDA {
        cells.begin(brick, &packet, 1, block.first_slab + first);
        for (int i = first; i < end; ++i) {
            cells.set_end(block.first_slab + i + 1);
            RaySum sum = empty_sum();
            while (!cells.done()) {
                RaySum next;
                cells.next(&next);
                put_behind(next, sum);
            }
            store(sum.depth, block.depths + at(i));
            if (!colored) continue;
            const Float opacity = max(sum.opacity, 1e-37f);
            for (int channel = 0; channel < 3; ++channel)
                store(sum.color[channel] / opacity, block.colors[channel] + at(i));
        }
    });
    return cells.segments() - before;
}

LAMINA_SIMD_END

#endif
