// SPDX-License-Identifier: Apache-2.0
#include "reference/packet_walk.h"

#include "mesh/scalar_range.h"

namespace lamina {
namespace {

void set_vector(std::array<WalkLanes::Row, 3>& rows, std::size_t lane, const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) rows[static_cast<std::size_t>(axis)][lane] = v[axis];
}

}  // namespace

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
    step_lanes(lanes_);
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
    return mesh_.neighbors()[number][static_cast<std::size_t>(face)];
}

// Each tet is passed at most once. The limit ends walks in meshes that are not valid.
void PacketWalk::move(std::size_t lane, std::int32_t tet) {
    if (tet == TetMesh::no_neighbor || ++steps_[lane] > mesh_.tets().size()) return stop(lane);
    tets_[lane] = tet;
    const auto in_front = [&](std::size_t i) {
        return static_cast<std::int32_t>(lanes_.front[i].point[lane]);
    };
    const std::int32_t top = corner_opposite(mesh_.tets()[static_cast<std::size_t>(tet)],
                                             in_front(0), in_front(1), in_front(2));
    const auto point = static_cast<std::size_t>(top);
    set_vector(lanes_.top, lane, mesh_.points()[point]);
    lanes_.top_value[lane] = values_[point];
    lanes_.top_point[lane] = top;
}

// Takes a step that vectors of floats did not decide.
std::int32_t PacketWalk::step_alone(std::size_t lane) {
    const auto [least, most] =
        range_in(values_, mesh_.tets()[static_cast<std::size_t>(tets_[lane])]);
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
        rows.value[lane] = values_[static_cast<std::size_t>(corner.point)];
        lanes_.areas[i][lane] = front.areas[i];
    }
}

}  // namespace lamina
