// SPDX-License-Identifier: Apache-2.0
// Computes a vector of viewing rays in double precision, as shaders/slicing/ray.glsl does.
//
//   origin, direction = each pixel's ray in the brick's index space; direction per unit of depth
//   enter, leave      = the depths between which the ray is inside the clip planes and the box
//   slabs             = the slabs from the min enter to the max leave of the packet
#if defined(LAMINA_SLICING_CPU_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_RAYS_INL_H_
#undef LAMINA_SLICING_CPU_RAYS_INL_H_
#else
#define LAMINA_SLICING_CPU_RAYS_INL_H_
#endif

#include "simd/vectors-inl.h"
#include "slicing/cpu_slabs.h"

LAMINA_SIMD_BEGIN

// The depths between which a ray is in a box; enter > leave if it misses the box.
struct DepthSpan {
    Float64 enter, leave;
};

// The rays of a vector of pixels through one brick.
struct PacketRays {
    Float64 origin[3], direction[3];
    Float64 length_per_depth;  // world units
    DepthSpan box, drawn;      // in CpuBrickView's boxes; empty for pixels outside the image
    DepthSpan share;           // in CpuBrickView::share, if set
    Float64 enter, leave;      // enter = leave if the ray misses the box or the slabs
    Float direction_float[3], length_float;  // direction and length_per_depth, rounded
    int first_slab, end_slab;  // slabs that may be visible; first_slab >= end_slab: none
};

// Sets the unit vector to the eye along each ray, along the grid's axes.
LAMINA_INLINE void set_eye(const CpuLight& light, const PacketRays& rays, Float (&to_eye)[3]) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Float step = rays.direction_float[axis] * light.spacing[axis];
        to_eye[axis] = 0 - step / rays.length_float;
    }
}

// Directions, in voxels per depth, below which a ray runs along a plane and never crosses it.
constexpr double least_direction = 1e-20;

// Returns a direction to divide by: if its size is below least_direction, `along` replaces it.
LAMINA_INLINE Float64 crossing_direction(Float64 direction, Float64 along = least_direction) {
    return select(abs(direction) < least_direction, along, direction);
}

// Returns the depth of a slab's front, clamped to a span.
LAMINA_INLINE Float64 boundary(const CpuRays& frame, const DepthSpan& span, int slab) {
    return clamp(Float64(slab * frame.slab_thickness), span.enter, span.leave);
}

// Clips `span` to a box. A ray that runs in the first face (smallest coordinate) on an axis is
// inside the box; a ray in the last face is inside if that face is `last_face` (CpuBrickView).
LAMINA_INLINE void clip_to_box(const PacketRays& rays, const IndexBox& box,
                               const glm::dvec3& last_face, DepthSpan& span) {
    for (int axis = 0; axis < 3; ++axis) {
        const Float64 origin = rays.origin[axis];
        // A ray in a face is taken to leave it slowly, into the box if the face counts as inside.
        const Float64 along =
            select(origin == last_face[axis], Float64(-least_direction), least_direction);
        const Float64 inverse = 1.0 / crossing_direction(rays.direction[axis], along);
        const Float64 one = (box.min[axis] - origin) * inverse;
        const Float64 other = (box.max[axis] - origin) * inverse;
        span.enter = max(span.enter, min(one, other));
        span.leave = min(span.leave, max(one, other));
    }
}

LAMINA_INLINE void clip_to_plane(const PacketRays& rays, const IndexPlane& plane, DepthSpan& span) {
    // The distance of the origin from the plane, and its change with depth.
    Float64 distance = plane.offset, slope = 0;
    for (int axis = 0; axis < 3; ++axis) {
        distance += plane.normal[axis] * rays.origin[axis];
        slope += plane.normal[axis] * rays.direction[axis];
    }
    const Float64 safe = crossing_direction(slope);
    const Float64 crossing = -distance / safe;
    const Float64Mask enters = safe > 0;
    span.enter = select(enters, max(span.enter, crossing), span.enter);
    span.leave = select(enters, span.leave, min(span.leave, crossing));
}

// Returns the rays of the pixels from (column, row) on, in the order of a tile, through one brick.
LAMINA_INLINE PacketRays packet_rays(const CpuRays& frame, const CpuBrickView& brick, int column,
                                     int row) {
    alignas(64) static constexpr double columns[most_lanes] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                               0, 1, 2, 3, 0, 1, 2, 3};
    alignas(64) static constexpr double rows[most_lanes] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};
    PacketRays rays;
    const auto from = [&](double first, const double* steps)
                          LAMINA_LAMBDA { return first + load_float64(steps); };
    const Float64 x = from(column + 0.5 - frame.middle_column, columns);
    const Float64 y = from(row + 0.5 - frame.middle_row, rows);
    const auto along = [&](double middle, double by_column, double by_row)
                           LAMINA_LAMBDA { return middle + x * by_column + y * by_row; };
    for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis] =
            along(brick.origin_middle[axis], frame.origin_column[axis], frame.origin_row[axis]);
        rays.direction[axis] = along(frame.direction_middle[axis], frame.direction_column[axis],
                                     frame.direction_row[axis]);
        rays.direction_float[axis] = to_float(rays.direction[axis]);
    }
    const Float64Mask in_image = (x < frame.middle_column) & (y < frame.middle_row);
    rays.box = {0, select(in_image, Float64(1e300), -1)};
    const double size = frame.pixel_size;
    rays.length_per_depth = sqrt(1 + (x * x + y * y) * size * size);
    rays.length_float = to_float(rays.length_per_depth);
    for (const IndexPlane& plane : brick.clip) clip_to_plane(rays, plane, rays.box);
    rays.drawn = rays.box;
    clip_to_box(rays, brick.box, brick.last_face, rays.box);
    clip_to_box(rays, brick.drawn, brick.last_face, rays.drawn);
    if (brick.share) {
        rays.share = {-1e30, 1e30};
        clip_to_box(rays, *brick.share, no_last_face, rays.share);
        // Segments whose middle is in the share may reach half a slab beyond it.
        const double half = 0.5 * frame.slab_thickness;
        rays.drawn = {max(rays.drawn.enter, rays.share.enter - half),
                      min(rays.drawn.leave, rays.share.leave + half)};
    }
    return rays;
}

// Clips rays to slabs first .. end - 1. Sets first_slab and end_slab to those near the drawn box.
LAMINA_INLINE void set_span(const CpuRays& frame, int first, int end, PacketRays& rays) {
    const Float64 front = first * frame.slab_thickness, back = end * frame.slab_thickness;
    const DepthSpan seen{max(front, rays.drawn.enter), min(back, rays.drawn.leave)};
    const Float64 enter = max(front, rays.box.enter);
    const Float64 leave = min(back, rays.box.leave);
    const Float64Mask hit = leave > enter;
    rays.enter = zero_unless(hit, enter);
    rays.leave = zero_unless(hit, leave);
    rays.first_slab = rays.end_slab = first;
    const Float64 far = 1e300;
    const Float64Mask shown = seen.leave > seen.enter;
    const double nearest = least_of(select(shown, seen.enter, far));
    const double farthest = largest_of(select(shown, seen.leave, -far));
    if (!(farthest > nearest)) return;
    rays.first_slab = std::max(first, static_cast<int>(nearest / frame.slab_thickness) - 1);
    rays.end_slab = std::min(end, static_cast<int>(farthest / frame.slab_thickness) + 2);
}

// A group is 2 x 2 blocks of pixels, marched together so that shared samples stay in the cache.
constexpr std::size_t group_blocks = 4;
constexpr std::size_t block_packets = most_lanes / Float::lanes;
constexpr std::size_t group_packets = group_blocks * block_packets;
constexpr std::size_t tile_groups = TileGrid::pixels / (group_blocks * most_lanes);

// Returns the place in a tile (TileGrid::place()) of the first pixel of a packet of a group.
constexpr std::size_t packet_place(std::size_t group, std::size_t packet) {
    constexpr std::size_t edge = 2 * TileGrid::block, per_row = TileGrid::edge / edge;
    const std::size_t pixel = packet * Float::lanes;
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
    CpuBounds bounds;
    // Sets of slabs, counted from `origin`: slabs that may be visible, and slabs that do not lie in
    // constant bricks alone. The whole group shares them: sets for each block would not pay off.
    SlabMask shown, varied;
    int origin, first_slab, end_slab;  // the sets' first slab; slabs that any packet crosses

    LAMINA_INLINE void set_pixels(const CpuRays& frame, const CpuBrickView& brick,
                                  const TileGrid::Tile& area, std::size_t group) {
        const TileGrid::Place first = TileGrid::pixel_at(static_cast<int>(packet_place(group, 0)));
        bounds = {frame, brick, area.column + first.column, area.row + first.row,
                  2 * TileGrid::block};
        for (std::size_t p = 0; p < group_packets; ++p) {
            const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(packet_place(group, p)));
            packets[p] = packet_rays(frame, brick, area.column + at.column, area.row + at.row);
        }
    }

    // Clips the rays to slabs first .. end - 1 and finds the sets of slabs.
    LAMINA_INLINE void set_slabs(const CpuSlabs& slabs, int first, int end) {
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

    void find(const OccupiedBricks& bricks, const CpuRays& rays, SlabMask& mask) const {
        mask.clear(end_slab - origin);
        bounds.for_each_shown(bricks, rays, first_slab, end_slab,
                              [&](int first, int end) { mask.set(first - origin, end - origin); });
    }

    // Returns the slabs of block `number`, counted from `origin`, that a packet crosses and that
    // may be visible.
    BlockMask wanted(const CpuSlabs& slabs, std::size_t packet, int number) const {
        const int begin = origin + number * block_slabs;
        const PacketRays& rays = packets[packet];
        const BlockMask all = block_mask(std::max(rays.first_slab - begin, 0),
                                         std::min(rays.end_slab - begin, block_slabs));
        if (slabs.occupied == nullptr) return all;
        return all & shown.block(number);
    }

    // Returns the `wanted` slabs that lie in constant regions; consecutive ones are one step.
    BlockMask constant(const CpuSlabs& slabs, int number, BlockMask wanted) const {
        return slabs.constant == nullptr ? 0 : wanted & ~varied.block(number);
    }

    // Returns the optical properties of a constant slab.
    const OpticalProperties& constant_optics(const CpuSlabs& slabs, int slab) const {
        const double middle = (slab + 0.5) * slabs.rays.slab_thickness;
        const ConstantBricks& constant = *slabs.constant;
        return constant.kinds[constant.kind_at(bounds.middle_at(middle))];
    }
};

LAMINA_SIMD_END

#endif
