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

#include "executors/tile_light.h"
#include "executors/tile_number-inl.h"
#include "executors/tile_vectors-inl.h"
#include "slicing/slab_mask.h"
#include "slicing/tile_bounds.h"
#include "slicing/tile_slabs.h"
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

HWY_INLINE TwoDoubles all(double value) {
    return {hn::Set(DoubleTag(), value), hn::Set(DoubleTag(), value)};
}

// The depths between which a ray is in a box; enter > leave where it misses the box.
struct DepthSpan {
    TwoDoubles enter, leave;
};

struct PacketRays {
    TwoDoubles origin[3], direction[3];
    TwoDoubles length_per_depth;  // world units
    DepthSpan box, drawn;         // boxes of the brick, for pixels of the image
    DepthSpan share;              // of the middles of segments to draw, where the brick says so
    TwoDoubles enter, leave;      // enter = leave where the ray misses the box or the slabs
    Floats direction_float[3], length_float;
    int first_slab, end_slab;  // slabs that may show something; first >= end where there are none
};

// The unit vector to the eye along each ray, along the grid's axes.
struct EyeLanes {
    Number to_eye[3];
};

HWY_INLINE EyeLanes eye_of(const TileLight& light, const PacketRays& rays) {
    EyeLanes eye;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Number step = Number(rays.direction_float[axis]) * Number(light.spacing[axis]);
        eye.to_eye[axis] = Number(0) - step / Number(rays.length_float);
    }
    return eye;
}

// Directions, in voxels per depth, that are smaller than this are those of rays that run along a
// plane and never cross it.
constexpr double least_direction = 1e-20;

// A direction to divide by: `along` in place of those that are too small.
HWY_INLINE HalfDoubles crossing_direction(HalfDoubles direction, HalfDoubles along) {
    const auto least = hn::Set(DoubleTag(), least_direction);
    return hn::IfThenElse(hn::Lt(hn::Abs(direction), least), along, direction);
}
HWY_INLINE HalfDoubles crossing_direction(HalfDoubles direction) {
    return crossing_direction(direction, hn::Set(DoubleTag(), least_direction));
}

// The depth of the boundary in front of a slab, clamped to a span.
HWY_INLINE TwoDoubles boundary(const TileRays& frame, const DepthSpan& span, int slab) {
    const auto depth = hn::Set(DoubleTag(), slab * frame.slab_thickness);
    const auto clamp = [&](HalfDoubles enter, HalfDoubles leave)
                           HWY_ATTR { return hn::Min(hn::Max(depth, enter), leave); };
    return each_half<FloatTag>(clamp, span.enter, span.leave);
}

// Clips to a box. A ray that runs in the box's first face is inside, and one in its last face is
// if that is `last_face` (TileBrickView).
HWY_INLINE void clip_to_box(const PacketRays& rays, const IndexBox& box,
                            const glm::dvec3& last_face, DepthSpan& span) {
    const DoubleTag d;
    for (int axis = 0; axis < 3; ++axis) {
        const auto clip = [&](HalfDoubles origin, HalfDoubles there, HalfDoubles& enter,
                              HalfDoubles& leave) HWY_ATTR {
            // A ray in a face stays inside if it is taken to leave the face into the box.
            const auto in_last_face = hn::Eq(origin, hn::Set(d, last_face[axis]));
            const auto along = hn::IfThenElse(in_last_face, hn::Set(d, -least_direction),
                                              hn::Set(d, least_direction));
            const auto inverse = hn::Div(hn::Set(d, 1.0), crossing_direction(there, along));
            const auto one = hn::Mul(hn::Sub(hn::Set(d, box.min[axis]), origin), inverse);
            const auto other = hn::Mul(hn::Sub(hn::Set(d, box.max[axis]), origin), inverse);
            enter = hn::Max(enter, hn::Min(one, other));
            leave = hn::Min(leave, hn::Max(one, other));
        };
        const TwoDoubles &origin = rays.origin[axis], &direction = rays.direction[axis];
        clip(origin.low, direction.low, span.enter.low, span.leave.low);
        clip(origin.high, direction.high, span.enter.high, span.leave.high);
    }
}

HWY_INLINE void clip_to_plane(const PacketRays& rays, const IndexPlane& plane, DepthSpan& span) {
    const DoubleTag d;
    TwoDoubles distance = all(plane.offset),
               slope = all(0);  // of the origin; its change with depth
    for (int axis = 0; axis < 3; ++axis) {
        const auto add = [&](HalfDoubles sum, HalfDoubles v) HWY_ATTR {
            return hn::Add(sum, hn::Mul(hn::Set(d, plane.normal[axis]), v));
        };
        distance = each_half<FloatTag>(add, distance, rays.origin[axis]);
        slope = each_half<FloatTag>(add, slope, rays.direction[axis]);
    }
    const auto clip = [&](HalfDoubles from, HalfDoubles change, HalfDoubles& enter,
                          HalfDoubles& leave) HWY_ATTR {
        const auto safe = crossing_direction(change);
        const auto crossing = hn::Div(hn::Neg(from), safe);
        const auto enters = hn::Gt(safe, hn::Zero(d));
        enter = hn::IfThenElse(enters, hn::Max(enter, crossing), enter);
        leave = hn::IfThenElse(enters, leave, hn::Min(leave, crossing));
    };
    clip(distance.low, slope.low, span.enter.low, span.leave.low);
    clip(distance.high, slope.high, span.enter.high, span.leave.high);
}

// The smallest enter and the largest leave of the lanes whose rays hit. Returns false where no ray
// does.
HWY_INLINE bool depth_hull(const DepthSpan& span, double& first, double& last) {
    const DoubleTag d;
    const auto far = hn::Set(d, 1e300);
    auto least = far, most = hn::Neg(far);
    const auto include = [&](HalfDoubles enter, HalfDoubles leave) HWY_ATTR {
        const auto hit = hn::Gt(leave, enter);
        least = hn::Min(least, hn::IfThenElse(hit, enter, far));
        most = hn::Max(most, hn::IfThenElse(hit, leave, hn::Neg(far)));
    };
    include(span.enter.low, span.leave.low);
    include(span.enter.high, span.leave.high);
    first = hn::GetLane(hn::MinOfLanes(d, least));
    last = hn::GetLane(hn::MaxOfLanes(d, most));
    return last > first;
}

// The part of `span` in which segments lie whose middles lie in `share`.
HWY_INLINE DepthSpan with_half_slabs(const TileRays& frame, const DepthSpan& share,
                                     const DepthSpan& span) {
    const auto half = hn::Set(DoubleTag(), 0.5 * frame.slab_thickness);
    const auto later = [&](HalfDoubles a, HalfDoubles b)
                           HWY_ATTR { return hn::Max(a, hn::Sub(b, half)); };
    const auto earlier = [&](HalfDoubles a, HalfDoubles b)
                             HWY_ATTR { return hn::Min(a, hn::Add(b, half)); };
    return {each_half<FloatTag>(later, span.enter, share.enter),
            each_half<FloatTag>(earlier, span.leave, share.leave)};
}

// The rays of the pixels from (column, row) on, in the order of a tile, through one brick.
HWY_INLINE PacketRays packet_rays(const TileRays& frame, const TileBrickView& brick, int column,
                                  int row) {
    alignas(64) static constexpr double columns[most_lanes] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                               0, 1, 2, 3, 0, 1, 2, 3};
    alignas(64) static constexpr double rows[most_lanes] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};
    const DoubleTag d;
    PacketRays rays;
    const auto from = [&](double first, const double* steps) HWY_ATTR {
        const auto start = hn::Set(d, first);
        return TwoDoubles{hn::Add(start, hn::LoadU(d, steps)),
                          hn::Add(start, hn::LoadU(d, steps + hn::Lanes(d)))};
    };
    const TwoDoubles x = from(column + 0.5 - frame.middle_column, columns);
    const TwoDoubles y = from(row + 0.5 - frame.middle_row, rows);
    const auto along = [&](double middle, double by_column, double by_row) HWY_ATTR {
        const auto at_pixel = [&](HalfDoubles across, HalfDoubles down) HWY_ATTR {
            return hn::Add(hn::Add(hn::Set(d, middle), hn::Mul(across, hn::Set(d, by_column))),
                           hn::Mul(down, hn::Set(d, by_row)));
        };
        return each_half<FloatTag>(at_pixel, x, y);
    };
    for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis] =
            along(brick.origin_middle[axis], frame.origin_column[axis], frame.origin_row[axis]);
        rays.direction[axis] = along(frame.direction_middle[axis], frame.direction_column[axis],
                                     frame.direction_row[axis]);
        rays.direction_float[axis] = to_floats(FloatTag(), rays.direction[axis]);
    }
    rays.box.enter = all(0);
    const auto leave_of = [&](HalfDoubles across, HalfDoubles down) HWY_ATTR {
        const auto in_image = hn::And(hn::Lt(across, hn::Set(d, frame.middle_column)),
                                      hn::Lt(down, hn::Set(d, frame.middle_row)));
        return hn::IfThenElse(in_image, hn::Set(d, 1e300), hn::Set(d, -1.0));
    };
    rays.box.leave = each_half<FloatTag>(leave_of, x, y);
    const auto length_of = [&](HalfDoubles across, HalfDoubles down) HWY_ATTR {
        const auto size = hn::Set(d, frame.pixel_size);
        const auto square = hn::Add(hn::Mul(across, across), hn::Mul(down, down));
        return hn::Sqrt(hn::Add(hn::Set(d, 1.0), hn::Mul(hn::Mul(square, size), size)));
    };
    rays.length_per_depth = each_half<FloatTag>(length_of, x, y);
    rays.length_float = to_floats(FloatTag(), rays.length_per_depth);
    for (const IndexPlane& plane : brick.clip) clip_to_plane(rays, plane, rays.box);
    rays.drawn = rays.box;
    clip_to_box(rays, brick.box, brick.last_face, rays.box);
    clip_to_box(rays, brick.drawn, brick.last_face, rays.drawn);
    if (brick.share) {
        rays.share = {all(-1e30), all(1e30)};
        clip_to_box(rays, *brick.share, no_last_face, rays.share);
        rays.drawn = with_half_slabs(frame, rays.share, rays.drawn);
    }
    return rays;
}

// Clips the rays to slabs first .. end - 1. Slabs that lie wholly outside the drawn box are not
// needed.
HWY_INLINE void set_span(const TileRays& frame, int first, int end, PacketRays& rays) {
    const DoubleTag d;
    const auto front = hn::Set(d, first * frame.slab_thickness);
    const auto back = hn::Set(d, end * frame.slab_thickness);
    const auto behind_front = [&](HalfDoubles v) HWY_ATTR { return hn::Max(front, v); };
    const auto before_back = [&](HalfDoubles v) HWY_ATTR { return hn::Min(back, v); };
    const auto where_hit = [&](HalfDoubles v, HalfDoubles enter, HalfDoubles leave)
                               HWY_ATTR { return hn::IfThenElseZero(hn::Gt(leave, enter), v); };
    const DepthSpan seen{each_half<FloatTag>(behind_front, rays.drawn.enter),
                         each_half<FloatTag>(before_back, rays.drawn.leave)};
    const TwoDoubles enter = each_half<FloatTag>(behind_front, rays.box.enter);
    const TwoDoubles leave = each_half<FloatTag>(before_back, rays.box.leave);
    rays.enter = each_half<FloatTag>(where_hit, enter, enter, leave);
    rays.leave = each_half<FloatTag>(where_hit, leave, enter, leave);
    double nearest = 0, farthest = 0;
    rays.first_slab = rays.end_slab = first;
    if (!depth_hull(seen, nearest, farthest)) return;
    rays.first_slab = std::max(first, static_cast<int>(nearest / frame.slab_thickness) - 1);
    rays.end_slab = std::min(end, static_cast<int>(farthest / frame.slab_thickness) + 2);
}

// A group of pixels that go through the volume together, so that what they fetch stays in the
// cache: a square of 2 x 2 blocks.
constexpr std::size_t group_blocks = 4;
constexpr std::size_t block_packets = most_lanes / hn::MaxLanes(FloatTag());
constexpr std::size_t group_packets = group_blocks * block_packets;
constexpr std::size_t tile_groups = TileGrid::pixels / (group_blocks * most_lanes);

// The place in a tile of the first pixel of a packet of a group.
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

// The rays of a group through one brick. Packets outside the image have no slabs.
struct GroupRays {
    PacketRays packets[group_packets];
    TileBounds bounds;
    // Sets of slabs, counted from `origin`: those that may show something, and those in which
    // something is not constant. Finding these sets block by block would make them smaller, but
    // would take longer than it saves.
    SlabMask shown, varied;
    int origin, first_slab, end_slab;  // slabs of all packets together

    HWY_INLINE void set_pixels(const TileRays& frame, const TileBrickView& brick,
                               const TileGrid::Tile& area, std::size_t group) {
        const TileGrid::Place first = TileGrid::pixel_at(static_cast<int>(packet_place(group, 0)));
        bounds = {frame, brick, area.column + first.column, area.row + first.row,
                  2 * TileGrid::block};
        for (std::size_t p = 0; p < group_packets; ++p) {
            const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(packet_place(group, p)));
            packets[p] = packet_rays(frame, brick, area.column + at.column, area.row + at.row);
        }
    }

    // Finds the sets for slabs first .. end - 1.
    HWY_INLINE void set_slabs(const TileSlabs& slabs, int first, int end) {
        origin = first;
        first_slab = end;
        end_slab = first;
        for (PacketRays& rays : packets) {
            set_span(slabs.rays, first, end, rays);
            if (rays.first_slab >= rays.end_slab) continue;
            first_slab = std::min(first_slab, rays.first_slab);
            end_slab = std::max(end_slab, rays.end_slab);
        }
        if (slabs.occupied != nullptr) find(*slabs.occupied, slabs.rays, shown);
        if (slabs.constant != nullptr) find(slabs.constant->varied, slabs.rays, varied);
    }

    void find(const OccupiedBricks& bricks, const TileRays& rays, SlabMask& mask) const {
        mask.clear(end_slab - origin);
        bounds.for_each_shown(bricks, rays, first_slab, end_slab,
                              [&](int first, int end) { mask.set(first - origin, end - origin); });
    }

    // The slabs of block `number`, counted from `origin`, that a packet crosses and that may show
    // something.
    BlockMask wanted(const TileSlabs& slabs, std::size_t packet, int number) const {
        const int begin = origin + number * tile_block_slabs;
        const PacketRays& rays = packets[packet];
        const BlockMask all = block_mask(std::max(rays.first_slab - begin, 0),
                                         std::min(rays.end_slab - begin, tile_block_slabs));
        if (slabs.occupied == nullptr) return all;
        return all & shown.block(number);
    }

    // Those of the `wanted` slabs that are constant, which a packet crosses in one step together
    // with their neighbours.
    BlockMask constant(const TileSlabs& slabs, int number, BlockMask wanted) const {
        return slabs.constant == nullptr ? 0 : wanted & ~varied.block(number);
    }

    // The optical properties of a constant slab.
    const OpticalProperties& constant_optics(const TileSlabs& slabs, int slab) const {
        const double middle = (slab + 0.5) * slabs.rays.slab_thickness;
        const ConstantBricks& constant = *slabs.constant;
        return constant.kinds[constant.kind_at(bounds.middle_at(middle))];
    }
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
