// SPDX-License-Identifier: Apache-2.0
// The viewing rays of a vector of pixels in double precision, as shaders/slicing/ray.glsl.
#if defined(LAMINA_SLICING_TILE_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_RAYS_INL_H_
#undef LAMINA_SLICING_TILE_RAYS_INL_H_
#else
#define LAMINA_SLICING_TILE_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "slicing/tile_slabs.h"
#include "tiles/arithmetic-inl.h"
#include "tiles/tile_grid.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

using FloatTag = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using DoubleTag = hn::Repartition<double, FloatTag>;
using Floats = hn::Vec<FloatTag>;
constexpr std::size_t most_lanes = TileGrid::block * TileGrid::block;

// A vector of doubles for each half of a vector of floats.
struct TwoDoubles {
    hn::Vec<DoubleTag> half[2];
};

HWY_INLINE TwoDoubles all(double value) {
    return {{hn::Set(DoubleTag(), value), hn::Set(DoubleTag(), value)}};
}

HWY_INLINE TwoDoubles widen(Floats v) {
    const hn::Half<FloatTag> dh;
    const DoubleTag dd;
    return {{hn::PromoteTo(dd, hn::LowerHalf(dh, v)), hn::PromoteTo(dd, hn::UpperHalf(dh, v))}};
}

HWY_INLINE Floats narrow(const TwoDoubles& v) {
    const hn::Half<FloatTag> dh;
    return hn::Combine(FloatTag(), hn::DemoteTo(dh, v.half[1]), hn::DemoteTo(dh, v.half[0]));
}

// Depths between which a ray is in a box; enter > leave where it never is.
struct DepthSpan {
    TwoDoubles enter, leave;
};

struct PacketRays {
    TwoDoubles origin[3], direction[3];
    TwoDoubles length_per_depth;  // world units
    DepthSpan box, drawn;         // of the brick, in pixels of the image
    TwoDoubles enter, leave;      // enter = leave where the ray misses the box or the slabs
    Floats direction_float[3], length_float;
    int first_slab, end_slab;  // that may show something; none: first >= end
};

HWY_INLINE void clip_to_box(const PacketRays& rays, const IndexBox& box, DepthSpan& span) {
    const DoubleTag d;
    const auto least = hn::Set(d, 1e-20);  // a ray that runs along a face never crosses it
    for (int axis = 0; axis < 3; ++axis) {
        for (int h = 0; h < 2; ++h) {
            const auto there = rays.direction[axis].half[h];
            const auto direction = hn::IfThenElse(hn::Lt(hn::Abs(there), least), least, there);
            const auto inverse = hn::Div(hn::Set(d, 1.0), direction);
            const auto origin = rays.origin[axis].half[h];
            const auto one = hn::Mul(hn::Sub(hn::Set(d, box.min[axis]), origin), inverse);
            const auto other = hn::Mul(hn::Sub(hn::Set(d, box.max[axis]), origin), inverse);
            span.enter.half[h] = hn::Max(span.enter.half[h], hn::Min(one, other));
            span.leave.half[h] = hn::Min(span.leave.half[h], hn::Max(one, other));
        }
    }
}

// Smallest enter and largest leave of the lanes where the ray hits; false where none does.
HWY_INLINE bool depth_hull(const DepthSpan& span, double& first, double& last) {
    const DoubleTag d;
    const auto far = hn::Set(d, 1e300);
    auto least = far, most = hn::Neg(far);
    for (int h = 0; h < 2; ++h) {
        const auto hit = hn::Gt(span.leave.half[h], span.enter.half[h]);
        least = hn::Min(least, hn::IfThenElse(hit, span.enter.half[h], far));
        most = hn::Max(most, hn::IfThenElse(hit, span.leave.half[h], hn::Neg(far)));
    }
    first = hn::GetLane(hn::MinOfLanes(d, least));
    last = hn::GetLane(hn::MaxOfLanes(d, most));
    return last > first;
}

// Of the pixels that follow (column, row) in a tile's order, through one brick.
HWY_INLINE PacketRays packet_rays(const TileRays& frame, const TileBrickView& brick, int column,
                                  int row) {
    alignas(64) static constexpr double columns[most_lanes] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                               0, 1, 2, 3, 0, 1, 2, 3};
    alignas(64) static constexpr double rows[most_lanes] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};
    const DoubleTag d;
    PacketRays rays;
    const double left = column + 0.5 - frame.middle_column, top = row + 0.5 - frame.middle_row;
    for (std::size_t h = 0; h < 2; ++h) {
        const auto x = hn::Add(hn::Set(d, left), hn::LoadU(d, columns + h * hn::Lanes(d)));
        const auto y = hn::Add(hn::Set(d, top), hn::LoadU(d, rows + h * hn::Lanes(d)));
        for (int axis = 0; axis < 3; ++axis) {
            const auto along = [&](double middle, double by_column, double by_row) {
                return hn::Add(hn::Add(hn::Set(d, middle), hn::Mul(x, hn::Set(d, by_column))),
                               hn::Mul(y, hn::Set(d, by_row)));
            };
            rays.origin[axis].half[h] =
                along(brick.origin_middle[axis], frame.origin_column[axis], frame.origin_row[axis]);
            rays.direction[axis].half[h] =
                along(frame.direction_middle[axis], frame.direction_column[axis],
                      frame.direction_row[axis]);
        }
        const auto in_image = hn::And(hn::Lt(x, hn::Set(d, frame.middle_column)),
                                      hn::Lt(y, hn::Set(d, frame.middle_row)));
        rays.box.enter.half[h] = hn::Zero(d);
        rays.box.leave.half[h] = hn::IfThenElse(in_image, hn::Set(d, 1e300), hn::Set(d, -1.0));
        const auto size = hn::Set(d, frame.pixel_size);
        const auto square = hn::Mul(hn::Mul(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), size), size);
        rays.length_per_depth.half[h] = hn::Sqrt(hn::Add(hn::Set(d, 1.0), square));
    }
    for (int axis = 0; axis < 3; ++axis) rays.direction_float[axis] = narrow(rays.direction[axis]);
    rays.length_float = narrow(rays.length_per_depth);
    rays.drawn = rays.box;
    clip_to_box(rays, brick.box, rays.box);
    clip_to_box(rays, brick.drawn, rays.drawn);
    return rays;
}

// Clips to slabs first .. end - 1. Slabs that lie wholly beyond the box that is drawn are not
// needed.
HWY_INLINE void set_span(const TileRays& frame, int first, int end, PacketRays& rays) {
    const DoubleTag d;
    const auto front = hn::Set(d, first * frame.slab_thickness);
    const auto back = hn::Set(d, end * frame.slab_thickness);
    DepthSpan seen;
    for (int h = 0; h < 2; ++h) {
        seen.enter.half[h] = hn::Max(front, rays.drawn.enter.half[h]);
        seen.leave.half[h] = hn::Min(back, rays.drawn.leave.half[h]);
        const auto enter = hn::Max(front, rays.box.enter.half[h]);
        const auto leave = hn::Min(back, rays.box.leave.half[h]);
        const auto hit = hn::Gt(leave, enter);
        rays.enter.half[h] = hn::IfThenElseZero(hit, enter);
        rays.leave.half[h] = hn::IfThenElseZero(hit, leave);
    }
    double nearest = 0, farthest = 0;
    rays.first_slab = rays.end_slab = first;
    if (!depth_hull(seen, nearest, farthest)) return;
    rays.first_slab = std::max(first, static_cast<int>(nearest / frame.slab_thickness) - 1);
    rays.end_slab = std::min(end, static_cast<int>(farthest / frame.slab_thickness) + 2);
}

// Pixels that go through the volume side by side, so that what they fetch stays in the cache: a
// square of 2 x 2 blocks.
constexpr std::size_t group_blocks = 4;
constexpr std::size_t group_packets = group_blocks * most_lanes / hn::MaxLanes(FloatTag());
constexpr std::size_t tile_groups = TileGrid::pixels / (group_blocks * most_lanes);

// Where a tile keeps the first pixel of one of a group's packets.
constexpr std::size_t packet_place(std::size_t group, std::size_t packet) {
    constexpr std::size_t edge = 2 * TileGrid::block, per_row = TileGrid::edge / edge;
    const std::size_t pixel = packet * hn::MaxLanes(FloatTag());
    const std::size_t block = pixel / most_lanes;
    const std::size_t column = group % per_row * edge + block % 2 * TileGrid::block;
    const std::size_t row = group / per_row * edge + block / 2 * TileGrid::block;
    return static_cast<std::size_t>(
               TileGrid::place(static_cast<int>(column), static_cast<int>(row))) +
           pixel % most_lanes;
}

// The rays of a group through one brick. Packets outside the image want no slabs.
struct GroupRays {
    PacketRays packets[group_packets];
    int first_slab, end_slab;  // of all of them

    HWY_INLINE void set_pixels(const TileRays& frame, const TileBrickView& brick,
                               const TileGrid::Tile& area, std::size_t group) {
        for (std::size_t p = 0; p < group_packets; ++p) {
            const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(packet_place(group, p)));
            packets[p] = packet_rays(frame, brick, area.column + at.column, area.row + at.row);
        }
    }

    HWY_INLINE void set_slabs(const TileRays& frame, int first, int end) {
        first_slab = end;
        end_slab = first;
        for (PacketRays& rays : packets) {
            set_span(frame, first, end, rays);
            if (rays.first_slab >= rays.end_slab) continue;
            first_slab = std::min(first_slab, rays.first_slab);
            end_slab = std::max(end_slab, rays.end_slab);
        }
    }
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
