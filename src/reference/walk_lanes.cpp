// SPDX-License-Identifier: Apache-2.0
// Vector form of RayWalk::step() (mesh/ray_walk.cpp): the same numbers, rounded in the same way.
#include "reference/walk_lanes.h"

#include <limits>

#include "mesh/ray_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/walk_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

class WalkStep {
  public:
    WalkStep(WalkLanes& lanes, std::size_t first) : lanes_(lanes), first_(first) {}

    HWY_INLINE void run() {
        const Seen top = see_top();
        const Doubles to_top[3] = {area_to(0, top), area_to(1, top), area_to(2, top)};
        // The line leaves between the corners whose edges to the top change from negative to
        // positive; the third is left behind.
        const Mask left[3] = {changes(to_top[1], to_top[2]), changes(to_top[2], to_top[0]),
                              changes(to_top[0], to_top[1])};
        settled_ = hn::And(settled_, hn::Or(left[0], hn::Or(left[1], left[2])));
        Doubles areas[3];
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const std::size_t next = (edge + 1) % 3;
            const Doubles kept = load(lanes_.areas[edge]);
            areas[edge] = hn::IfThenElse(left[edge], hn::Neg(to_top[next]),
                                         hn::IfThenElse(left[next], to_top[edge], kept));
            settled_ = hn::And(settled_, hn::Gt(areas[edge], hn::Zero(Lanes())));
        }
        find_range();
        for (std::size_t corner = 0; corner < 3; ++corner) replace(corner, left[corner], top);
        cross(areas);
        for (std::size_t edge = 0; edge < 3; ++edge) store(lanes_.areas[edge], areas[edge]);
        hn::Store(hn::VecFromMask(NumberLanes(), hn::RebindMask(NumberLanes(), settled_)),
                  NumberLanes(), lanes_.settled.data() + first_);
    }

  private:
    using Row = WalkLanes::Row;
    struct Seen {
        Doubles x, y, at, reach;
    };

    HWY_INLINE Doubles load(const Row& row) const { return hn::Load(Lanes(), row.data() + first_); }
    HWY_INLINE Numbers load(const WalkLanes::Numbers& row) const {
        return hn::Load(NumberLanes(), row.data() + first_);
    }
    // In lanes that are settled.
    HWY_INLINE void store(Row& row, Doubles values) const {
        hn::Store(hn::IfThenElse(settled_, values, load(row)), Lanes(), row.data() + first_);
    }

    HWY_INLINE Seen see_top() const {
        Doubles p[3];
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = hn::Sub(load(lanes_.top[i]), load(lanes_.origin[i]));
        const auto along = [&](const std::array<Row, 3>& axis) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(p[0], load(axis[0])), hn::Mul(p[1], load(axis[1]))),
                           hn::Mul(p[2], load(axis[2])));
        };
        const Doubles distance = hn::Add(hn::Add(hn::Abs(p[0]), hn::Abs(p[1])), hn::Abs(p[2]));
        return {along(lanes_.across_x), along(lanes_.across_y),
                hn::Div(along(lanes_.direction), load(lanes_.direction_square)),
                hn::Mul(number(RayWalk::place_error), distance)};
    }

    // Twice the area of the triangle of the line and the edge from a corner to the top. Where its
    // sign is not certain, the lane is not settled.
    HWY_INLINE Doubles area_to(std::size_t corner, const Seen& top) {
        const WalkLanes::Corner& row = lanes_.front[corner];
        const Doubles x = load(row.x), y = load(row.y), reach = load(row.reach);
        const Doubles product = hn::Mul(y, top.x);
        const Doubles area =
            hn::Add(hn::MulSub(x, top.y, product), hn::NegMulAdd(y, top.x, product));
        const Doubles error =
            hn::Add(hn::Add(hn::Mul(hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), reach), top.reach),
                            hn::Mul(hn::Add(hn::Abs(top.x), hn::Abs(top.y)), reach)),
                    hn::Mul(number(std::numeric_limits<double>::epsilon()), hn::Abs(area)));
        settled_ = hn::And(settled_, hn::Gt(hn::Abs(area), error));
        return area;
    }

    static HWY_INLINE Mask changes(Doubles from, Doubles to) {
        const Doubles zero = hn::Zero(Lanes());
        return hn::And(hn::Lt(from, zero), hn::Gt(to, zero));
    }

    HWY_INLINE void find_range() const {
        const Doubles a = load(lanes_.front[0].value), b = load(lanes_.front[1].value),
                      c = load(lanes_.front[2].value), top = load(lanes_.top_value);
        hn::Store(hn::Min(hn::Min(a, b), hn::Min(c, top)), Lanes(), lanes_.least.data() + first_);
        hn::Store(hn::Max(hn::Max(a, b), hn::Max(c, top)), Lanes(), lanes_.most.data() + first_);
    }

    // Puts the top in place of a corner where that is left behind.
    HWY_INLINE void replace(std::size_t corner, Mask left, const Seen& top) const {
        const NumberLanes n;
        const Mask replaced = hn::And(settled_, left);
        const auto replaced_numbers = hn::RebindMask(n, replaced);
        WalkLanes::Corner& row = lanes_.front[corner];
        const auto put = [&](Row& values, Doubles value) HWY_ATTR {
            hn::Store(hn::IfThenElse(replaced, value, load(values)), Lanes(),
                      values.data() + first_);
        };
        put(row.x, top.x);
        put(row.y, top.y);
        put(row.at, top.at);
        put(row.reach, top.reach);
        put(row.value, load(lanes_.top_value));
        const Numbers point = load(row.point);
        hn::Store(hn::IfThenElse(replaced_numbers, point, load(lanes_.left_behind)), n,
                  lanes_.left_behind.data() + first_);
        hn::Store(hn::IfThenElse(replaced_numbers, load(lanes_.top_point), point), n,
                  row.point.data() + first_);
    }

    // As RayWalk::crossing().
    HWY_INLINE void cross(const Doubles (&areas)[3]) const {
        WalkLanes::Crossing& out = lanes_.out();
        const Doubles sum = hn::Add(hn::Add(areas[0], areas[1]), areas[2]);
        const Doubles weights[3] = {hn::Div(areas[1], sum), hn::Div(areas[2], sum),
                                    hn::Div(areas[0], sum)};
        const auto interpolated = [&](Row WalkLanes::Corner::*row) HWY_ATTR {
            const Doubles first = load(lanes_.front[0].*row);
            return hn::Add(
                first, hn::Add(hn::Mul(weights[1], hn::Sub(load(lanes_.front[1].*row), first)),
                               hn::Mul(weights[2], hn::Sub(load(lanes_.front[2].*row), first))));
        };
        store(out.at, hn::Max(interpolated(&WalkLanes::Corner::at), load(lanes_.in().at)));
        store(out.value, interpolated(&WalkLanes::Corner::value));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            store(out.weights[corner], weights[corner]);
            hn::Store(load(lanes_.front[corner].point), NumberLanes(),
                      out.corners[corner].data() + first_);
        }
    }

    WalkLanes& lanes_;
    std::size_t first_;
    // Without fused multiplication and addition, areas are not as accurate as RayWalk has them.
    Mask settled_ =
        HWY_NATIVE_FMA ? hn::FirstN(Lanes(), hn::Lanes(Lanes())) : hn::FirstN(Lanes(), 0);
};

}  // namespace reference

inline void step_lanes_of(WalkLanes& lanes) {
    using namespace reference;
    for (std::size_t first = 0; first < WalkLanes::width; first += hn::Lanes(Lanes()))
        WalkStep(lanes, first).run();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(step_lanes_of);

void step_lanes(WalkLanes& lanes) {
    HWY_DYNAMIC_DISPATCH(step_lanes_of)(lanes);
}

}  // namespace lamina
#endif
