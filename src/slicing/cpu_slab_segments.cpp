// SPDX-License-Identifier: Apache-2.0
#include "slicing/cpu_slabs.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "slicing/cpu_slab_segments.cpp"
#include "simd/foreach_target.h"

#include "executors/cpu_transfer-inl.h"
#include "slicing/cpu_fetch-inl.h"
#include "slicing/cpu_light-inl.h"
#include "slicing/cpu_slab_block-inl.h"

// Computes colour and optical depth of the segments of a block of slabs, as
// shaders/slicing/segment.glsl does. Each step is done for a whole range of slabs:
//   1. Clip each slab to the ray's part inside the box: middle, boundaries and length.
//   2. Sample the scalar in the middle and, if the plan pre-integrates, at the boundaries.
//   3. Classify the middle, or integrate from boundary to boundary by the table or in closed form.
//   4. Light the colours of visible slabs by the gradients at these points.
// Targets with codes of n bits need optical depths in double precision (SlabBlock::precise_depths),
// computed by the shaders' operations in the shaders' order, so that codes are equal.
LAMINA_SIMD_BEGIN

// Calls visit(i, light's effect at point_at(i)) for i = first .. end - 1, a few at a time.
template <std::size_t channels, PointKind kind, class PointAt, class Visit>
LAMINA_INLINE void visit_light(const CpuLight& light, const CpuBrick& brick,
                               const Float (&to_eye)[3], int first, int end,
                               const PointAt& point_at, const Visit& visit) {
    constexpr int stage = 8;
    alignas(64) std::int32_t index[stage][most_lanes];
    Float weights[stage][3];
    for (int begin = first; begin < end; begin += stage) {
        const int count = std::min(stage, end - begin);
        for (int i = 0; i < count; ++i) {
            const Cell cell = cell_at<kind>(brick, point_at(begin + i));
            store(cell.index, index[i]);
            prefetch_cells<sizeof(StoredGradient)>(brick, brick.gradients, index[i]);
            for (int axis = 0; axis < 3; ++axis) weights[i][axis] = cell.weight[axis];
        }
        for (int i = 0; i < count; ++i) {
            const PointGradient gradient = gradient_at(brick, light, index[i], weights[i]);
            visit(begin + i,
                  effect_of<channels>(light, gradient.along, gradient.smallest_square, to_eye));
        }
    }
}

template <std::size_t channels>
LAMINA_INLINE void light_middle(const EffectLanes<channels>& effect, int slab, SlabBlock& block) {
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Float color = load<Float>(at_slab);
        const Float lit = color + color * effect.change[k] + effect.highlight[k];
        store(max(lit, 0), at_slab);
    }
}

// Lights a slab by the effects of light at both ends, taken as linear between them.
template <std::size_t channels>
LAMINA_INLINE void light_ends(const EffectLanes<channels>& front, const EffectLanes<channels>& back,
                              int slab, SlabBlock& block) {
    const Float share = load<Float>(block.front_shares + at(slab));
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        float* const at_slab = block.colors[c] + at(slab);
        const Float color = load<Float>(at_slab);
        const Float of_front = load<Float>(block.front_colors[c] + at(slab));
        const Float changed =
            color * back.change[k] + of_front * (front.change[k] - back.change[k]);
        const Float highlight =
            back.highlight[k] + share * (front.highlight[k] - back.highlight[k]);
        store(max(color + changed + highlight, 0), at_slab);
    }
}

// Lights each slab i of the present range for which shows(i) is true, at middle(i) or, if the plan
// pre-integrates, at both ends (docs/numerics.md, section 10.7). edge(i): the slab's front point.
template <std::size_t channels, PointKind kind, class Middle, class Edge, class Shows>
LAMINA_INLINE void light_slabs(const CpuSlabs& slabs, const CpuBrick& brick, const PacketRays& rays,
                               const Middle& middle, const Edge& edge, const Shows& shows,
                               SlabBlock& block) {
    const CpuLight& light = *slabs.light;
    Float to_eye[3];
    set_eye(light, rays, to_eye);
    const bool ends = slabs.plan->preintegrates();
    for (int first = block.from; first < block.end;) {
        if (!shows(first)) {
            ++first;
            continue;
        }
        int end = first + 1;
        while (end < block.end && shows(end)) ++end;
        if (ends) {
            EffectLanes<channels> front;
            visit_light<channels, kind>(light, brick, to_eye, first, end + 1, edge,
                                        [&](int i, const EffectLanes<channels>& effect)
                                            LAMINA_LAMBDA {
                                                if (i > first)
                                                    light_ends(front, effect, i - 1, block);
                                                front = effect;
                                            });
        } else {
            visit_light<channels, kind>(light, brick, to_eye, first, end, middle,
                                        [&](int i, const EffectLanes<channels>& effect)
                                            LAMINA_LAMBDA { light_middle(effect, i, block); });
        }
        first = end;
    }
}

template <PointKind kind, class Middle, class Edge, class Shows>
LAMINA_INLINE void light_range(const CpuSlabs& slabs, const CpuBrick& brick, const PacketRays& rays,
                               const Middle& middle, const Edge& edge, const Shows& shows,
                               SlabBlock& block) {
    if (slabs.light->gray)
        return light_slabs<1, kind>(slabs, brick, rays, middle, edge, shows, block);
    light_slabs<3, kind>(slabs, brick, rays, middle, edge, shows, block);
}

// Normalised scalars of a segment, and its length; all 0 if one is NaN and NaN is transparent.
struct SegmentScalars {
    Float front, middle, back, length;
};

LAMINA_INLINE SegmentScalars segment_scalars(const SlabBlock& block, int i, bool nan_transparent) {
    SegmentScalars scalars{
        load<Float>(block.edge_scalars + at(i)), load<Float>(block.scalars + at(i)),
        load<Float>(block.edge_scalars + at(i + 1)), load<Float>(block.lengths + at(i))};
    if (!nan_transparent) return scalars;
    const Float sum = scalars.front + scalars.middle + scalars.back;
    const FloatMask numbers = sum == sum;
    for (Float* const v : {&scalars.front, &scalars.middle, &scalars.back, &scalars.length})
        *v = zero_unless(numbers, *v);
    return scalars;
}

// Makes the scalar linear: moves both ends to keep the mean of the parabola through all three.
LAMINA_INLINE void straighten(SegmentScalars& scalars) {
    const Float mean = 0.5f * (scalars.front + scalars.back);
    const Float bend = 2.0f / 3.0f * (scalars.middle - mean);
    scalars.front = clamp01(scalars.front + bend);
    scalars.back = clamp01(scalars.back + bend);
}

// Integrates a segment in closed form, for transfer functions of one linear piece, as
// integrate_linear_run() of shaders/slicing/segment.glsl does.
LAMINA_INLINE RunSum integrate_linear(const CpuTransfer& transfer, bool colored,
                                      const SegmentScalars& scalars) {
    constexpr Lookup one = Lookup::one;
    const Int piece(0);
    const Float front = share_of_interval<one>(transfer, piece, scalars.front),
                back = share_of_interval<one>(transfer, piece, scalars.back);
    const Float p = optics_at<one>(transfer, 3, piece, front) * scalars.length,
                q = optics_at<one>(transfer, 3, piece, back) * scalars.length;
    RunSum sum;
    sum.depth = 0.5f * p + 0.5f * q;
    if (!colored) return sum;
    const Float opacity = opacity_from_depth(sum.depth);
    const Float weight = min(thin_front_weight(p, q), opacity);
    const Float of_front = weight / max(opacity, 1e-37f);
    const Float place = mix(back, front, of_front);
    for (std::size_t channel = 0; channel < 3; ++channel)
        sum.color[channel] = optics_at<one>(transfer, channel, piece, place);
    return sum;
}

LAMINA_INLINE void store_segment(const RunSum& sum, bool colored, int slab, SlabBlock& block) {
    store(sum.depth, block.depths + at(slab));
    if (!colored) return;
    for (std::size_t channel = 0; channel < 3; ++channel)
        store(sum.color[channel], block.colors[channel] + at(slab));
}
LAMINA_INLINE void store_segment(const LitSum& sum, bool colored, int slab, SlabBlock& block) {
    const RunSum& unlit = sum;
    store_segment(unlit, colored, slab, block);
    for (std::size_t channel = 0; channel < 3; ++channel)
        store(sum.front_color[channel], block.front_colors[channel] + at(slab));
    store(sum.front_share, block.front_shares + at(slab));
}

// Integrates the present range by the table, several slabs at a time, so that their look-ups
// overlap. A segment is invisible if extinction is 0 from its min to its max scalar.
template <Lookup kind, bool lit>
LAMINA_INLINE void integrate_by_table(const CpuTransfer& transfer, bool colored,
                                      bool nan_transparent, SlabBlock& block) {
    constexpr int stage = 8;
    Segment segments[stage];
    EntryPlaces first_places[stage], last_places[stage];
    EntryNumbers<lit> first_entries[stage], last_entries[stage];
    int slabs[stage];
    for (int begin = block.from; begin < block.end;) {
        int count = 0;
        for (; count < stage && begin < block.end; ++begin) {
            SegmentScalars scalars = segment_scalars(block, begin, nan_transparent);
            const Float least = clamp01(min(scalars.middle, min(scalars.front, scalars.back)));
            const Float largest = clamp01(max(scalars.middle, max(scalars.front, scalars.back)));
            const Int first = find_interval<kind>(transfer, least);
            const FloatMask seen =
                (scalars.length > 0) & shows_something<kind>(transfer, first, largest);
            if (none_of(seen)) {
                store_segment(no_sum<false>(), colored, begin, block);
                continue;
            }
            straighten(scalars);
            Segment& segment = segments[count];
            segment = segment_of<kind>(transfer, scalars.front, scalars.back, scalars.length, seen);
            if (colored) {
                const auto set = [&](const TablePiece& piece, EntryPlaces& places) LAMINA_LAMBDA {
                    set_places(transfer, piece.cell, piece.length, places);
                };
                set(segment.first, first_places[count]);
                if (segment.some_cut) set(segment.last, last_places[count]);
            }
            slabs[count++] = begin;
        }
        for (int i = 0; colored && i < count; ++i) {
            const Segment& segment = segments[i];
            look_up_entries(transfer, first_places[i], segment.seen, first_entries[i]);
            if (segment.some_cut)
                look_up_entries(transfer, last_places[i], segment.cut, last_entries[i]);
        }
        for (int i = 0; i < count; ++i) {
            SegmentEntries<lit> entries;
            if (colored) entries.first = load_entry(first_entries[i]);
            if (colored && segments[i].some_cut) entries.last = load_entry(last_entries[i]);
            store_segment(integrate_segment<lit>(transfer, colored, segments[i], entries), colored,
                          slabs[i], block);
        }
    }
}

// Integrates the slabs of the present range from boundary to boundary. Lit plans have a table.
template <Lookup kind>
LAMINA_INLINE void integrate_range(const CpuTransfer& transfer, bool colored, const SlicePlan& plan,
                                   SlabBlock& block) {
    if (colored && plan.lighting)
        return integrate_by_table<kind, true>(transfer, colored, plan.nan_transparent, block);
    if (kind != Lookup::one || !plan.linear)
        return integrate_by_table<kind, false>(transfer, colored, plan.nan_transparent, block);
    for (int i = block.from; i < block.end; ++i) {
        SegmentScalars scalars = segment_scalars(block, i, plan.nan_transparent);
        straighten(scalars);
        store_segment(integrate_linear(transfer, colored, scalars), colored, i, block);
    }
}

// Rays whose depths count from the front of a block.
struct BlockRays {
    Float base[3];       // point at depth 0, in the brick's index space
    Float enter, leave;  // depths between which the ray is in the box
};

LAMINA_INLINE BlockRays block_rays(const CpuRays& frame, const PacketRays& rays, int first_slab) {
    const double front = first_slab * frame.slab_thickness;
    BlockRays block;
    for (int axis = 0; axis < 3; ++axis)
        block.base[axis] = to_float(rays.origin[axis] + front * rays.direction[axis]);
    block.enter = to_float(rays.enter - front);
    block.leave = to_float(rays.leave - front);
    return block;
}

// Return the depth of the boundary in front of a slab, clamped to the rays' part in the box.
LAMINA_INLINE Float boundary(const CpuRays& frame, const BlockRays& rays, int i) {
    return clamp(frame.edges[static_cast<std::size_t>(i)], rays.enter, rays.leave);
}
LAMINA_INLINE Float64 boundary(const CpuRays& frame, const PacketRays& rays, int slab) {
    return boundary(frame, DepthSpan{rays.enter, rays.leave}, slab);
}

LAMINA_INLINE Points point_at(const BlockRays& block, const PacketRays& rays, Float depth) {
    Points point;
    for (int axis = 0; axis < 3; ++axis)
        point.at[axis] = depth * rays.direction_float[axis] + block.base[axis];
    return point;
}
LAMINA_INLINE Points point_at(const PacketRays& rays, const Float64& depth) {
    Points point;
    for (int axis = 0; axis < 3; ++axis)
        point.at[axis] = to_float(rays.origin[axis] + depth * rays.direction[axis]);
    return point;
}

// Tells whether all rays are in the box, and among the brick's samples, in the whole present range.
LAMINA_INLINE bool is_inside(const CpuRays& frame, const CpuBrick& brick, const SlabBlock& block,
                             const BlockRays& rays, const PacketRays& packet) {
    const Float front(frame.edges[static_cast<std::size_t>(block.from)]);
    const Float back(frame.edges[static_cast<std::size_t>(block.end)]);
    FloatMask inside = (rays.enter <= front) & (rays.leave >= back);
    for (const Float depth : {front, back}) {
        const Points point = point_at(rays, packet, depth);
        for (std::size_t axis = 0; axis < 3; ++axis)
            inside = inside & ((point.at[axis] >= 0) & (point.at[axis] < brick.last_sample[axis]));
    }
    return all_of(inside);
}

// Sets lengths and, unless rays are `inside` throughout (is_inside()), the depths of boundaries and
// middles. Returns the number of segments longer than 0.
LAMINA_INLINE std::int64_t set_lengths(const CpuRays& frame, const BlockRays& rays,
                                       Float length_per_depth, bool inside, SlabBlock& block) {
    if (inside) {
        for (int i = block.from; i < block.end; ++i) {
            const auto place = static_cast<std::size_t>(i);
            const float thickness = frame.edges[place + 1] - frame.edges[place];
            store(thickness * length_per_depth, block.lengths + at(i));
        }
        return static_cast<std::int64_t>(Float::lanes) * (block.end - block.from);
    }
    std::int64_t segments = 0;
    Float front = boundary(frame, rays, block.from);
    store(front, block.edges + at(block.from));
    for (int i = block.from; i < block.end; ++i) {
        const Float back = boundary(frame, rays, i + 1);
        const Float thickness = back - front;
        segments += static_cast<std::int64_t>(count_of(thickness > 0));
        store(back, block.edges + at(i + 1));
        store(0.5f * (front + back), block.middles + at(i));
        store(thickness * length_per_depth, block.lengths + at(i));
        front = back;
    }
    return segments;
}

// Sets precise_depths and, rounded, `lengths` to world lengths. Returns how many are above 0.
LAMINA_INLINE std::int64_t set_precise_lengths(const CpuRays& frame, const PacketRays& rays,
                                               SlabBlock& block) {
    std::int64_t segments = 0;
    Float64 front = boundary(frame, rays, block.first_slab + block.from);
    for (int i = block.from; i < block.end; ++i) {
        const Float64 back = boundary(frame, rays, block.first_slab + i + 1);
        const Float64 length = (back - front) * rays.length_per_depth;
        store(length, block.precise_depths + at(i));
        const Float rounded = to_float(length);
        segments += static_cast<std::int64_t>(count_of(rounded > 0));
        store(rounded, block.lengths + at(i));
        front = back;
    }
    return segments;
}

// Drops segments whose middles lie in another renderer's share: their length becomes 0. Renderers
// compute equal middles and equal crossings of shares' planes, so each segment is drawn once.
LAMINA_INLINE void keep_share(const CpuRays& frame, const PacketRays& packet, bool inside,
                              SlabBlock& block) {
    const double front = block.first_slab * frame.slab_thickness;
    const Float enter = to_float(packet.share.enter - front);
    const Float leave = to_float(packet.share.leave - front);
    for (int i = block.from; i < block.end; ++i) {
        const Float middle = inside ? Float(frame.middles[static_cast<std::size_t>(i)])
                                    : load<Float>(block.middles + at(i));
        const FloatMask own = (middle >= enter) & (middle < leave);
        store(zero_unless(own, load<Float>(block.lengths + at(i))), block.lengths + at(i));
    }
}

// Calls use(kind of points, middle, edge): middle(i) is the middle of slab i, edge(i) its front.
template <class Use>
LAMINA_INLINE void with_points(const CpuRays& frame, const BlockRays& rays,
                               const PacketRays& packet, bool inside, const SlabBlock& block,
                               const Use& use) {
    if (inside) {
        const auto among = [&](const float* depths) LAMINA_LAMBDA {
            return [&, depths](int i)
                       LAMINA_LAMBDA { return point_at(rays, packet, Float(depths[i])); };
        };
        return use(std::integral_constant<PointKind, PointKind::inside>(),
                   among(frame.middles.data()), among(frame.edges.data()));
    }
    const auto among = [&](const float* depths) LAMINA_LAMBDA {
        return [&, depths](int i)
                   LAMINA_LAMBDA { return point_at(rays, packet, load<Float>(depths + at(i))); };
    };
    use(std::integral_constant<PointKind, PointKind::anywhere>(), among(block.middles),
        among(block.edges));
}

template <class Use>
LAMINA_INLINE void with_precise_points(const CpuRays& frame, const PacketRays& rays,
                                       const SlabBlock& block, const Use& use) {
    const auto middle = [&](int i) LAMINA_LAMBDA {
        const Float64 front = boundary(frame, rays, block.first_slab + i);
        const Float64 back = boundary(frame, rays, block.first_slab + i + 1);
        return point_at(rays, 0.5 * (front + back));
    };
    const auto edge = [&](int i) LAMINA_LAMBDA {
        return point_at(rays, boundary(frame, rays, block.first_slab + i));
    };
    use(std::integral_constant<PointKind, PointKind::exact>(), middle, edge);
}

// Set a slab's optical depth. Until then precise_depths holds the slab's length.
LAMINA_INLINE void set_depth(Float extinction, int slab, SlabBlock& block) {
    store(extinction * load<Float>(block.lengths + at(slab)), block.depths + at(slab));
}
LAMINA_INLINE void set_depth(const Float64& extinction, int slab, SlabBlock& block) {
    double* const depth = block.precise_depths + at(slab);
    store(extinction * load_float64(depth), depth);
}

// Sets optical depths and colours from the scalars in the middles of slabs: post-classification.
template <bool precise, Lookup kind>
LAMINA_INLINE void classify(const CpuTransfer& transfer, bool colored, bool nan_transparent,
                            SlabBlock& block) {
    for (int i = block.from; i < block.end; ++i) {
        Float scalar = load<Float>(block.scalars + at(i));
        const FloatMask number = scalar == scalar;
        if (nan_transparent) scalar = zero_unless(number, scalar);
        scalar = clamp01(scalar);
        const Int interval = find_interval<kind>(transfer, scalar);
        const Float share = share_of_interval<kind>(transfer, interval, scalar);
        if constexpr (precise) {
            Float64 extinction = precise_extinction_at<kind>(transfer, interval, share);
            if (nan_transparent) extinction *= Float64(zero_unless(number, Float(1)));
            set_depth(extinction, i, block);
        } else {
            Float extinction = optics_at<kind>(transfer, 3, interval, share);
            if (nan_transparent) extinction = zero_unless(number, extinction);
            set_depth(extinction, i, block);
        }
        for (std::size_t channel = 0; colored && channel < 3; ++channel)
            store(optics_at<kind>(transfer, channel, interval, share),
                  block.colors[channel] + at(i));
    }
}

// Sets optical depths and colours if the transfer function is constant over the volume.
template <class Number>
LAMINA_INLINE void set_constant(const CpuSlabs& slabs, Number extinction, SlabBlock& block) {
    for (int i = block.from; i < block.end; ++i) {
        set_depth(extinction, i, block);
        for (std::size_t channel = 0; channel < 3; ++channel)
            store(Float(slabs.single_color[channel]), block.colors[channel] + at(i));
    }
}

// Sets depths and colours of the present range. Returns the number of segments longer than 0.
template <bool precise>
std::int64_t set_range(const CpuSlabs& slabs, const CpuBrickView& view, const PacketRays& packet,
                       bool colored, SlabBlock& block) {
    const SlicePlan& plan = *slabs.plan;
    const CpuBrick& brick = view.brick;
    const bool sampled = plan.sampling != VolumeSampling::none;
    BlockRays rays;
    bool inside = false;
    std::int64_t segments = 0;
    if constexpr (precise) {
        segments = set_precise_lengths(slabs.rays, packet, block);
        if (!sampled) set_constant(slabs, Float64(slabs.constant_extinction), block);
    } else {
        rays = block_rays(slabs.rays, packet, block.first_slab);
        inside = sampled && is_inside(slabs.rays, brick, block, rays, packet);
        segments = set_lengths(slabs.rays, rays, packet.length_float, inside, block);
        if (view.share) keep_share(slabs.rays, packet, inside, block);
        if (!sampled)
            set_constant(slabs, Float(static_cast<float>(slabs.constant_extinction)), block);
    }
    if (!sampled) return segments;
    const auto with = [&](const auto& use) LAMINA_LAMBDA {
        if constexpr (precise)
            with_precise_points(slabs.rays, packet, block, use);
        else
            with_points(slabs.rays, rays, packet, inside, block, use);
    };
    with([&](auto kind, const auto& middle, const auto& edge) LAMINA_LAMBDA {
        const bool hardware = plan.sampling == VolumeSampling::hardware;
        sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end, middle,
                                             block.scalars);
        if (!plan.preintegrates()) return;
        sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end + 1, edge,
                                             block.edge_scalars);
    });
    const CpuTransfer& transfer = *slabs.transfer;
    with_lookup(transfer, [&](auto kind) LAMINA_LAMBDA {
        constexpr Lookup lookup = decltype(kind)::value;
        if (plan.preintegrates()) {
            integrate_range<lookup>(transfer, colored, plan, block);
            if constexpr (precise) set_precise_depths(block.from, block.end, block);
        } else {
            classify<precise, lookup>(transfer, colored, plan.nan_transparent, block);
        }
    });
    if (!colored || slabs.light == nullptr) return segments;
    const auto shows = [&](int i) LAMINA_LAMBDA {
        if constexpr (precise)
            return any_of(to_float(load_float64(block.precise_depths + at(i))) > 0);
        else
            return any_of(load<Float>(block.depths + at(i)) > 0);
    };
    with([&](auto kind, const auto& middle, const auto& edge) LAMINA_LAMBDA {
        light_range<decltype(kind)::value>(slabs, brick, packet, middle, edge, shows, block);
    });
    return segments;
}

void set_constant_range(const CpuSlabs& slabs, const OpticalProperties& optics,
                        const PacketRays& packet, bool colored, int first, int end,
                        SlabBlock& block) {
    const BlockRays rays = block_rays(slabs.rays, packet, block.first_slab);
    const Float length =
        (boundary(slabs.rays, rays, end) - boundary(slabs.rays, rays, first)) * packet.length_float;
    store(static_cast<float>(optics.extinction) * length, block.depths + at(first));
    block.wanted &= ~block_mask(first + 1, end);
    for (int channel = 0; colored && channel < 3; ++channel)
        store(Float(static_cast<float>(optics.color[channel])), block.colors[channel] + at(first));
}

std::int64_t set_segments(const CpuSlabs& slabs, const CpuBrickView& brick,
                          const PacketRays& packet, bool colored, bool precise, SlabBlock& block) {
    std::int64_t segments = 0;
    for_each_range(block.wanted, [&](int first, int end) {
        block.from = first;
        block.end = end;
        segments += precise ? set_range<true>(slabs, brick, packet, colored, block)
                            : set_range<false>(slabs, brick, packet, colored, block);
    });
    return segments;
}

LAMINA_SIMD_END
