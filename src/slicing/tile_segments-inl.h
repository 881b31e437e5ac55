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

#include <hwy/highway.h>

#include "executors/tile_optics-inl.h"
#include "slicing/tile_lit_slabs-inl.h"
#include "slicing/tile_runs-inl.h"
#include "slicing/tile_scalars-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Rays with depths relative to the front of a block.
struct BlockRays {
    Floats base[3];
    Floats enter, leave;
};

HWY_INLINE BlockRays block_rays(const PacketRays& rays, double front) {
    const DoubleTag d;
    const auto depth = hn::Set(d, front);
    const auto place = [&](HalfDoubles origin, HalfDoubles direction)
                           HWY_ATTR { return hn::Add(origin, hn::Mul(depth, direction)); };
    const auto from_front = [&](HalfDoubles v) HWY_ATTR { return hn::Sub(v, depth); };
    BlockRays block;
    for (int axis = 0; axis < 3; ++axis) {
        block.base[axis] = to_floats(
            FloatTag(), each_half<FloatTag>(place, rays.origin[axis], rays.direction[axis]));
    }
    block.enter = to_floats(FloatTag(), each_half<FloatTag>(from_front, rays.enter));
    block.leave = to_floats(FloatTag(), each_half<FloatTag>(from_front, rays.leave));
    return block;
}

HWY_INLINE Points point_at(const BlockRays& block, const PacketRays& rays, Floats depth) {
    return {mul_add(depth, rays.direction_float[0], block.base[0]),
            mul_add(depth, rays.direction_float[1], block.base[1]),
            mul_add(depth, rays.direction_float[2], block.base[2])};
}

// Whether all rays are, throughout the block's slabs, inside the box and between samples.
HWY_INLINE bool is_inside(const TileRays& frame, const TileBrick& brick, const SlabBlock& block,
                          const BlockRays& rays, const PacketRays& packet) {
    const FloatTag d;
    const Floats front = hn::Set(d, frame.edges[static_cast<std::size_t>(block.from)]);
    const Floats back = hn::Set(d, frame.edges[static_cast<std::size_t>(block.end)]);
    auto inside = hn::And(hn::Le(rays.enter, front), hn::Ge(rays.leave, back));
    for (const Floats depth : {front, back}) {
        const Points point = point_at(rays, packet, depth);
        const Floats places[3] = {point.x, point.y, point.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto within = hn::And(hn::Ge(places[axis], hn::Zero(d)),
                                        hn::Lt(places[axis], hn::Set(d, brick.last_sample[axis])));
            inside = hn::And(inside, within);
        }
    }
    return hn::AllTrue(d, inside);
}

// Sets lengths and, where rays leave the box or the slabs, depths. Returns the number of segments.
HWY_INLINE std::int64_t set_lengths(const TileRays& frame, const BlockRays& rays,
                                    Floats length_per_depth, bool inside, SlabBlock& block) {
    const FloatTag d;
    if (inside) {
        for (int i = block.from; i < block.end; ++i) {
            const auto place = static_cast<std::size_t>(i);
            const float thickness = frame.edges[place + 1] - frame.edges[place];
            hn::Store(hn::Mul(hn::Set(d, thickness), length_per_depth), d, block.lengths + at(i));
        }
        return static_cast<std::int64_t>(hn::Lanes(d)) * (block.end - block.from);
    }
    const auto edge = [&](int i) {
        return hn::Min(hn::Max(hn::Set(d, frame.edges[static_cast<std::size_t>(i)]), rays.enter),
                       rays.leave);
    };
    std::int64_t segments = 0;
    Floats front = edge(block.from);
    hn::Store(front, d, block.edges + at(block.from));
    for (int i = block.from; i < block.end; ++i) {
        const Floats back = edge(i + 1);
        const Floats thickness = hn::Sub(back, front);
        segments += static_cast<std::int64_t>(hn::CountTrue(d, hn::Gt(thickness, hn::Zero(d))));
        hn::Store(back, d, block.edges + at(i + 1));
        hn::Store(hn::Mul(hn::Set(d, 0.5f), hn::Add(front, back)), d, block.middles + at(i));
        hn::Store(hn::Mul(thickness, length_per_depth), d, block.lengths + at(i));
        front = back;
    }
    return segments;
}

// Leaves out segments whose middles lie in the share of another renderer. All renderers compute the
// same middles and the same crossings of the planes between shares, so each segment has one.
HWY_INLINE void keep_share(const TileRays& frame, const PacketRays& packet, bool inside,
                           SlabBlock& block) {
    const FloatTag d;
    const auto front = hn::Set(DoubleTag(), block.first_slab * frame.slab_thickness);
    const auto from_front = [&](HalfDoubles v) HWY_ATTR { return hn::Sub(v, front); };
    const Floats enter = to_floats(d, each_half<FloatTag>(from_front, packet.share.enter));
    const Floats leave = to_floats(d, each_half<FloatTag>(from_front, packet.share.leave));
    for (int i = block.from; i < block.end; ++i) {
        const Floats middle = inside ? hn::Set(d, frame.middles[static_cast<std::size_t>(i)])
                                     : hn::Load(d, block.middles + at(i));
        const auto own = hn::And(hn::Ge(middle, enter), hn::Lt(middle, leave));
        hn::Store(hn::IfThenElseZero(own, hn::Load(d, block.lengths + at(i))), d,
                  block.lengths + at(i));
    }
}

// Calls use(kind of points, middle, edge): middle(i) is the point in the middle of slab i, edge(i)
// the one in front of it.
template <class Use>
HWY_INLINE void with_points(const TileRays& frame, const BlockRays& rays, const PacketRays& packet,
                            bool inside, const SlabBlock& block, const Use& use) {
    const FloatTag d;
    if (inside) {
        const auto among = [&](const float* depths) HWY_ATTR {
            return [&, depths](int i)
                       HWY_ATTR { return point_at(rays, packet, hn::Set(d, depths[i])); };
        };
        return use(std::integral_constant<PointKind, PointKind::inside>(),
                   among(frame.middles.data()), among(frame.edges.data()));
    }
    const auto among = [&](const float* depths) HWY_ATTR {
        return [&, depths](int i)
                   HWY_ATTR { return point_at(rays, packet, hn::Load(d, depths + at(i))); };
    };
    use(std::integral_constant<PointKind, PointKind::anywhere>(), among(block.middles),
        among(block.edges));
}

// Sets the scalars in the middles of slabs and, where the plan pre-integrates, at their boundaries.
HWY_INLINE void set_scalars(const TileSlabs& slabs, const TileBrick& brick,
                            const PacketRays& packet, const BlockRays& rays, bool inside,
                            SlabBlock& block) {
    const bool hardware = slabs.plan->sampling == VolumeSampling::hardware;
    with_points(slabs.rays, rays, packet, inside, block,
                [&](auto kind, const auto& middle, const auto& edge) HWY_ATTR {
                    sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end,
                                                         middle, block.scalars);
                    if (!slabs.plan->integrates_runs()) return;
                    sample_points<decltype(kind)::value>(brick, hardware, block.from, block.end + 1,
                                                         edge, block.edge_scalars);
                });
}

HWY_INLINE void add_light(const TileSlabs& slabs, const TileBrick& brick, const PacketRays& packet,
                          const BlockRays& rays, bool inside, SlabBlock& block) {
    const auto shows = [&](int i) HWY_ATTR {
        const FloatTag d;
        return !hn::AllFalse(d, hn::Gt(hn::Load(d, block.depths + at(i)), hn::Zero(d)));
    };
    with_points(slabs.rays, rays, packet, inside, block,
                [&](auto kind, const auto& middle, const auto& edge) HWY_ATTR {
                    light_run<decltype(kind)::value>(slabs, brick, packet, middle, edge, shows,
                                                     block);
                });
}

template <Lookup kind>
HWY_INLINE void classify(const TileTransfer& transfer, bool colored, bool nan_transparent,
                         SlabBlock& block) {
    const FloatTag d;
    for (int i = block.from; i < block.end; ++i) {
        Floats scalar = hn::Load(d, block.scalars + at(i));
        Floats length = hn::Load(d, block.lengths + at(i));
        if (nan_transparent) {
            const auto number = hn::Eq(scalar, scalar);
            scalar = hn::IfThenElseZero(number, scalar);
            length = hn::IfThenElseZero(number, length);
        }
        scalar = clamp01(d, scalar);
        const Ints interval = find_interval<kind>(transfer, scalar);
        const Floats share = share_of_interval<kind>(transfer, interval, scalar);
        const Floats extinction = optics_at<kind>(transfer, 3, interval, share);
        hn::Store(hn::Mul(extinction, length), d, block.depths + at(i));
        if (!colored) continue;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            hn::Store(optics_at<kind>(transfer, channel, interval, share), d,
                      block.colors[channel] + at(i));
        }
    }
}

HWY_INLINE void set_constant(const TileSlabs& slabs, SlabBlock& block) {
    const FloatTag d;
    const Floats extinction = hn::Set(d, static_cast<float>(slabs.constant_extinction));
    for (int i = block.from; i < block.end; ++i) {
        hn::Store(hn::Mul(extinction, hn::Load(d, block.lengths + at(i))), d, block.depths + at(i));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            hn::Store(hn::Set(d, slabs.single_color[channel]), d, block.colors[channel] + at(i));
        }
    }
}

// Sets optical depths and colours of slabs from .. end - 1. Returns how many segments have a
// length.
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
    with_lookup(transfer, [&](auto kind) HWY_ATTR {
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
HWY_INLINE void set_constant_run(const TileSlabs& slabs, const OpticalProperties& optics,
                                 const PacketRays& packet, bool colored, int first, int end,
                                 SlabBlock& block) {
    const FloatTag d;
    const BlockRays rays = block_rays(packet, block.first_slab * slabs.rays.slab_thickness);
    const auto edge = [&](int i) HWY_ATTR {
        const Floats depth = hn::Set(d, slabs.rays.edges[static_cast<std::size_t>(i)]);
        return hn::Min(hn::Max(depth, rays.enter), rays.leave);
    };
    const Floats length = hn::Mul(hn::Sub(edge(end), edge(first)), packet.length_float);
    const Floats extinction = hn::Set(d, static_cast<float>(optics.extinction));
    hn::Store(hn::Mul(extinction, length), d, block.depths + at(first));
    block.wanted &= ~block_mask(first + 1, end);
    for (int channel = 0; colored && channel < 3; ++channel) {
        hn::Store(hn::Set(d, static_cast<float>(optics.color[channel])), d,
                  block.colors[channel] + at(first));
    }
}

// Sets optical depths and colours of the slabs that are wanted. Returns how many segments have a
// length.
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

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
