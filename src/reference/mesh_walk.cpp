// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_walk.h"

#include "mesh/tet_mesh.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/mesh_walk.cpp"
#include "simd/foreach_target.h"

#include "reference/cut-inl.h"
#include "simd/double_doubles-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// RayWalk::step() (mesh/ray_walk.cpp) for a vector of lines, with the same rounding.
class WalkStep {
  public:
    WalkStep(WalkLanes& lanes, std::size_t first) : lanes_(lanes), first_(first) {}

    LAMINA_INLINE void run() {
        const Projected top = project_top();
        const Double to_top[3] = {area_to(0, top), area_to(1, top), area_to(2, top)};
        // is_left_behind[i]: lanes in which corner i is not in the face of exit. The line leaves
        // between the corners whose areas to the top change from negative to positive.
        const DoubleMask is_left_behind[3] = {changes(to_top[1], to_top[2]),
                                              changes(to_top[2], to_top[0]),
                                              changes(to_top[0], to_top[1])};
        settled_ = settled_ & (is_left_behind[0] | (is_left_behind[1] | is_left_behind[2]));
        Double areas[3];
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const std::size_t next = (edge + 1) % 3;
            const Double kept = get(lanes_.areas[edge]);
            areas[edge] = select(is_left_behind[edge], -to_top[next],
                                 select(is_left_behind[next], to_top[edge], kept));
            settled_ = settled_ & (areas[edge] > 0);
        }
        find_range();
        for (std::size_t corner = 0; corner < 3; ++corner)
            replace(corner, is_left_behind[corner], top);
        cross(areas);
        for (std::size_t edge = 0; edge < 3; ++edge) put(lanes_.areas[edge], areas[edge]);
        store(minus_one_in(settled_), lanes_.settled.data() + first_);
    }

  private:
    using Row = WalkLanes::Row;
    struct Projected {
        Double x, y, at, reach;
    };

    LAMINA_INLINE Double get(const Row& row) const { return load<Double>(row.data() + first_); }
    LAMINA_INLINE Long get(const WalkLanes::Numbers& row) const {
        return load<Long>(row.data() + first_);
    }
    LAMINA_INLINE void put(Row& row, Double values) const {
        store(select(settled_, values, get(row)), row.data() + first_);
    }

    LAMINA_INLINE Projected project_top() const {
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

    // Returns twice the area of the triangle of the line and the edge from a corner to the top.
    // Lanes in which rounding leaves its sign unknown become unsettled.
    LAMINA_INLINE Double area_to(std::size_t corner, const Projected& top) {
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

    // Replaces the corner that is not in the face of exit by the tet's fourth one.
    LAMINA_INLINE void replace(std::size_t corner, DoubleMask is_left_behind,
                               const Projected& top) const {
        const DoubleMask replaced = settled_ & is_left_behind;
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
    // Lanes in which rounding cannot change a sign; none without fma, as areas are less accurate.
    DoubleMask settled_ = DoubleMask(has_fma);
};

// Cuts a vector of segments as seen_segment() does. Returns the lanes that may be visible.
LAMINA_INLINE LaneSet find_seen_from(const WalkLanes& walk, const VisibleRanges& visible,
                                     std::size_t lane, SeenLanes& seen) {
    const auto get = [&](const WalkLanes::Row& row)
                         LAMINA_LAMBDA { return load<Double>(row.data() + lane); };
    const auto put = [&](WalkLanes::Row& row, Double values)
                         LAMINA_LAMBDA { store(values, row.data() + lane); };
    const Double enter = get(walk.in().at), leave = get(walk.out().at);
    const Double at_enter = get(walk.in().value), at_leave = get(walk.out().value);
    const Double first = get(seen.first), last = get(seen.last);
    const Double slope = (at_leave - at_enter) / (leave - enter);
    const DoubleMask cut_first = (enter < first), cut_last = (leave > last);
    const Double from = select(cut_first, first, enter), to = select(cut_last, last, leave);
    const Double front = select(cut_first, at_enter + slope * (first - enter), at_enter);
    const Double back = select(cut_last, at_leave - slope * (leave - last), at_leave);
    const Double least = get(walk.least), most = get(walk.most);
    const Double bound =
        scalar_epsilons * std::numeric_limits<double>::epsilon() * max(abs(least), abs(most));
    const Double slack = zero_if(least == most, bound);
    put(seen.from, from);
    put(seen.to, to);
    put(seen.front, front);
    put(seen.back, back);
    put(seen.length, (to - from) * get(seen.world_per_z));
    put(seen.slack, slack);
    const DoubleMask shows = visible.meet(min(front, back) - slack, max(front, back) + slack);
    return bits_of(shows & (from < to));
}

}  // namespace reference

// Steps all lines. Lanes in which rounding leaves a sign unknown keep their state.
inline void step_lanes_of(WalkLanes& lanes) {
    using namespace reference;
    for (std::size_t first = 0; first < WalkLanes::width; first += Double::lanes)
        WalkStep(lanes, first).run();
}

inline void find_seen_of(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    using namespace reference;
    const VisibleRanges visible(intervals);
    seen.shown = 0;
    for (std::size_t lane = 0; lane < WalkLanes::width; lane += Double::lanes)
        seen.shown |= find_seen_from(walk, visible, lane, seen) << lane;
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {
namespace {

void set_vector(std::array<WalkLanes::Row, 3>& rows, std::size_t lane, const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) rows[axis][lane] = v[axis];
}

}  // namespace

LAMINA_EXPORT(step_lanes_of);
LAMINA_EXPORT(find_seen_of);

SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen) {
    if (whole.from >= seen.from && whole.to <= seen.to) return whole;
    if (whole.to <= seen.from || whole.from >= seen.to || seen.from >= seen.to) return {0, 0, 0, 0};
    SeenSegment cut = whole;
    const double slope = (cut.back - cut.front) / (cut.to - cut.from);
    if (cut.to > seen.to) {
        cut.back -= slope * (cut.to - seen.to);
        cut.to = seen.to;
    }
    if (cut.from < seen.from) {
        cut.front += slope * (seen.from - cut.from);
        cut.from = seen.from;
    }
    return cut;
}

SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar) {
    return seen_segment({segment.in.at, segment.out.at, segment.in.interpolate(scalar),
                         segment.out.interpolate(scalar)},
                        seen);
}

void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    LAMINA_DISPATCH(find_seen_of)(walk, intervals, seen);
}

PacketWalk::PacketWalk(const TetMesh& mesh, const FaceTree& open_faces,
                       std::span<const double> values)
    : mesh_(mesh), values_(values), rays_(width, RayWalk(mesh, open_faces)) {}

void PacketWalk::enter(std::size_t lane, const RayWalk::Entry& entry) {
    const LineFrame& line = rays_[lane].line();
    set_vector(lanes_.origin, lane, line.origin);
    set_vector(lanes_.direction, lane, line.direction);
    set_vector(lanes_.across_x, lane, line.across_x);
    set_vector(lanes_.across_y, lane, line.across_y);
    lanes_.direction_square[lane] = line.direction_square;
    const RayFront front = rays_[lane].front_of(entry.face);
    set_front(lane, front);
    set_crossing(lane, RayWalk::crossing(front));
    walking_ |= lane_bit(lane);
    steps_[lane] = 0;
    move(lane, entry.face.tet);
}

void PacketWalk::step() {
    lanes_.entry = 1 - lanes_.entry;
    if (mesh_.has_copies()) for_each_lane(walking_, [&](std::size_t lane) { enter_again(lane); });
    LAMINA_DISPATCH(step_lanes_of)(lanes_);
    for_each_lane(walking_, [&](std::size_t lane) {
        passed_[lane] = tets_[lane];
        move(lane, lanes_.settled[lane] != 0 ? tet_behind(lane) : step_alone(lane));
    });
}

std::int32_t PacketWalk::tet_behind(std::size_t lane) const {
    const auto number = static_cast<std::size_t>(tets_[lane]);
    const Tet& tet = mesh_.tets()[number];
    const auto left = static_cast<std::int32_t>(lanes_.left_behind[lane]);
    const int face = (tet[1] == left) + 2 * (tet[2] == left) + 3 * (tet[3] == left);
    return mesh_.neighbors()[number][face];
}

// Moves a line into a tet, or stops it. The limit (each tet once) ends walks in invalid meshes.
void PacketWalk::move(std::size_t lane, std::int32_t tet) {
    if (tet == TetMesh::no_neighbor || ++steps_[lane] > mesh_.tets().size()) return stop(lane);
    tets_[lane] = tet;
    if (mesh_.has_copies()) take_corners(lane);
    const auto in_front = [&](std::size_t i) {
        return static_cast<std::int32_t>(lanes_.front[i].point[lane]);
    };
    const std::int32_t top =
        corner_opposite(mesh_.tets()[tet], in_front(0), in_front(1), in_front(2));
    const auto point = static_cast<std::size_t>(top);
    set_vector(lanes_.top, lane, mesh_.points()[point]);
    lanes_.top_value[lane] = values_[point];
    lanes_.top_point[lane] = top;
}

// Makes the corners of the entered face those of the tet behind it.
void PacketWalk::take_corners(std::size_t lane) {
    for (WalkLanes::Corner& rows : lanes_.front) {
        const auto point = static_cast<std::int32_t>(rows.point[lane]);
        const std::int32_t own = mesh_.corner_at(tets_[lane], point);
        rows.point[lane] = own;
        rows.value[lane] = values_[own];
    }
}

// Makes in(), which was out() of the tet before, that of the tet which the line enters.
void PacketWalk::enter_again(std::size_t lane) {
    FaceCrossing entered = crossing(lanes_.in(), lane);
    for (std::size_t i = 0; i < 3; ++i) {
        entered.corners[i] = static_cast<std::int32_t>(lanes_.front[i].point[lane]);
        lanes_.in().corners[i][lane] = entered.corners[i];
    }
    lanes_.in().value[lane] = entered.interpolate(values_);
}

// Takes the step of one line, exactly, if rounding left a sign unknown.
std::int32_t PacketWalk::step_alone(std::size_t lane) {
    const auto [least, most] = range_in(values_, mesh_.tets()[tets_[lane]]);
    lanes_.least[lane] = least;
    lanes_.most[lane] = most;
    TetSegment segment{tets_[lane], crossing(lanes_.in(), lane), {}};
    RayFront front = front_of(lane);
    const std::int32_t behind = rays_[lane].step(segment, front);
    set_front(lane, front);
    set_crossing(lane, segment.out);
    return behind;
}

TetSegment PacketWalk::segment(std::size_t lane) const {
    return {passed_[lane], crossing(lanes_.in(), lane), crossing(lanes_.out(), lane)};
}

FaceCrossing PacketWalk::crossing(const WalkLanes::Crossing& rows, std::size_t lane) {
    FaceCrossing result;
    for (std::size_t i = 0; i < 3; ++i) {
        result.corners[i] = static_cast<std::int32_t>(rows.corners[i][lane]);
        result.weights[i] = rows.weights[i][lane];
    }
    result.at = rows.at[lane];
    return result;
}

void PacketWalk::set_crossing(std::size_t lane, const FaceCrossing& crossing) {
    for (std::size_t i = 0; i < 3; ++i) {
        lanes_.out().corners[i][lane] = crossing.corners[i];
        lanes_.out().weights[i][lane] = crossing.weights[i];
    }
    lanes_.out().at[lane] = crossing.at;
    lanes_.out().value[lane] = crossing.interpolate(values_);
}

RayFront PacketWalk::front_of(std::size_t lane) const {
    RayFront front;
    for (std::size_t i = 0; i < 3; ++i) {
        const WalkLanes::Corner& rows = lanes_.front[i];
        front.corners[i] = {static_cast<std::int32_t>(rows.point[lane]), rows.x[lane], rows.y[lane],
                            rows.at[lane], rows.reach[lane]};
        front.areas[i] = lanes_.areas[i][lane];
    }
    return front;
}

void PacketWalk::set_front(std::size_t lane, const RayFront& front) {
    for (std::size_t i = 0; i < 3; ++i) {
        const RayFront::Corner& corner = front.corners[i];
        WalkLanes::Corner& rows = lanes_.front[i];
        rows.point[lane] = corner.point;
        rows.x[lane] = corner.x;
        rows.y[lane] = corner.y;
        rows.at[lane] = corner.at;
        rows.reach[lane] = corner.reach;
        rows.value[lane] = values_[corner.point];
        lanes_.areas[i][lane] = front.areas[i];
    }
}

}  // namespace lamina
#endif
