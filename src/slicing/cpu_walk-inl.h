// SPDX-License-Identifier: Apache-2.0
// Finds the cells along the rays of a packet, front to back (Amanatides and Woo 1987;
// docs/numerics.md, section 9.4; the number in brackets is an equation there).
//
//   cell = the one in which the ray enters the box
//   while depth < end:
//       plane[a] = the cell's far plane on axis a; of a brick that shows nothing, or has one colour
//                  and one extinction: the far plane of the largest cube of such bricks around it
//       to = the least depth (9.7) at which the ray meets one of them, at most the end
//       if the cell is visible: store the segment (cell, depth .. to)
//       cell[a] = the one behind plane[a] on each axis whose plane is met at `to`
//       depth = to
//
// Every crossing is computed from the plane itself, so errors do not add up. Depths are floats that
// count from a starting point in double precision, which is renewed every few cells. Lit rays are
// walked in double precision throughout: segments whose light bends too much are cut, and another
// cut changes the picture by more than a rounding. So it must not depend on the walk's beginning.
#if defined(LAMINA_SLICING_CPU_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_WALK_INL_H_
#undef LAMINA_SLICING_CPU_WALK_INL_H_
#else
#define LAMINA_SLICING_CPU_WALK_INL_H_
#endif

#include <cmath>
#include <cstdint>
#include <limits>

#include "simd/members-inl.h"
#include "slicing/cpu_fetch-inl.h"

LAMINA_SIMD_BEGIN

// The places in cells, 0 to 1, at which rays enter, and the changes of place until they leave.
struct CellPaths {
    Float place[3], change[3];
};

// The segments of some steps of the rays of a few packets, and the results for them. In each step a
// ray crosses one cell, or a cube of bricks that show nothing or are constant.
struct CellSegments {
    // Packets that are computed side by side, to hide the latency of chains of operations.
    static constexpr std::size_t most_packets = 2;
    static constexpr int most_steps = 32;
    static constexpr std::size_t capacity = (most_steps * most_packets + 1) * most_lanes;

    alignas(64) float place[3][capacity];  // CellPaths
    alignas(64) float change[3][capacity];
    alignas(64) float length[capacity];        // world units
    alignas(64) std::int32_t index[capacity];  // of the cell's lowest corner (cell_index())
    // The normalised scalar from entry (t = 0) to exit (t = 1), coefficients of a cubic (9.1).
    alignas(64) float cubic[4][capacity];
    alignas(64) float limits[2][capacity];  // of the scalar, if CpuTransfer::steps
    alignas(64) float to_eye[3][capacity];  // direction to the eye, for lit segments
    // Associated colour, opacity and optical depth that the segment adds to its ray.
    alignas(64) float color[3][capacity];
    alignas(64) float opacity[capacity];
    alignas(64) float depth[capacity];

    StoredLanes lanes[most_steps][most_packets];  // rays that have a segment in this step
    int steps;
    std::size_t count;

    LAMINA_INLINE CellPaths paths_from(std::size_t i) const {
        CellPaths paths;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            paths.place[axis] = load<Float>(place[axis] + i);
            paths.change[axis] = load<Float>(change[axis] + i);
        }
        return paths;
    }
};

template <bool lit>
class CellWalk {
  public:
    using Depth = std::conditional_t<lit, Float64, Float>;

    // Begins the walk of rays between the depths of `span`, which lie inside the brick's box.
    // `light`: for lit rays alone.
    void begin(const CellMap& map, const CpuBrickView& view, const PacketRays& rays,
               const DepthSpan& span, const CpuLight* light) {
        map_ = map.kinds.empty() ? nullptr : &map;
        view_ = &view;
        rays_ = &rays;
        depth_ = span.enter;
        end_ = span.leave;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            direction_[i] = crossing_direction(rays.direction[axis]);
            slope_[i] = to_float(direction_[i]);
            inverse_[i] = in_steps(1.0 / direction_[i]);
            forward_[i] = slope_[i] > 0;
            last_[i] = static_cast<std::int32_t>(view.brick.last_sample[i]);
            before_[i] = view.box.min[axis] < 0 ? -1 : std::numeric_limits<std::int32_t>::min();
            behind_[i] =
                view.box.max[axis] > last_[i] ? last_[i] : std::numeric_limits<std::int32_t>::max();
            first_[i] = static_cast<std::int32_t>(view.first[axis]);
            cell_[i] = first_cell(axis);
        }
        if constexpr (lit) set_eye(*light, rays, to_eye_);
    }

    // Sets the depth at which the walk ends, at or behind the present one.
    void set_end(const Float64& depth) { end_ = depth; }

    // Ends the rays whose value in `depths` is at least `limit`, until set_end() is called.
    void end_where(const Float64& depths, double limit) {
        end_ = select(depths >= limit, depth_, end_);
    }

    bool done() const { return none_of(depth_ < end_); }

    // Steps are taken between begin_steps() and end_steps(), in floats relative to where the rays
    // are at begin_steps(). A ray's steps do not depend on the rays beside it.
    LAMINA_INLINE void begin_steps() {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float64 there = rays_->origin[static_cast<int>(axis)] + depth_ * direction_[axis];
            start_[axis] = there - Float64(cell_[axis]);
            place_[axis] = in_steps(start_[axis]);
            passed_[axis] = 0;
        }
        at_ = 0;
        steps_end_ = in_steps(end_ - depth_);
    }

    LAMINA_INLINE bool steps_done() const { return none_of(at_ < steps_end_); }

    LAMINA_INLINE void end_steps() {
        const Float64 walked(at_), whole(steps_end_);
        depth_ = select(walked >= whole, max(depth_, end_), depth_ + walked);
        for (std::size_t axis = 0; axis < 3; ++axis) cell_[axis] = cell_at(axis);
    }

    // Takes a step, and stores the rays' segments; returns the rays that have one.
    LAMINA_INLINE StoredLanes step(CellSegments& segments) {
        const Int cells[3] = {cell_at(0), cell_at(1), cell_at(2)};
        Float planes[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            planes[axis] = passed_[axis] + zero_unless(forward_[axis], Float(1));
        const FloatMask none(false);
        Leaps leaps{false, none, none, Int(0)};
        if (map_ != nullptr) {
            const Int bricks[3] = {brick_of(0, cells[0]), brick_of(1, cells[1]),
                                   brick_of(2, cells[2])};
            leaps = leaps_here(bricks);
            for (std::size_t axis = 0; leaps.some && axis < 3; ++axis) {
                planes[axis] =
                    select(leaps.lanes, leap_plane(axis, bricks[axis], leaps.reach), planes[axis]);
            }
        }
        FloatMask passes[3];
        const Depth to = end_of_step(planes, passes);
        const StoredLanes lanes = keep(cells, leaps, in_float(to) - in_float(at_), segments);
        for (std::size_t axis = 0; axis < 3; ++axis)
            advance(axis, leaps, planes[axis], passes[axis], to);
        at_ = to;
        if constexpr (lit) {
            end_steps();
            begin_steps();
        }
        return lanes;
    }

  private:
    // Rays that cross a cube of bricks in one step; a constant cube is one segment of one scalar.
    struct Leaps {
        bool some;        // if any ray leaps
        FloatMask lanes;  // rays that leap
        FloatMask empty;  // rays whose cube shows nothing
        Int reach;  // bricks number - reach + 1 .. number + reach - 1 on each axis are the cube
    };

    // Convert to the precision of steps, and from it to float.
    static LAMINA_INLINE Depth in_steps(const Float64& v) {
        if constexpr (lit)
            return v;
        else
            return to_float(v);
    }
    static LAMINA_INLINE Float in_float(const Depth& v) {
        if constexpr (lit)
            return to_float(v);
        else
            return v;
    }

    // Returns the cell in which rays begin: on a plane between cells, the one that they enter.
    LAMINA_INLINE Int first_cell(int axis) const {
        const Float64 direction = direction_[static_cast<std::size_t>(axis)];
        const Float64 place = rays_->origin[axis] + depth_ * direction;
        const Float64 cell = select(direction < 0, ceil(place) - 1, floor(place));
        const double least = std::floor(view_->box.min[axis]);
        const double most = std::ceil(view_->box.max[axis]) - 1;
        return to_int(clamp(cell, least, most));
    }

    LAMINA_INLINE Int cell_at(std::size_t axis) const {
        return cell_[axis] + to_int(passed_[axis]);
    }

    // Reads kinds of bricks (CellMap). SparseBytes stores codes with background bits inverted.
    LAMINA_INLINE Leaps leaps_here(const Int (&bricks)[3]) const {
        const auto row = static_cast<std::int32_t>(map_->count[0]);
        const auto slice = static_cast<std::int32_t>(map_->count[0] * map_->count[1]);
        const Int place = bricks[0] + bricks[1] * row + bricks[2] * slice;
        const auto* const words = reinterpret_cast<const std::int32_t*>(map_->kinds.coded());
        const Int code = gather_at_bytes(words, place) & 255;
        const Int kind = code ^ map_->kinds.background();
        const FloatMask lanes = kind > 0, constant = kind > CellMap::farthest;
        return {any_of(lanes), lanes, without(lanes, constant), kind & CellMap::farthest};
    }

    // Returns the brick of the map that holds a cell, on one axis.
    LAMINA_INLINE Int brick_of(std::size_t axis, Int cell) const {
        static_assert(MinMaxBricks::edge == 4);
        const auto last = static_cast<std::int32_t>(map_->count[axis]) - 1;
        return clamp(shift_right<2>(cell + first_[axis]), 0, last);
    }

    // Returns the plane at which a leap ends on one axis, counted from cell_. Cubes that reach the
    // volume's border go on two bricks beyond it, because the volume's box may.
    LAMINA_INLINE Float leap_plane(std::size_t axis, Int brick, Int reach) const {
        const auto count = static_cast<std::int32_t>(map_->count[axis]);
        const Int beyond(2);
        Int upper = brick + reach;
        upper += zero_unless(upper > count - 1, beyond);
        Int lower = brick - reach + 1;
        lower -= zero_unless(lower < 1, beyond);
        const Int side = shift_left<2>(select(forward_[axis], upper, lower));
        return to_float(side - (cell_[axis] + first_[axis]));
    }

    // Returns the next step's end, from begin_steps() on. `passes`: rays that reach each plane.
    LAMINA_INLINE Depth end_of_step(const Float (&planes)[3], FloatMask (&passes)[3]) const {
        Depth crossings[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            crossings[axis] = (Depth(planes[axis]) - place_[axis]) * inverse_[axis];
        const Depth to =
            max(min(min(crossings[0], crossings[1]), min(crossings[2], steps_end_)), at_);
        for (std::size_t axis = 0; axis < 3; ++axis)
            passes[axis] = to_float_mask(crossings[axis] <= to);
        return to;
    }

    // Stores the segments of a step. Returns the rays that have one.
    LAMINA_INLINE StoredLanes keep(const Int (&cells)[3], const Leaps& leaps, Float thickness,
                                   CellSegments& segments) const {
        const FloatMask shown = without(thickness > 0, leaps.empty);
        const StoredLanes lanes = stored_lanes(shown);
        if (lanes.set == 0) return lanes;
        const std::size_t at = segments.count;
        Int samples[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Beyond the first and the last sample the border value repeats, if the box reaches so
            // far: a ray is in a face exactly, as limits_of() relies on. Else roundings may leave
            // a rest of the way there, which is in the last cell.
            const Int cell = cells[axis];
            const Int sample = samples[axis] = clamp(cell, 0, std::max(last_[axis] - 1, 0));
            const FloatMask between = (cell > before_[axis]) & (cell < behind_[axis]);
            const Float largest(last_[axis] > 0 ? 1.0f : 0.0f);
            // A voxel's sample is one of the corners: the place, 0 or 1, says which.
            const bool voxels = view_->brick.nearest;
            const Float share =
                voxels ? to_float(cell - sample) : place_in_cell(axis, sample - cell_[axis]);
            const Float beyond = zero_unless(cell > -1, largest);
            store_members(select(between, clamp(share, 0, largest), beyond), shown,
                          segments.place[axis] + at);
            const FloatMask moves = without(between & FloatMask(!voxels), leaps.lanes);
            store_members(zero_unless(moves, thickness * slope_[axis]), shown,
                          segments.change[axis] + at);
            if constexpr (lit) store_members(to_eye_[axis], shown, segments.to_eye[axis] + at);
        }
        store_members(cell_index(view_->brick, samples[0], samples[1], samples[2]), shown,
                      segments.index + at);
        store_members(thickness * rays_->length_float, shown, segments.length + at);
        segments.count += static_cast<std::size_t>(std::popcount(lanes.set));
        prefetch(segments, at);
        return lanes;
    }

    // Prefetches samples of one segment in a few: neighbours' mostly share its cache lines.
    LAMINA_INLINE void prefetch(const CellSegments& segments, std::size_t from) const {
        const CpuBrick& brick = view_->brick;
        if (brick.pages != nullptr) return;
        const auto* const samples = static_cast<const std::byte*>(brick.samples);
        const std::size_t bytes = bytes_of_sample(brick.layout);
        for (std::size_t i = from; i < segments.count; i += TileGrid::block) {
            const auto index = static_cast<std::size_t>(segments.index[i]);
            __builtin_prefetch(samples + bytes * index);
            __builtin_prefetch(samples + bytes * (index + static_cast<std::size_t>(brick.slice)));
            if constexpr (!lit) continue;
            for (const std::int32_t row : {0, brick.slice})
                __builtin_prefetch(brick.gradients + index + static_cast<std::size_t>(row));
        }
    }

    // Returns places relative to `corner`, counted from cell_. In doubles: after leaps depth is
    // large, and floats would move rays by 2e-6 of a cell, visible if they graze a surface.
    LAMINA_INLINE Float place_in_cell(std::size_t axis, Int corner) const {
        const Float64 place = start_[axis] + Float64(at_) * direction_[axis];
        return to_float(place - Float64(corner));
    }

    // Returns the cell, counted from cell_, in which a ray is at depth `to`.
    LAMINA_INLINE Float cell_after(std::size_t axis, const Depth& to) const {
        if constexpr (lit)
            return to_float(floor(place_[axis] + to * direction_[axis]));
        else
            return floor(place_[axis] + to * slope_[axis]);
    }

    // Enters the next cell on one axis: after a leap the one at the ray's new place, limited to the
    // cube, or behind the plane if the ray leaves the cube on this axis.
    LAMINA_INLINE void advance(std::size_t axis, const Leaps& leaps, Float plane, FloatMask passes,
                               const Depth& to) {
        const FloatMask forward = forward_[axis];
        if (leaps.some) {
            const Float there = cell_after(axis, to);
            const Float last = plane - zero_unless(forward, Float(1));  // of the cube
            const Float on = clamp(there, passed_[axis], last);
            const Float back = max(min(there, passed_[axis]), last);
            passed_[axis] = select(leaps.lanes, select(forward, on, back), passed_[axis]);
        }
        const Float behind = plane - zero_unless(!forward, Float(1));
        passed_[axis] = select(passes, behind, passed_[axis]);
    }

    const CellMap* map_ = nullptr;  // null if all rays go cell by cell
    const CpuBrickView* view_ = nullptr;
    const PacketRays* rays_ = nullptr;
    std::int32_t last_[3], first_[3];  // the brick's last samples, and its place in the volume
    // Cells before and behind those between samples, if the box reaches so far; else beyond all.
    std::int32_t before_[3], behind_[3];
    Float64 depth_, end_;
    Float64 direction_[3];
    Float slope_[3];  // direction_ in float
    Depth inverse_[3];
    FloatMask forward_[3];  // towards larger indices
    Float to_eye_[3];       // for lit walks alone
    // At begin_steps(): the rays' cell, and the place in it.
    Int cell_[3];
    Float64 start_[3];
    Depth place_[3];  // start_ in the precision of steps
    // Since begin_steps(): cells passed (whole numbers), and depth.
    Float passed_[3];
    Depth at_, steps_end_;
};

LAMINA_SIMD_END

#endif
