// SPDX-License-Identifier: Apache-2.0
// Segments in double precision, for codes of n bits. They are computed like the shaders', so that
// the codes are the same.
#if defined(LAMINA_SLICING_TILE_PRECISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PRECISE_INL_H_
#undef LAMINA_SLICING_TILE_PRECISE_INL_H_
#else
#define LAMINA_SLICING_TILE_PRECISE_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_optics-inl.h"
#include "slicing/tile_lit_slabs-inl.h"
#include "slicing/tile_runs-inl.h"
#include "slicing/tile_scalars-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

HWY_INLINE TwoDoubles load_doubles(const double* from) {
    const DoubleTag d;
    return {hn::Load(d, from), hn::Load(d, from + hn::Lanes(d))};
}

HWY_INLINE void store_doubles(const TwoDoubles& v, double* to) {
    const DoubleTag d;
    hn::Store(v.low, d, to);
    hn::Store(v.high, d, to + hn::Lanes(d));
}

// The depth of the boundary in front of a slab, clamped to the box.
HWY_INLINE TwoDoubles boundary(const TileRays& frame, const PacketRays& rays, int slab) {
    return boundary(frame, DepthSpan{rays.enter, rays.leave}, slab);
}

HWY_INLINE Points precise_point(const PacketRays& rays, const TwoDoubles& depth) {
    const auto place = [](HalfDoubles origin, HalfDoubles there, HalfDoubles direction)
                           HWY_ATTR { return hn::Add(origin, hn::Mul(there, direction)); };
    Floats point[3];
    for (int axis = 0; axis < 3; ++axis) {
        point[axis] = to_floats(
            FloatTag(), each_half<FloatTag>(place, rays.origin[axis], depth, rays.direction[axis]));
    }
    return {point[0], point[1], point[2]};
}

// Writes world lengths to precise_depths, and rounded ones to lengths. Returns the number of
// segments that have a length.
HWY_INLINE std::int64_t set_precise_lengths(const TileRays& frame, const PacketRays& rays,
                                            SlabBlock& block) {
    const FloatTag d;
    const auto between = [](HalfDoubles front, HalfDoubles back, HalfDoubles per_depth)
                             HWY_ATTR { return hn::Mul(hn::Sub(back, front), per_depth); };
    std::int64_t segments = 0;
    TwoDoubles front = boundary(frame, rays, block.first_slab + block.from);
    for (int i = block.from; i < block.end; ++i) {
        const TwoDoubles back = boundary(frame, rays, block.first_slab + i + 1);
        const TwoDoubles length = each_half<FloatTag>(between, front, back, rays.length_per_depth);
        store_doubles(length, block.precise_depths + at(i));
        const Floats rounded = to_floats(d, length);
        segments += static_cast<std::int64_t>(hn::CountTrue(d, hn::Gt(rounded, hn::Zero(d))));
        hn::Store(rounded, d, block.lengths + at(i));
        front = back;
    }
    return segments;
}

// Calls use(middle, edge): middle(i) is the point in the middle of slab i, edge(i) the one in front
// of it.
template <class Use>
HWY_INLINE void with_precise_points(const TileRays& frame, const PacketRays& rays,
                                    const SlabBlock& block, const Use& use) {
    const auto middle = [&](int i) HWY_ATTR {
        const TwoDoubles front = boundary(frame, rays, block.first_slab + i);
        const TwoDoubles back = boundary(frame, rays, block.first_slab + i + 1);
        const auto mean = [](HalfDoubles a, HalfDoubles b) HWY_ATTR {
            return hn::Mul(hn::Set(DoubleTag(), 0.5), hn::Add(a, b));
        };
        return precise_point(rays, each_half<FloatTag>(mean, front, back));
    };
    const auto edge = [&](int i) HWY_ATTR {
        return precise_point(rays, boundary(frame, rays, block.first_slab + i));
    };
    use(middle, edge);
}

HWY_INLINE void set_precise_scalars(const TileSlabs& slabs, const TileBrick& brick,
                                    const PacketRays& rays, SlabBlock& block) {
    const bool hardware = slabs.plan->sampling == VolumeSampling::hardware;
    with_precise_points(
        slabs.rays, rays, block, [&](const auto& middle, const auto& edge) HWY_ATTR {
            sample_points<PointKind::exact>(brick, hardware, block.from, block.end, middle,
                                            block.scalars);
            if (!slabs.plan->integrates_runs()) return;
            sample_points<PointKind::exact>(brick, hardware, block.from, block.end + 1, edge,
                                            block.edge_scalars);
        });
}

HWY_INLINE void add_precise_light(const TileSlabs& slabs, const TileBrick& brick,
                                  const PacketRays& rays, SlabBlock& block) {
    const auto shows = [&](int i) HWY_ATTR {
        const FloatTag d;
        const Floats depth = to_floats(d, load_doubles(block.precise_depths + at(i)));
        return !hn::AllFalse(d, hn::Gt(depth, hn::Zero(d)));
    };
    with_precise_points(
        slabs.rays, rays, block, [&](const auto& middle, const auto& edge) HWY_ATTR {
            light_run<PointKind::exact>(slabs, brick, rays, middle, edge, shows, block);
        });
}

HWY_INLINE HalfDoubles product(HalfDoubles a, HalfDoubles b) {
    return hn::Mul(a, b);
}

HWY_INLINE void scale_precise_depth(const TwoDoubles& extinction, int slab, SlabBlock& block) {
    const TwoDoubles length = load_doubles(block.precise_depths + at(slab));
    store_doubles(each_half<FloatTag>(product, extinction, length),
                  block.precise_depths + at(slab));
}

// Takes over optical depths that were computed in float.
HWY_INLINE void set_precise_depths(int first, int end, SlabBlock& block) {
    for (int i = first; i < end; ++i) {
        store_doubles(to_doubles(FloatTag(), hn::Load(FloatTag(), block.depths + at(i))),
                      block.precise_depths + at(i));
    }
}
inline void set_precise_depths(SlabBlock& block) {
    for_each_run(block.wanted,
                 [&](int first, int end) HWY_ATTR { set_precise_depths(first, end, block); });
}

template <Lookup kind>
HWY_INLINE void classify_precisely(const TileTransfer& transfer, bool colored, bool nan_transparent,
                                   SlabBlock& block) {
    const FloatTag d;
    for (int i = block.from; i < block.end; ++i) {
        Floats scalar = hn::Load(d, block.scalars + at(i));
        const auto number = hn::Eq(scalar, scalar);
        if (nan_transparent) scalar = hn::IfThenElseZero(number, scalar);
        scalar = clamp01(d, scalar);
        const Ints interval = find_interval<kind>(transfer, scalar);
        const Floats share = share_of_interval<kind>(transfer, interval, scalar);
        TwoDoubles extinction = precise_extinction_at<kind>(transfer, interval, share);
        if (nan_transparent) {
            const TwoDoubles seen = to_doubles(d, hn::IfThenElseZero(number, hn::Set(d, 1.0f)));
            extinction = each_half<FloatTag>(product, extinction, seen);
        }
        scale_precise_depth(extinction, i, block);
        if (!colored) continue;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            hn::Store(optics_at<kind>(transfer, channel, interval, share), d,
                      block.colors[channel] + at(i));
        }
    }
}

// Does what set_run does, with optical depths in double precision.
inline std::int64_t set_precise_run(const TileSlabs& slabs, const TileBrickView& brick,
                                    const PacketRays& rays, bool colored, SlabBlock& block) {
    const FloatTag d;
    const SlicePlan& plan = *slabs.plan;
    const std::int64_t segments = set_precise_lengths(slabs.rays, rays, block);
    if (plan.sampling == VolumeSampling::none) {
        const TwoDoubles extinction = all(slabs.constant_extinction);
        for (int i = block.from; i < block.end; ++i) {
            scale_precise_depth(extinction, i, block);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                hn::Store(hn::Set(d, slabs.single_color[channel]), d,
                          block.colors[channel] + at(i));
            }
        }
        return segments;
    }
    set_precise_scalars(slabs, brick.brick, rays, block);
    const TileTransfer& transfer = *slabs.transfer;
    with_lookup(transfer, [&](auto kind) HWY_ATTR {
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

// Does what set_segments does, with optical depths in double precision.
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

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
