// SPDX-License-Identifier: Apache-2.0
// Vector form of RayWalk::step() (mesh/ray_walk.cpp): the same numbers, rounded in the same way.
#include "reference/walk_lanes.h"

#include <limits>

#include "mesh/ray_walk.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/walk_lanes.cpp"
#include "simd/foreach_target.h"

#include "simd/double_doubles-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

class WalkStep {
  public:
    WalkStep(WalkLanes& lanes, std::size_t first) : lanes_(lanes), first_(first) {}

    LAMINA_INLINE void run() {
        const Seen top = see_top();
        const Double to_top[3] = {area_to(0, top), area_to(1, top), area_to(2, top)};
        // The line leaves between the corners whose edges to the top change from negative to
        // positive; the third is left behind.
        const DoubleMask left[3] = {changes(to_top[1], to_top[2]), changes(to_top[2], to_top[0]),
                                    changes(to_top[0], to_top[1])};
        settled_ = settled_ & (left[0] | (left[1] | left[2]));
        Double areas[3];
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const std::size_t next = (edge + 1) % 3;
            const Double kept = get(lanes_.areas[edge]);
            areas[edge] = select(left[edge], -to_top[next], select(left[next], to_top[edge], kept));
            settled_ = settled_ & (areas[edge] > 0);
        }
        find_range();
        for (std::size_t corner = 0; corner < 3; ++corner) replace(corner, left[corner], top);
        cross(areas);
        for (std::size_t edge = 0; edge < 3; ++edge) put(lanes_.areas[edge], areas[edge]);
        store(minus_one_in(settled_), lanes_.settled.data() + first_);
    }

  private:
    using Row = WalkLanes::Row;
    struct Seen {
        Double x, y, at, reach;
    };

    LAMINA_INLINE Double get(const Row& row) const { return load<Double>(row.data() + first_); }
    LAMINA_INLINE Long get(const WalkLanes::Numbers& row) const {
        return load<Long>(row.data() + first_);
    }
    // In lanes that are settled.
    LAMINA_INLINE void put(Row& row, Double values) const {
        store(select(settled_, values, get(row)), row.data() + first_);
    }

    LAMINA_INLINE Seen see_top() const {
        Double p[3];
        for (std::size_t i = 0; i < 3; ++i) p[i] = get(lanes_.top[i]) - get(lanes_.origin[i]);
        const auto along = [&](const std::array<Row, 3>& axis) LAMINA_LAMBDA {
            return p[0] * get(axis[0]) + p[1] * get(axis[1]) + p[2] * get(axis[2]);
        };
        const Double distance = abs(p[0]) + abs(p[1]) + abs(p[2]);
        return {along(lanes_.across_x), along(lanes_.across_y),
                along(lanes_.direction) / get(lanes_.direction_square),
                RayWalk::place_error * distance};
    }

    // Twice the area of the triangle of the line and the edge from a corner to the top. Where its
    // sign is not certain, the lane is not settled.
    LAMINA_INLINE Double area_to(std::size_t corner, const Seen& top) {
        const WalkLanes::Corner& row = lanes_.front[corner];
        const Double x = get(row.x), y = get(row.y), reach = get(row.reach);
        const Double product = y * top.x;
        const Double area = fms(x, top.y, product) + fnma(y, top.x, product);
        const Double error = (abs(x) + abs(y) + reach) * top.reach +
                             (abs(top.x) + abs(top.y)) * reach +
                             std::numeric_limits<double>::epsilon() * abs(area);
        settled_ = settled_ & (abs(area) > error);
        return area;
    }

    static LAMINA_INLINE DoubleMask changes(Double from, Double to) {
        return (from < 0) & (to > 0);
    }

    LAMINA_INLINE void find_range() const {
        const Double a = get(lanes_.front[0].value), b = get(lanes_.front[1].value),
                     c = get(lanes_.front[2].value), top = get(lanes_.top_value);
        store(min(min(a, b), min(c, top)), lanes_.least.data() + first_);
        store(max(max(a, b), max(c, top)), lanes_.most.data() + first_);
    }

    // Puts the top in place of a corner where that is left behind.
    LAMINA_INLINE void replace(std::size_t corner, DoubleMask left, const Seen& top) const {
        const DoubleMask replaced = settled_ & left;
        WalkLanes::Corner& row = lanes_.front[corner];
        const auto set = [&](Row& values, Double value) LAMINA_LAMBDA {
            store(select(replaced, value, get(values)), values.data() + first_);
        };
        set(row.x, top.x);
        set(row.y, top.y);
        set(row.at, top.at);
        set(row.reach, top.reach);
        set(row.value, get(lanes_.top_value));
        const Long point = get(row.point);
        store(select(replaced, point, get(lanes_.left_behind)), lanes_.left_behind.data() + first_);
        store(select(replaced, get(lanes_.top_point), point), row.point.data() + first_);
    }

    // As RayWalk::crossing().
    LAMINA_INLINE void cross(const Double (&areas)[3]) const {
        WalkLanes::Crossing& out = lanes_.out();
        const Double sum = areas[0] + areas[1] + areas[2];
        const Double weights[3] = {areas[1] / sum, areas[2] / sum, areas[0] / sum};
        const auto interpolated = [&](Row WalkLanes::Corner::*row) LAMINA_LAMBDA {
            const Double first = get(lanes_.front[0].*row);
            return first + (weights[1] * (get(lanes_.front[1].*row) - first) +
                            weights[2] * (get(lanes_.front[2].*row) - first));
        };
        put(out.at, max(interpolated(&WalkLanes::Corner::at), get(lanes_.in().at)));
        put(out.value, interpolated(&WalkLanes::Corner::value));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            put(out.weights[corner], weights[corner]);
            store(get(lanes_.front[corner].point), out.corners[corner].data() + first_);
        }
    }

    WalkLanes& lanes_;
    std::size_t first_;
    // Without fused multiplication and addition, areas are not as accurate as RayWalk has them.
    DoubleMask settled_ = DoubleMask(fuses);
};

}  // namespace reference

inline void step_lanes_of(WalkLanes& lanes) {
    using namespace reference;
    for (std::size_t first = 0; first < WalkLanes::width; first += Double::lanes)
        WalkStep(lanes, first).run();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(step_lanes_of);

void step_lanes(WalkLanes& lanes) {
    LAMINA_DISPATCH(step_lanes_of)(lanes);
}

}  // namespace lamina
#endif
