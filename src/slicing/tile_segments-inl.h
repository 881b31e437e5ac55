// SPDX-License-Identifier: Apache-2.0
// The segments of a block of slabs along the rays of a vector of pixels: colour and optical depth,
// as in shaders/slicing/segment.glsl. Each stage is done for the whole block, so that many slabs
// are computed at a time.
#if defined(LAMINA_SLICING_TILE_SEGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_SEGMENTS_INL_H_
#undef LAMINA_SLICING_TILE_SEGMENTS_INL_H_
#else
#define LAMINA_SLICING_TILE_SEGMENTS_INL_H_
#endif

#include "executors/tile_optics-inl.h"
#include "slicing/cpu_fetch-inl.h"
#include "slicing/tile_lit_slabs-inl.h"
#include "slicing/tile_runs-inl.h"

LAMINA_SIMD_BEGIN

// Rays with depths relative to the front of a block.
struct BlockRays {
    Float base[3];
    Float enter, leave;
};

LAMINA_INLINE BlockRays block_rays(const PacketRays& rays, double front) {
    BlockRays block;
    for (int axis = 0; axis < 3; ++axis)
        block.base[axis] = to_float(rays.origin[axis] + front * rays.direction[axis]);
    block.enter = to_float(rays.enter - front);
    block.leave = to_float(rays.leave - front);
    return block;
}

LAMINA_INLINE Points point_at(const BlockRays& block, const PacketRays& rays, Float depth) {
    return {depth * rays.direction_float[0] + block.base[0],
            depth * rays.direction_float[1] + block.base[1],
            depth * rays.direction_float[2] + block.base[2]};
}

// Tells whether all rays are, throughout the block's slabs, inside the box and between samples.
LAMINA_INLINE bool is_inside(const TileRays& frame, const TileBrick& brick, const SlabBlock& block,
                             const BlockRays& rays, const PacketRays& packet) {
    const Float front(frame.edges[static_cast<std::size_t>(block.from)]);
    const Float back(frame.edges[static_cast<std::size_t>(block.end)]);
    FloatMask inside = (rays.enter <= front) & (rays.leave >= back);
    for (const Float depth : {front, back}) {
        const Points point = point_at(rays, packet, depth);
        const Float places[3] = {point.x, point.y, point.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const FloatMask within = (places[axis] >= 0) & (places[axis] < brick.last_sample[axis]);
            inside = inside & within;
        }
    }
    return all_of(inside);
}

// Sets lengths and, if rays leave the box or the slabs, depths. Returns the number of segments.
LAMINA_INLINE std::int64_t set_lengths(const TileRays& frame, const BlockRays& rays,
                                       Float length_per_depth, bool inside, SlabBlock& block) {
    if (inside) {
        for (int i = block.from; i < block.end; ++i) {
            const auto place = static_cast<std::size_t>(i);
            const float thickness = frame.edges[place + 1] - frame.edges[place];
            store(thickness * length_per_depth, block.lengths + at(i));
        }
        return static_cast<std::int64_t>(Float::lanes) * (block.end - block.from);
    }
    const auto edge = [&](int i) LAMINA_LAMBDA {
        return clamp(frame.edges[static_cast<std::size_t>(i)], rays.enter, rays.leave);
    };
    std::int64_t segments = 0;
    Float front = edge(block.from);
    store(front, block.edges + at(block.from));
    for (int i = block.from; i < block.end; ++i) {
        const Float back = edge(i + 1);
        const Float thickness = back - front;
        segments += static_cast<std::int64_t>(count_of(thickness > 0));
        store(back, block.edges + at(i + 1));
        store(0.5f * (front + back), block.middles + at(i));
        store(thickness * length_per_depth, block.lengths + at(i));
        front = back;
    }
    return segments;
}

// Leaves out segments whose middles lie in the share of another renderer. All renderers compute the
// same middles and the same crossings of the planes between shares, so each segment is drawn once.
LAMINA_INLINE void keep_share(const TileRays& frame, const PacketRays& packet, bool inside,
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

// Calls use(kind of points, middle, edge): middle(i) is the point in the middle of slab i, edge(i)
// the one in front of it.
template <class Use>
LAMINA_INLINE void with_points(const TileRays& frame, const BlockRays& rays,
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

// Sets the scalars in the middles of slabs and, if the plan pre-integrates, at their boundaries.
LAMINA_INLINE void set_scalars(const TileSlabs& slabs, const TileBrick& brick,
                               const PacketRays& packet, const BlockRays& rays, bool inside,
                               SlabBlock& block) {
    const bool hardware = slabs.plan->sampling == VolumeSampling::hardware;
    with_points(slabs.rays, rays, packet, inside, block,
                [&](auto kind, const auto& middle, const auto& edge) LAMINA_LAMBDA {
                    sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end,
                                                         middle, block.scalars);
                    if (!slabs.plan->integrates_runs()) return;
                    sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end + 1,
                                                         edge, block.edge_scalars);
                });
}

LAMINA_INLINE void add_light(const TileSlabs& slabs, const TileBrick& brick,
                             const PacketRays& packet, const BlockRays& rays, bool inside,
                             SlabBlock& block) {
    const auto shows = [&](int i)
                           LAMINA_LAMBDA { return any_of(load<Float>(block.depths + at(i)) > 0); };
    with_points(slabs.rays, rays, packet, inside, block,
                [&](auto kind, const auto& middle, const auto& edge) LAMINA_LAMBDA {
                    light_run<decltype(kind)::value>(slabs, brick, packet, middle, edge, shows,
                                                     block);
                });
}

template <Lookup kind>
LAMINA_INLINE void classify(const TileTransfer& transfer, bool colored, bool nan_transparent,
                            SlabBlock& block) {
    for (int i = block.from; i < block.end; ++i) {
        Float scalar = load<Float>(block.scalars + at(i));
        Float length = load<Float>(block.lengths + at(i));
        if (nan_transparent) {
            const FloatMask number = scalar == scalar;
            scalar = zero_unless(number, scalar);
            length = zero_unless(number, length);
        }
        scalar = clamp01(scalar);
        const Int interval = find_interval<kind>(transfer, scalar);
        const Float share = share_of_interval<kind>(transfer, interval, scalar);
        const Float extinction = optics_at<kind>(transfer, 3, interval, share);
        store(extinction * length, block.depths + at(i));
        if (!colored) continue;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            store(optics_at<kind>(transfer, channel, interval, share),
                  block.colors[channel] + at(i));
        }
    }
}

LAMINA_INLINE void set_constant(const TileSlabs& slabs, SlabBlock& block) {
    const auto extinction = static_cast<float>(slabs.constant_extinction);
    for (int i = block.from; i < block.end; ++i) {
        store(extinction * load<Float>(block.lengths + at(i)), block.depths + at(i));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            store(Float(slabs.single_color[channel]), block.colors[channel] + at(i));
        }
    }
}

// Sets optical depths and colours of slabs from .. end - 1. Returns the number of segments that
// have a length.
inline std::int64_t set_run(const TileSlabs& slabs, const TileBrickView& brick,
                            const PacketRays& packet, bool colored, SlabBlock& block) {
    const SlicePlan& plan = *slabs.plan;
    const BlockRays rays = block_rays(packet, block.first_slab * slabs.rays.slab_thickness);
    const bool sampled = plan.sampling != VolumeSampling::none;
    const bool inside = sampled && is_inside(slabs.rays, brick.brick, block, rays, packet);
    const std::int64_t segments = set_lengths(slabs.rays, rays, packet.length_float, inside, block);
    if (brick.share) keep_share(slabs.rays, packet, inside, block);
    if (!sampled) {
        set_constant(slabs, block);
        return segments;
    }
    set_scalars(slabs, brick.brick, packet, rays, inside, block);
    const TileTransfer& transfer = *slabs.transfer;
    with_lookup(transfer, [&](auto kind) LAMINA_LAMBDA {
        constexpr Lookup lookup = decltype(kind)::value;
        if (plan.integrates_runs()) {
            integrate_runs<lookup>(transfer, colored, plan, block);
        } else {
            classify<lookup>(transfer, colored, plan.nan_transparent, block);
        }
    });
    if (colored && slabs.light != nullptr)
        add_light(slabs, brick.brick, packet, rays, inside, block);
    return segments;
}

// Handles a run of slabs in a constant region: its first slab gets the optical depth of all, and
// the others are no longer wanted.
LAMINA_INLINE void set_constant_run(const TileSlabs& slabs, const OpticalProperties& optics,
                                    const PacketRays& packet, bool colored, int first, int end,
                                    SlabBlock& block) {
    const BlockRays rays = block_rays(packet, block.first_slab * slabs.rays.slab_thickness);
    const auto edge = [&](int i) LAMINA_LAMBDA {
        return clamp(slabs.rays.edges[static_cast<std::size_t>(i)], rays.enter, rays.leave);
    };
    const Float length = (edge(end) - edge(first)) * packet.length_float;
    store(static_cast<float>(optics.extinction) * length, block.depths + at(first));
    block.wanted &= ~block_mask(first + 1, end);
    for (int channel = 0; colored && channel < 3; ++channel) {
        store(Float(static_cast<float>(optics.color[channel])), block.colors[channel] + at(first));
    }
}

// Sets optical depths and colours of the slabs that are wanted. Returns the number of segments that
// have a length.
inline std::int64_t set_segments(const TileSlabs& slabs, const TileBrickView& brick,
                                 const PacketRays& packet, bool colored, SlabBlock& block) {
    std::int64_t segments = 0;
    for_each_run(block.wanted, [&](int first, int end) {
        block.from = first;
        block.end = end;
        segments += set_run(slabs, brick, packet, colored, block);
    });
    return segments;
}

LAMINA_SIMD_END

#endif
