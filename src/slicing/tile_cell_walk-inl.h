// SPDX-License-Identifier: Apache-2.0
// The cells along the rays of a packet, front to back (Amanatides and Woo 1987). Every crossing of
// a plane is computed from the plane itself and in double precision, so that errors do not
// accumulate: reference/cell_walk.h in vectors, with steps over bricks that show nothing.
#if defined(LAMINA_SLICING_TILE_CELL_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#undef LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#else
#define LAMINA_SLICING_TILE_CELL_WALK_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/cell_map.h"
#include "slicing/tile_cell_parts-inl.h"
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
    void begin(const CellMap& map, const TileBrickView& view, const PacketRays& rays,
               const DepthSpan& span) {
        map_ = &map;
        view_ = &view;
        rays_ = &rays;
        depth_ = span.enter;
        end_ = span.leave;
        for (int axis = 0; axis < 3; ++axis) begin_axis(axis);
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

    // Steps until the parts are full or all rays have ended. A ray's steps do not depend on the
    // rays beside it.
    void run(CellParts& parts) {
        parts.clear();
        while (parts.steps < CellParts::most_steps && !done()) step(parts);
    }

  private:
    // How a step goes: over one cell, or over the cube of bricks around it.
    struct Leaps {
        bool some;
        FloatMask lanes;  // over bricks
        FloatMask empty;  // over bricks that show nothing
        Ints reach;
    };

    HWY_INLINE void begin_axis(int axis) {
        const DoubleTag dd;
        const auto least = hn::Set(dd, 1e-20);  // a ray along a plane never crosses it
        const double first = std::floor(view_->box.min[axis]);
        const double last = std::ceil(view_->box.max[axis]) - 1;
        const auto begin = [&](HalfDoubles origin, HalfDoubles there, HalfDoubles depth,
                               HalfDoubles& direction, HalfDoubles& inverse) HWY_ATTR {
            direction = hn::IfThenElse(hn::Lt(hn::Abs(there), least), least, there);
            inverse = hn::Div(hn::Set(dd, 1.0), direction);
            const auto place = hn::Add(origin, hn::Mul(depth, direction));
            const auto backward = hn::Sub(hn::Ceil(place), hn::Set(dd, 1.0));
            const auto cell =
                hn::IfThenElse(hn::Lt(direction, hn::Zero(dd)), backward, hn::Floor(place));
            return hn::Min(hn::Max(cell, hn::Set(dd, first)), hn::Set(dd, last));
        };
        origin_[axis] = rays_->origin[axis];
        const TwoDoubles& there = rays_->direction[axis];
        const TwoDoubles cell{begin(origin_[axis].low, there.low, depth_.low, direction_[axis].low,
                                    inverse_[axis].low),
                              begin(origin_[axis].high, there.high, depth_.high,
                                    direction_[axis].high, inverse_[axis].high)};
        cell_[axis] = ints_of(cell);
        const IntTag di;
        const FloatTag d;
        const auto forward = hn::Gt(to_floats(d, direction_[axis]), hn::Zero(d));
        forward_[axis] = hn::IfThenElseZero(hn::RebindMask(di, forward), hn::Set(di, 1));
        last_[axis] = static_cast<std::int32_t>(view_->brick.last_sample[static_cast<std::size_t>(axis)]);
    }

    // The brick of the map that holds the cell, on one axis.
    HWY_INLINE Ints brick_on(int axis) const {
        const IntTag di;
        const auto first = static_cast<std::int32_t>(view_->first[axis]);
        const auto last = static_cast<std::int32_t>(map_->count[static_cast<std::size_t>(axis)]) - 1;
        const Ints brick = hn::ShiftRight<2>(hn::Add(cell_[axis], hn::Set(di, first)));
        return hn::Min(hn::Max(brick, hn::Zero(di)), hn::Set(di, last));
    }

    HWY_INLINE Leaps leaps_here() const {
        static_assert(MinMaxBricks::edge == 4);
        const FloatTag d;
        const IntTag di;
        const FloatMask none = hn::FirstN(d, 0);
        if (map_->kinds.empty()) return {false, none, none, hn::Zero(di)};
        const auto row = static_cast<std::int32_t>(map_->count[0]);
        const auto slice = static_cast<std::int32_t>(map_->count[0] * map_->count[1]);
        const Ints place = hn::Add(hn::Add(brick_on(0), hn::Mul(brick_on(1), hn::Set(di, row))),
                                   hn::Mul(brick_on(2), hn::Set(di, slice)));
        const auto* const words = reinterpret_cast<const std::int32_t*>(map_->kinds.data());
        const Ints kind = hn::And(hn::GatherOffset(di, words, place), hn::Set(di, 255));
        const auto lanes = hn::Gt(kind, hn::Zero(di));
        const auto constant = hn::Gt(kind, hn::Set(di, CellMap::farthest));
        return {!hn::AllFalse(di, lanes), hn::RebindMask(d, lanes),
                hn::RebindMask(d, hn::AndNot(constant, lanes)),
                hn::And(kind, hn::Set(di, CellMap::farthest))};
    }

    // The plane at which a step ends on one axis. Cubes at the volume's border go on beyond it.
    HWY_INLINE Ints plane_on(int axis, const Leaps& leaps) const {
        const IntTag di;
        const Ints next = hn::Add(cell_[axis], forward_[axis]);
        if (!leaps.some) return next;
        const auto count = static_cast<std::int32_t>(map_->count[static_cast<std::size_t>(axis)]);
        const auto first = static_cast<std::int32_t>(view_->first[axis]);
        const Ints brick = brick_on(axis), one = hn::Set(di, 1), beyond = hn::Set(di, 2);
        const auto forward = hn::Gt(forward_[axis], hn::Zero(di));
        Ints upper = hn::Add(brick, leaps.reach);
        upper = hn::Add(upper, hn::IfThenElseZero(hn::Gt(upper, hn::Set(di, count - 1)), beyond));
        Ints lower = hn::Add(hn::Sub(brick, leaps.reach), one);
        lower = hn::Sub(lower, hn::IfThenElseZero(hn::Lt(lower, hn::Set(di, 1)), beyond));
        const Ints side = hn::ShiftLeft<2>(hn::IfThenElse(forward, upper, lower));
        return hn::IfThenElse(hn::RebindMask(di, leaps.lanes), hn::Sub(side, hn::Set(di, first)),
                              next);
    }

    HWY_INLINE void step(CellParts& parts) {
        const Leaps leaps = leaps_here();
        Ints planes[3];
        TwoDoubles crossings[3];
        TwoDoubles to = end_;
        for (int axis = 0; axis < 3; ++axis) {
            planes[axis] = plane_on(axis, leaps);
            const TwoDoubles plane = doubles_of(planes[axis]);
            const auto cross = [](HalfDoubles at, HalfDoubles origin, HalfDoubles inverse)
                                   HWY_ATTR { return hn::Mul(hn::Sub(at, origin), inverse); };
            crossings[axis] = each_half<FloatTag>(cross, plane, origin_[axis], inverse_[axis]);
            to.low = hn::Min(to.low, crossings[axis].low);
            to.high = hn::Min(to.high, crossings[axis].high);
        }
        to.low = hn::Max(to.low, depth_.low);
        to.high = hn::Max(to.high, depth_.high);
        const auto minus = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Sub(a, b); };
        const Floats thickness = to_floats(FloatTag(), each_half<FloatTag>(minus, to, depth_));
        store(leaps, thickness, parts);
        for (int axis = 0; axis < 3; ++axis) advance(axis, leaps, planes[axis], crossings[axis], to);
        depth_ = to;
    }

    HWY_INLINE void store(const Leaps& leaps, Floats thickness, CellParts& parts) const {
        const FloatTag d;
        const FloatMask shown =
            hn::AndNot(leaps.empty, hn::Gt(thickness, hn::Zero(d)));
        StoredLanes& lanes = parts.lanes[parts.steps++];
        lanes = stored_lanes(shown);
        if (lanes.set == 0) return;
        const IntTag di;
        const std::size_t at = parts.count;
        const std::int32_t steps[3] = {1, view_->brick.row, view_->brick.slice};
        Ints index = hn::Zero(di);
        for (int axis = 0; axis < 3; ++axis) {
            // Beyond the first and the last sample the border value repeats.
            const Ints last = hn::Set(di, last_[axis]);
            const Ints most = hn::Set(di, std::max(last_[axis] - 1, 0));
            const Ints sample = hn::Min(hn::Max(cell_[axis], hn::Zero(di)), most);
            const auto between =
                hn::And(hn::Gt(cell_[axis], hn::Set(di, -1)), hn::Lt(cell_[axis], last));
            index = hn::Add(index, hn::Mul(sample, hn::Set(di, steps[axis])));
            const auto from_sample = [](HalfDoubles there, HalfDoubles place)
                                         HWY_ATTR { return hn::Sub(place, there); };
            const auto along = [](HalfDoubles depth, HalfDoubles direction, HalfDoubles origin)
                                   HWY_ATTR { return hn::Add(origin, hn::Mul(depth, direction)); };
            const TwoDoubles place =
                each_half<FloatTag>(along, depth_, direction_[axis], origin_[axis]);
            const Floats share =
                to_floats(d, each_half<FloatTag>(from_sample, doubles_of(sample), place));
            const float largest = last_[axis] > 0 ? 1.0f : 0.0f;
            store_members(hn::Min(hn::Max(share, hn::Zero(d)), hn::Set(d, largest)), shown,
                          parts.place[axis] + at);
            const FloatMask moves = hn::AndNot(leaps.lanes, hn::RebindMask(d, between));
            store_members(hn::IfThenElseZero(moves, hn::Mul(thickness, rays_->direction_float[axis])),
                          shown, parts.change[axis] + at);
        }
        store_members(index, shown, parts.index + at);
        store_members(hn::Mul(thickness, rays_->length_float), shown, parts.length + at);
        parts.count += static_cast<std::size_t>(std::popcount(lanes.set));
    }

    // Enters the next cell on one axis. After a leap that is where the ray is then; it lies in the
    // cube that was crossed, or behind the plane at which the ray leaves it.
    HWY_INLINE void advance(int axis, const Leaps& leaps, Ints plane, const TwoDoubles& crossing,
                            const TwoDoubles& to) {
        const FloatTag d;
        const IntTag di;
        const auto minus = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Sub(a, b); };
        const Floats ahead = to_floats(d, each_half<FloatTag>(minus, crossing, to));
        const auto crossed = hn::RebindMask(di, hn::Le(ahead, hn::Zero(d)));
        const Ints one = hn::Set(di, 1);
        const Ints behind = hn::Sub(hn::Add(plane, forward_[axis]), one);
        if (leaps.some) {
            const auto floor_along = [](HalfDoubles depth, HalfDoubles direction,
                                        HalfDoubles origin) HWY_ATTR {
                return hn::Floor(hn::Add(origin, hn::Mul(depth, direction)));
            };
            const Ints there =
                ints_of(each_half<FloatTag>(floor_along, to, direction_[axis], origin_[axis]));
            const auto forward = hn::Gt(forward_[axis], hn::Zero(di));
            const Ints limit = hn::Sub(plane, forward_[axis]);  // the cube's last cell
            const Ints on = hn::Min(hn::Max(there, cell_[axis]), limit);
            const Ints back = hn::Max(hn::Min(there, cell_[axis]), limit);
            cell_[axis] = hn::IfThenElse(hn::RebindMask(di, leaps.lanes),
                                         hn::IfThenElse(forward, on, back), cell_[axis]);
        }
        cell_[axis] = hn::IfThenElse(crossed, behind, cell_[axis]);
    }

    const CellMap* map_ = nullptr;
    const TileBrickView* view_ = nullptr;
    const PacketRays* rays_ = nullptr;
    TwoDoubles depth_, end_;
    TwoDoubles origin_[3], direction_[3], inverse_[3];
    Ints cell_[3];
    Ints forward_[3];  // 1 where the ray goes towards larger indices, else 0
    std::int32_t last_[3];  // last samples
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
