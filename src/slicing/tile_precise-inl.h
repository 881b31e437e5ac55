// SPDX-License-Identifier: Apache-2.0
// Segments in double precision, for codes of n bits. They are computed like the shaders', so that
// the codes are the same.
#if defined(LAMINA_SLICING_TILE_PRECISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PRECISE_INL_H_
#undef LAMINA_SLICING_TILE_PRECISE_INL_H_
#else
#define LAMINA_SLICING_TILE_PRECISE_INL_H_
#endif

#include "executors/tile_optics-inl.h"
#include "slicing/cpu_fetch-inl.h"
#include "slicing/tile_lit_slabs-inl.h"
#include "slicing/tile_runs-inl.h"

LAMINA_SIMD_BEGIN

// Returns the depth of the boundary in front of a slab, clamped to the box.
LAMINA_INLINE Float64 boundary(const TileRays& frame, const PacketRays& rays, int slab) {
    return boundary(frame, DepthSpan{rays.enter, rays.leave}, slab);
}

LAMINA_INLINE Points precise_point(const PacketRays& rays, const Float64& depth) {
    Float point[3];
    for (int axis = 0; axis < 3; ++axis) {
        point[axis] = to_float(rays.origin[axis] + depth * rays.direction[axis]);
    }
    return {point[0], point[1], point[2]};
}

// Writes world lengths to precise_depths, and rounded ones to lengths. Returns the number of
// segments that have a length.
LAMINA_INLINE std::int64_t set_precise_lengths(const TileRays& frame, const PacketRays& rays,
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

// Calls use(middle, edge): middle(i) is the point in the middle of slab i, edge(i) the one in front
// of it.
template <class Use>
LAMINA_INLINE void with_precise_points(const TileRays& frame, const PacketRays& rays,
                                       const SlabBlock& block, const Use& use) {
    const auto middle = [&](int i) LAMINA_LAMBDA {
        const Float64 front = boundary(frame, rays, block.first_slab + i);
        const Float64 back = boundary(frame, rays, block.first_slab + i + 1);
        return precise_point(rays, 0.5 * (front + back));
    };
    const auto edge = [&](int i) LAMINA_LAMBDA {
        return precise_point(rays, boundary(frame, rays, block.first_slab + i));
    };
    use(middle, edge);
}

LAMINA_INLINE void set_precise_scalars(const TileSlabs& slabs, const TileBrick& brick,
                                       const PacketRays& rays, SlabBlock& block) {
    const bool hardware = slabs.plan->sampling == VolumeSampling::hardware;
    with_precise_points(
        slabs.rays, rays, block, [&](const auto& middle, const auto& edge) LAMINA_LAMBDA {
            sample_points<PointKind::exact>(brick, hardware, block.from, block.end, middle,
                                            block.scalars);
            if (!slabs.plan->integrates_runs()) return;
            sample_points<PointKind::exact>(brick, hardware, block.from, block.end + 1, edge,
                                            block.edge_scalars);
        });
}

LAMINA_INLINE void add_precise_light(const TileSlabs& slabs, const TileBrick& brick,
                                     const PacketRays& rays, SlabBlock& block) {
    const auto shows = [&](int i) LAMINA_LAMBDA {
        const Float depth = to_float(load_float64(block.precise_depths + at(i)));
        return any_of(depth > 0);
    };
    with_precise_points(
        slabs.rays, rays, block, [&](const auto& middle, const auto& edge) LAMINA_LAMBDA {
            light_run<PointKind::exact>(slabs, brick, rays, middle, edge, shows, block);
        });
}

LAMINA_INLINE void scale_precise_depth(const Float64& extinction, int slab, SlabBlock& block) {
    const Float64 length = load_float64(block.precise_depths + at(slab));
    store(extinction * length, block.precise_depths + at(slab));
}

// Takes over optical depths that were computed in float.
LAMINA_INLINE void set_precise_depths(int first, int end, SlabBlock& block) {
    for (int i = first; i < end; ++i) {
        store(Float64(load<Float>(block.depths + at(i))), block.precise_depths + at(i));
    }
}
inline void set_precise_depths(SlabBlock& block) {
    for_each_run(block.wanted,
                 [&](int first, int end) LAMINA_LAMBDA { set_precise_depths(first, end, block); });
}

template <Lookup kind>
LAMINA_INLINE void classify_precisely(const TileTransfer& transfer, bool colored,
                                      bool nan_transparent, SlabBlock& block) {
    for (int i = block.from; i < block.end; ++i) {
        Float scalar = load<Float>(block.scalars + at(i));
        const FloatMask number = scalar == scalar;
        if (nan_transparent) scalar = zero_unless(number, scalar);
        scalar = clamp01(scalar);
        const Int interval = find_interval<kind>(transfer, scalar);
        const Float share = share_of_interval<kind>(transfer, interval, scalar);
        Float64 extinction = precise_extinction_at<kind>(transfer, interval, share);
        if (nan_transparent) {
            const Float64 seen(zero_unless(number, Float(1)));
            extinction = extinction * seen;
        }
        scale_precise_depth(extinction, i, block);
        if (!colored) continue;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            store(optics_at<kind>(transfer, channel, interval, share),
                  block.colors[channel] + at(i));
        }
    }
}

// Sets a run as set_run() does, with optical depths in double precision.
inline std::int64_t set_precise_run(const TileSlabs& slabs, const TileBrickView& brick,
                                    const PacketRays& rays, bool colored, SlabBlock& block) {
    const SlicePlan& plan = *slabs.plan;
    const std::int64_t segments = set_precise_lengths(slabs.rays, rays, block);
    if (plan.sampling == VolumeSampling::none) {
        const Float64 extinction = slabs.constant_extinction;
        for (int i = block.from; i < block.end; ++i) {
            scale_precise_depth(extinction, i, block);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                store(Float(slabs.single_color[channel]), block.colors[channel] + at(i));
            }
        }
        return segments;
    }
    set_precise_scalars(slabs, brick.brick, rays, block);
    const TileTransfer& transfer = *slabs.transfer;
    with_lookup(transfer, [&](auto kind) LAMINA_LAMBDA {
        constexpr Lookup lookup = decltype(kind)::value;
        if (plan.integrates_runs()) {
            integrate_runs<lookup>(transfer, colored, plan, block);
            set_precise_depths(block.from, block.end, block);
        } else {
            classify_precisely<lookup>(transfer, colored, plan.nan_transparent, block);
        }
    });
    if (colored && slabs.light != nullptr) add_precise_light(slabs, brick.brick, rays, block);
    return segments;
}

// Sets segments as set_segments() does, with optical depths in double precision.
inline std::int64_t set_precise_segments(const TileSlabs& slabs, const TileBrickView& brick,
                                         const PacketRays& rays, bool colored, SlabBlock& block) {
    std::int64_t segments = 0;
    for_each_run(block.wanted, [&](int first, int end) {
        block.from = first;
        block.end = end;
        segments += set_precise_run(slabs, brick, rays, colored, block);
    });
    return segments;
}

LAMINA_SIMD_END

#endif
