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

#include <hwy/highway.h>

#include "slicing/cell_map.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_pages-inl.h"
#include "slicing/tile_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

HWY_INLINE TwoDoubles doubles_of(Ints v) {
    const DoubleTag dd;
    const hn::Half<IntTag> half;
    return {hn::PromoteTo(dd, hn::LowerHalf(half, v)), hn::PromoteTo(dd, hn::UpperHalf(half, v))};
}

// Whole numbers within the range of int.
HWY_INLINE Ints ints_of(const TwoDoubles& v) {
    const hn::Half<IntTag> half;
    return hn::Combine(IntTag(), hn::DemoteTo(half, v.high), hn::DemoteTo(half, v.low));
}

class CellWalk {
  public:
    // The rays between the depths of `span`, inside the box of a brick.
    // `light`: null where nothing is lit.
    void begin(const CellMap& map, const TileBrickView& view, const PacketRays& rays,
               const DepthSpan& span, const TileLight* light) {
        const FloatTag d;
        map_ = map.kinds.empty() ? nullptr : &map;
        view_ = &view;
        rays_ = &rays;
        depth_ = span.enter;
        end_ = span.leave;
        const DoubleTag dd;
        const auto crossing = [](HalfDoubles v) HWY_ATTR { return crossing_direction(v); };
        const auto inverse = [&](HalfDoubles v) HWY_ATTR { return hn::Div(hn::Set(dd, 1.0), v); };
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            direction_[i] = each_half<FloatTag>(crossing, rays.direction[axis]);
            slope_[i] = to_floats(d, direction_[i]);
            precise_inverse_[i] = each_half<FloatTag>(inverse, direction_[i]);
            inverse_[i] = to_floats(d, precise_inverse_[i]);
            forward_[i] = hn::Gt(slope_[i].v, hn::Zero(d));
            last_[i] = static_cast<std::int32_t>(view.brick.last_sample[i]);
            first_[i] = static_cast<std::int32_t>(view.first[axis]);
            cell_[i] = first_cell(axis);
        }
        lit_ = light != nullptr;
        if (lit_) eye_ = eye_of(*light, rays);
    }

    // Where the walk ends; not in front of where it is.
    void set_end(const TwoDoubles& depth) { end_ = depth; }

    // Ends the rays of which `depths`, of anything, has reached a limit.
    void end_where(const TwoDoubles& depths, double limit) {
        const auto most = hn::Set(DoubleTag(), limit);
        end_.low = hn::IfThenElse(hn::Ge(depths.low, most), depth_.low, end_.low);
        end_.high = hn::IfThenElse(hn::Ge(depths.high, most), depth_.high, end_.high);
    }

    bool done() const {
        const DoubleTag dd;
        return hn::AllFalse(dd, hn::Lt(depth_.low, end_.low)) &&
               hn::AllFalse(dd, hn::Lt(depth_.high, end_.high));
    }

    // Within a run of a few steps depths and places are floats relative to its beginning. A ray's
    // steps do not depend on the rays beside it. A run of a lit walk is one step: whether light
    // that bends is cut changes the picture by more than a rounding does, and so must not depend on
    // where the walk began.
    HWY_INLINE void begin_run() {
        const FloatTag d;
        const auto place = [](HalfDoubles depth, HalfDoubles direction, HalfDoubles origin)
                               HWY_ATTR { return hn::Add(origin, hn::Mul(depth, direction)); };
        const auto minus = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Sub(a, b); };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const TwoDoubles there = each_half<FloatTag>(place, depth_, direction_[axis],
                                                         rays_->origin[static_cast<int>(axis)]);
            start_[axis] = each_half<FloatTag>(minus, there, doubles_of(cell_[axis]));
            place_[axis] = to_floats(d, start_[axis]);
            passed_[axis] = Number(0);
        }
        at_ = Number(0);
        run_end_ = to_floats(d, each_half<FloatTag>(minus, end_, depth_));
    }

    HWY_INLINE bool run_done() const { return hn::AllFalse(FloatTag(), at_ < run_end_); }

    HWY_INLINE void end_run() {
        const TwoDoubles gone = to_doubles(FloatTag(), at_.v);
        const TwoDoubles all = to_doubles(FloatTag(), run_end_.v);
        const auto behind = [](HalfDoubles depth, HalfDoubles end, HalfDoubles way,
                               HalfDoubles whole) HWY_ATTR {
            return hn::IfThenElse(hn::Ge(way, whole), hn::Max(depth, end), hn::Add(depth, way));
        };
        depth_ = {behind(depth_.low, end_.low, gone.low, all.low),
                  behind(depth_.high, end_.high, gone.high, all.high)};
        for (std::size_t axis = 0; axis < 3; ++axis) cell_[axis] = cell_at(axis);
    }

    // Takes a step, and stores the rays' parts; returns which rays have one.
    HWY_INLINE StoredLanes step(CellParts& parts) {
        const FloatTag d;
        const Ints cells[3] = {cell_at(0), cell_at(1), cell_at(2)};
        Number planes[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            planes[axis] = passed_[axis] + zero_unless(forward_[axis], Number(1));
        const FloatMask none = hn::FirstN(d, 0);
        Leaps leaps{false, none, none, hn::Zero(IntTag())};
        if (map_ != nullptr) {
            const Ints bricks[3] = {brick_of(0, cells[0]), brick_of(1, cells[1]),
                                    brick_of(2, cells[2])};
            leaps = leaps_here(bricks);
            for (std::size_t axis = 0; leaps.some && axis < 3; ++axis) {
                planes[axis] =
                    select(leaps.lanes, leap_plane(axis, bricks[axis], leaps.reach), planes[axis]);
            }
        }
        FloatMask passes[3];
        const Number to = lit_ ? precise_end(planes, passes) : end_of_step(planes, passes);
        const StoredLanes lanes = store(cells, leaps, to - at_, parts);
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
        Ints reach;
    };

    // The cell in which the rays begin. On a plane between two cells a ray belongs to the cell that
    // it enters.
    HWY_INLINE Ints first_cell(int axis) const {
        const DoubleTag dd;
        const auto least = hn::Set(dd, std::floor(view_->box.min[axis]));
        const auto most = hn::Set(dd, std::ceil(view_->box.max[axis]) - 1);
        const auto cell = [&](HalfDoubles origin, HalfDoubles direction,
                              HalfDoubles depth) HWY_ATTR {
            const auto place = hn::Add(origin, hn::Mul(depth, direction));
            const auto backward = hn::Sub(hn::Ceil(place), hn::Set(dd, 1.0));
            const auto there =
                hn::IfThenElse(hn::Lt(direction, hn::Zero(dd)), backward, hn::Floor(place));
            return hn::Min(hn::Max(there, least), most);
        };
        return ints_of(each_half<FloatTag>(cell, rays_->origin[axis],
                                           direction_[static_cast<std::size_t>(axis)], depth_));
    }

    HWY_INLINE Ints cell_at(std::size_t axis) const {
        return hn::Add(cell_[axis], hn::ConvertTo(IntTag(), passed_[axis].v));
    }

    HWY_INLINE Leaps leaps_here(const Ints (&bricks)[3]) const {
        const FloatTag d;
        const IntTag di;
        const auto row = static_cast<std::int32_t>(map_->count[0]);
        const auto slice = static_cast<std::int32_t>(map_->count[0] * map_->count[1]);
        const Ints place = hn::Add(hn::Add(bricks[0], hn::Mul(bricks[1], hn::Set(di, row))),
                                   hn::Mul(bricks[2], hn::Set(di, slice)));
        const auto* const words = reinterpret_cast<const std::int32_t*>(map_->kinds.coded());
        const Ints code = hn::And(hn::GatherOffset(di, words, place), hn::Set(di, 255));
        const Ints kind = hn::Xor(code, hn::Set(di, map_->kinds.background()));
        const auto lanes = hn::Gt(kind, hn::Zero(di));
        const auto constant = hn::Gt(kind, hn::Set(di, CellMap::farthest));
        return {!hn::AllFalse(di, lanes), hn::RebindMask(d, lanes),
                hn::RebindMask(d, hn::AndNot(constant, lanes)),
                hn::And(kind, hn::Set(di, CellMap::farthest))};
    }

    // The brick of the map that holds a cell, on one axis.
    HWY_INLINE Ints brick_of(std::size_t axis, Ints cell) const {
        static_assert(MinMaxBricks::edge == 4);
        const IntTag di;
        const auto last = static_cast<std::int32_t>(map_->count[axis]) - 1;
        const Ints brick = hn::ShiftRight<2>(hn::Add(cell, hn::Set(di, first_[axis])));
        return hn::Min(hn::Max(brick, hn::Zero(di)), hn::Set(di, last));
    }

    // The plane at which a leap ends on one axis, counted from the run's first cell. Cubes at the
    // volume's border go on beyond it.
    HWY_INLINE Number leap_plane(std::size_t axis, Ints brick, Ints reach) const {
        const IntTag di;
        const auto count = static_cast<std::int32_t>(map_->count[axis]);
        const Ints beyond = hn::Set(di, 2);
        Ints upper = hn::Add(brick, reach);
        upper = hn::Add(upper, hn::IfThenElseZero(hn::Gt(upper, hn::Set(di, count - 1)), beyond));
        Ints lower = hn::Add(hn::Sub(brick, reach), hn::Set(di, 1));
        lower = hn::Sub(lower, hn::IfThenElseZero(hn::Lt(lower, hn::Set(di, 1)), beyond));
        const Ints side =
            hn::ShiftLeft<2>(hn::IfThenElse(hn::RebindMask(di, forward_[axis]), upper, lower));
        const Ints plane = hn::Sub(side, hn::Add(cell_[axis], hn::Set(di, first_[axis])));
        return to_number(plane);
    }

    static HWY_INLINE Number to_number(Ints v) { return hn::ConvertTo(FloatTag(), v); }

    HWY_INLINE StoredLanes store(const Ints (&cells)[3], const Leaps& leaps, Number thickness,
                                 CellParts& parts) const {
        const FloatMask shown = hn::AndNot(leaps.empty, thickness > Number(0));
        const StoredLanes lanes = stored_lanes(shown);
        if (lanes.set == 0) return lanes;
        const IntTag di;
        const std::size_t at = parts.count;
        Ints samples[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Beyond the first and the last sample the border value repeats.
            const Ints cell = cells[axis], last = hn::Set(di, last_[axis]);
            const Ints most = hn::Set(di, std::max(last_[axis] - 1, 0));
            const Ints sample = samples[axis] = hn::Min(hn::Max(cell, hn::Zero(di)), most);
            const auto between = hn::And(hn::Gt(cell, hn::Set(di, -1)), hn::Lt(cell, last));
            const Number largest(last_[axis] > 0 ? 1.0f : 0.0f);
            const Number share = place_in_cell(axis, hn::Sub(sample, cell_[axis]));
            store_members(min(max(share, Number(0)), largest).v, shown, parts.place[axis] + at);
            const FloatMask moves = hn::AndNot(leaps.lanes, hn::RebindMask(FloatTag(), between));
            store_members(zero_unless(moves, thickness * slope_[axis]).v, shown,
                          parts.change[axis] + at);
        }
        for (std::size_t axis = 0; lit_ && axis < 3; ++axis)
            store_members(eye_.to_eye[axis].v, shown, parts.to_eye[axis] + at);
        store_members(cell_index(view_->brick, samples[0], samples[1], samples[2]), shown,
                      parts.index + at);
        store_members((thickness * Number(rays_->length_float)).v, shown, parts.length + at);
        parts.count += static_cast<std::size_t>(std::popcount(lanes.set));
        prefetch(parts, at);
        return lanes;
    }

    // Parts beside each other mostly lie in the same lines of the cache.
    HWY_INLINE void prefetch(const CellParts& parts, std::size_t from) const {
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
    HWY_INLINE Number place_in_cell(std::size_t axis, Ints corner) const {
        const TwoDoubles depth = to_doubles(FloatTag(), at_.v), from = doubles_of(corner);
        const TwoDoubles &start = start_[axis], &direction = direction_[axis];
        const auto place = [](HalfDoubles start_place, HalfDoubles way, HalfDoubles along,
                              HalfDoubles corner_place) HWY_ATTR {
            return hn::Sub(hn::Add(start_place, hn::Mul(way, along)), corner_place);
        };
        return to_floats(FloatTag(),
                         TwoDoubles{place(start.low, depth.low, direction.low, from.low),
                                    place(start.high, depth.high, direction.high, from.high)});
    }

    // How far the next step goes from where the run began, and which planes it reaches.
    HWY_INLINE Number end_of_step(const Number (&planes)[3], FloatMask (&passes)[3]) const {
        Number crossings[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            crossings[axis] = (planes[axis] - place_[axis]) * inverse_[axis];
        const Number to =
            max(min(min(crossings[0], crossings[1]), min(crossings[2], run_end_)), at_);
        for (std::size_t axis = 0; axis < 3; ++axis) passes[axis] = crossings[axis] <= to;
        return to;
    }

    // The same in double precision, of a lit walk, which keeps it in way_.
    HWY_INLINE Number precise_end(const Number (&planes)[3], FloatMask (&passes)[3]) {
        const FloatTag d;
        const DoubleTag dd;
        const auto crossing = [](HalfDoubles to, HalfDoubles from, HalfDoubles inverse)
                                  HWY_ATTR { return hn::Mul(hn::Sub(to, from), inverse); };
        const auto minus = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Sub(a, b); };
        const auto nearer = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Min(a, b); };
        TwoDoubles crossings[3];
        way_ = each_half<FloatTag>(minus, end_, depth_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            crossings[axis] = each_half<FloatTag>(crossing, to_doubles(d, planes[axis].v),
                                                  start_[axis], precise_inverse_[axis]);
            way_ = each_half<FloatTag>(nearer, way_, crossings[axis]);
        }
        const auto forward = [&](HalfDoubles way) HWY_ATTR { return hn::Max(way, hn::Zero(dd)); };
        way_ = each_half<FloatTag>(forward, way_);
        const auto reached = [&](HalfDoubles there, HalfDoubles way) HWY_ATTR {
            return hn::IfThenElseZero(hn::Le(there, way), hn::Set(dd, 1.0));
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const TwoDoubles one = each_half<FloatTag>(reached, crossings[axis], way_);
            passes[axis] = to_floats(d, one) > Number(0);
        }
        return to_floats(d, way_);
    }

    // A lit walk begins a run after every step.
    HWY_INLINE void begin_next_run() {
        const auto behind = [](HalfDoubles depth, HalfDoubles end, HalfDoubles way) HWY_ATTR {
            return hn::IfThenElse(hn::Ge(way, hn::Sub(end, depth)), hn::Max(depth, end),
                                  hn::Add(depth, way));
        };
        depth_ = each_half<FloatTag>(behind, depth_, end_, way_);
        for (std::size_t axis = 0; axis < 3; ++axis) cell_[axis] = cell_at(axis);
        begin_run();
    }

    // The cell, counted from the run's first, in which a ray is after a step.
    HWY_INLINE Number cell_after(std::size_t axis, Number to) const {
        if (!lit_) return hn::Floor((place_[axis] + to * slope_[axis]).v);
        const auto cell = [](HalfDoubles start, HalfDoubles way, HalfDoubles direction) HWY_ATTR {
            return hn::Floor(hn::Add(start, hn::Mul(way, direction)));
        };
        return to_floats(FloatTag(),
                         each_half<FloatTag>(cell, start_[axis], way_, direction_[axis]));
    }

    // Enters the next cell on one axis. After a leap that is where the ray is then; it lies in the
    // cube that was crossed, or behind the plane at which the ray leaves it.
    HWY_INLINE void advance(std::size_t axis, const Leaps& leaps, Number plane, FloatMask passes,
                            Number to) {
        const FloatMask forward = forward_[axis];
        if (leaps.some) {
            const Number there = cell_after(axis, to);
            const Number last = plane - zero_unless(forward, Number(1));  // of the cube
            const Number on = min(max(there, passed_[axis]), last);
            const Number back = max(min(there, passed_[axis]), last);
            passed_[axis] = select(leaps.lanes, select(forward, on, back), passed_[axis]);
        }
        const Number behind = plane - zero_unless(hn::Not(forward), Number(1));
        passed_[axis] = select(passes, behind, passed_[axis]);
    }

    const CellMap* map_ = nullptr;  // null where all rays go cell by cell
    const TileBrickView* view_ = nullptr;
    const PacketRays* rays_ = nullptr;
    std::int32_t last_[3], first_[3];  // the brick's last samples, and its place in the volume
    TwoDoubles depth_, end_;
    TwoDoubles way_;  // of lit walks: how far the last step went
    TwoDoubles direction_[3];
    TwoDoubles precise_inverse_[3];
    Number slope_[3], inverse_[3];  // the directions in float
    FloatMask forward_[3];          // towards larger indices
    bool lit_ = false;
    EyeLanes eye_;  // of lit walks
    // At the beginning of a run: the cell, and where the ray is in it.
    Ints cell_[3];
    TwoDoubles start_[3];
    Number place_[3];  // the same in float
    // Since then: cells passed, as whole numbers, and the depth.
    Number passed_[3];
    Number at_, run_end_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
