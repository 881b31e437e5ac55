// SPDX-License-Identifier: Apache-2.0
// The cells along the rays of a packet, front to back (Amanatides and Woo 1987), with steps over
// bricks that show nothing. Every crossing of a plane is computed from the plane itself, so that
// errors do not accumulate: in floats that begin anew every few cells from double precision, and of
// what is lit in double precision throughout.
#if defined(LAMINA_SLICING_TILE_CELL_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#undef LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#else
#define LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#endif

#include "slicing/cell_map.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_pages-inl.h"
#include "slicing/tile_rays-inl.h"

LAMINA_SIMD_BEGIN

class CellWalk {
  public:
    // The rays between the depths of `span`, inside the box of a brick.
    // `light`: null where nothing is lit.
    void begin(const CellMap& map, const TileBrickView& view, const PacketRays& rays,
               const DepthSpan& span, const TileLight* light) {
        map_ = map.kinds.empty() ? nullptr : &map;
        view_ = &view;
        rays_ = &rays;
        depth_ = span.enter;
        end_ = span.leave;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            direction_[i] = crossing_direction(rays.direction[axis]);
            slope_[i] = to_float(direction_[i]);
            precise_inverse_[i] = 1.0 / direction_[i];
            inverse_[i] = to_float(precise_inverse_[i]);
            forward_[i] = slope_[i] > 0;
            last_[i] = static_cast<std::int32_t>(view.brick.last_sample[i]);
            first_[i] = static_cast<std::int32_t>(view.first[axis]);
            cell_[i] = first_cell(axis);
        }
        lit_ = light != nullptr;
        if (lit_) eye_ = eye_of(*light, rays);
    }

    // Where the walk ends; not in front of where it is.
    void set_end(const Float64& depth) { end_ = depth; }

    // Ends the rays of which `depths`, of anything, has reached a limit.
    void end_where(const Float64& depths, double limit) {
        end_ = select(depths >= limit, depth_, end_);
    }

    bool done() const { return none_of(depth_ < end_); }

    // Within a run of a few steps depths and places are floats relative to its beginning. A ray's
    // steps do not depend on the rays beside it. A run of a lit walk is one step: whether light
    // that bends is cut changes the picture by more than a rounding does, and so must not depend on
    // where the walk began.
    LAMINA_INLINE void begin_run() {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float64 there = rays_->origin[static_cast<int>(axis)] + depth_ * direction_[axis];
            start_[axis] = there - Float64(cell_[axis]);
            place_[axis] = to_float(start_[axis]);
            passed_[axis] = Float(0);
        }
        at_ = Float(0);
        run_end_ = to_float(end_ - depth_);
    }

    LAMINA_INLINE bool run_done() const { return none_of(at_ < run_end_); }

    LAMINA_INLINE void end_run() {
        const Float64 way(at_), whole(run_end_);
        depth_ = select(way >= whole, max(depth_, end_), depth_ + way);
        for (std::size_t axis = 0; axis < 3; ++axis) cell_[axis] = cell_at(axis);
    }

    // Takes a step, and stores the rays' parts; returns which rays have one.
    LAMINA_INLINE StoredLanes step(CellParts& parts) {
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
        const Float to = lit_ ? precise_end(planes, passes) : end_of_step(planes, passes);
        const StoredLanes lanes = keep(cells, leaps, to - at_, parts);
        for (std::size_t axis = 0; axis < 3; ++axis)
            advance(axis, leaps, planes[axis], passes[axis], to);
        at_ = to;
        if (lit_) begin_next_run();
        return lanes;
    }

  private:
    // How a step goes: over one cell, or over the cube of bricks around it.
    struct Leaps {
        bool some;
        FloatMask lanes;  // over bricks
        FloatMask empty;  // over bricks that show nothing
        Int reach;
    };

    // The cell in which the rays begin. On a plane between two cells a ray belongs to the cell that
    // it enters.
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

    // The brick of the map that holds a cell, on one axis.
    LAMINA_INLINE Int brick_of(std::size_t axis, Int cell) const {
        static_assert(MinMaxBricks::edge == 4);
        const auto last = static_cast<std::int32_t>(map_->count[axis]) - 1;
        const Int brick = shift_right<2>(cell + first_[axis]);
        return clamp(brick, 0, last);
    }

    // The plane at which a leap ends on one axis, counted from the run's first cell. Cubes at the
    // volume's border go on beyond it.
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

    LAMINA_INLINE StoredLanes keep(const Int (&cells)[3], const Leaps& leaps, Float thickness,
                                   CellParts& parts) const {
        const FloatMask shown = without(thickness > 0, leaps.empty);
        const StoredLanes lanes = stored_lanes(shown);
        if (lanes.set == 0) return lanes;
        const std::size_t at = parts.count;
        Int samples[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Beyond the first and the last sample the border value repeats.
            const Int cell = cells[axis];
            const Int sample = samples[axis] = clamp(cell, 0, std::max(last_[axis] - 1, 0));
            const FloatMask between = (cell > -1) & (cell < last_[axis]);
            const Float largest(last_[axis] > 0 ? 1.0f : 0.0f);
            const Float share = place_in_cell(axis, sample - cell_[axis]);
            store_members(clamp(share, 0, largest), shown, parts.place[axis] + at);
            const FloatMask moves = without(between, leaps.lanes);
            store_members(zero_unless(moves, thickness * slope_[axis]), shown,
                          parts.change[axis] + at);
        }
        for (std::size_t axis = 0; lit_ && axis < 3; ++axis)
            store_members(eye_.to_eye[axis], shown, parts.to_eye[axis] + at);
        store_members(cell_index(view_->brick, samples[0], samples[1], samples[2]), shown,
                      parts.index + at);
        store_members(thickness * rays_->length_float, shown, parts.length + at);
        parts.count += static_cast<std::size_t>(std::popcount(lanes.set));
        prefetch(parts, at);
        return lanes;
    }

    // Parts beside each other mostly lie in the same lines of the cache.
    LAMINA_INLINE void prefetch(const CellParts& parts, std::size_t from) const {
        const TileBrick& brick = view_->brick;
        if (brick.pages != nullptr) return;
        const auto* const samples = static_cast<const std::byte*>(brick.samples);
        const std::size_t bytes = bytes_of_sample(brick.layout);
        for (std::size_t i = from; i < parts.count; i += TileGrid::block) {
            const auto index = static_cast<std::size_t>(parts.index[i]);
            __builtin_prefetch(samples + bytes * index);
            __builtin_prefetch(samples + bytes * (index + static_cast<std::size_t>(brick.slice)));
            if (!lit_) continue;
            for (const std::int32_t row : {0, brick.slice})
                __builtin_prefetch(brick.gradients + index + static_cast<std::size_t>(row));
        }
    }

    // Where the rays are, from `corner` on, which is counted from the run's first cell. In double
    // precision: floats would move the rays by up to 2e-6 of a cell, which rays that graze a
    // surface show.
    LAMINA_INLINE Float place_in_cell(std::size_t axis, Int corner) const {
        const Float64 place = start_[axis] + Float64(at_) * direction_[axis];
        return to_float(place - Float64(corner));
    }

    // How far the next step goes from where the run began, and which planes it reaches.
    LAMINA_INLINE Float end_of_step(const Float (&planes)[3], FloatMask (&passes)[3]) const {
        Float crossings[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            crossings[axis] = (planes[axis] - place_[axis]) * inverse_[axis];
        const Float to =
            max(min(min(crossings[0], crossings[1]), min(crossings[2], run_end_)), at_);
        for (std::size_t axis = 0; axis < 3; ++axis) passes[axis] = crossings[axis] <= to;
        return to;
    }

    // The same in double precision, of a lit walk, which keeps it in way_.
    LAMINA_INLINE Float precise_end(const Float (&planes)[3], FloatMask (&passes)[3]) {
        Float64 crossings[3];
        way_ = end_ - depth_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            crossings[axis] = (Float64(planes[axis]) - start_[axis]) * precise_inverse_[axis];
            way_ = min(way_, crossings[axis]);
        }
        way_ = max(way_, 0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            passes[axis] = to_float_mask(crossings[axis] <= way_);
        return to_float(way_);
    }

    // A lit walk begins a run after every step.
    LAMINA_INLINE void begin_next_run() {
        depth_ = select(way_ >= end_ - depth_, max(depth_, end_), depth_ + way_);
        for (std::size_t axis = 0; axis < 3; ++axis) cell_[axis] = cell_at(axis);
        begin_run();
    }

    // The cell, counted from the run's first, in which a ray is after a step.
    LAMINA_INLINE Float cell_after(std::size_t axis, Float to) const {
        if (!lit_) return floor(place_[axis] + to * slope_[axis]);
        return to_float(floor(start_[axis] + way_ * direction_[axis]));
    }

    // Enters the next cell on one axis. After a leap that is where the ray is then; it lies in the
    // cube that was crossed, or behind the plane at which the ray leaves it.
    LAMINA_INLINE void advance(std::size_t axis, const Leaps& leaps, Float plane, FloatMask passes,
                               Float to) {
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

    const CellMap* map_ = nullptr;  // null where all rays go cell by cell
    const TileBrickView* view_ = nullptr;
    const PacketRays* rays_ = nullptr;
    std::int32_t last_[3], first_[3];  // the brick's last samples, and its place in the volume
    Float64 depth_, end_;
    Float64 way_;  // of lit walks: how far the last step went
    Float64 direction_[3];
    Float64 precise_inverse_[3];
    Float slope_[3], inverse_[3];  // the directions in float
    FloatMask forward_[3];         // towards larger indices
    bool lit_ = false;
    EyeLanes eye_;  // of lit walks
    // At the beginning of a run: the cell, and where the ray is in it.
    Int cell_[3];
    Float64 start_[3];
    Float place_[3];  // the same in float
    // Since then: cells passed, as whole numbers, and the depth.
    Float passed_[3];
    Float at_, run_end_;
};

LAMINA_SIMD_END

#endif
