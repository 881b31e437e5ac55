// SPDX-License-Identifier: Apache-2.0
// Lines through a mesh, side by side, from tet to tet:
//
//   front = the corners of the face by which the line enters, and the areas of the triangles that
//           the line makes with its edges, seen along the line
//   while there is a tet behind the face:
//       top = the tet's corner that is not in front; in = the crossing by which the line entered
//       area_to[i] = the triangle of the line and the edge from front[i] to the top
//       the line leaves by the top and the two corners between which area_to turns from - to +
//       replace the third corner in front by the top; out = the crossing of this face
//
// A lane in which floats do not decide the sign of an area takes its step by RayWalk::step(), which
// is exact. Both find the same digits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/ray_walk.h"
#include "simd/lane_set.h"

namespace lamina {

// The memory of PacketWalk: a number a line in each row. Lines are as in LineFrame, faces as in
// RayFront and FaceCrossing.
struct WalkLanes {
    static constexpr std::size_t width = longest_vector;
    using Row = LaneRow;
    struct alignas(64) Numbers : std::array<std::int64_t, width> {};

    struct Corner {
        Row x, y, at, reach;
        Row value;
        Numbers point;
    };
    struct Crossing {
        std::array<Row, 3> weights;
        std::array<Numbers, 3> corners;
        Row at, value;
    };

    std::array<Row, 3> origin, direction, across_x, across_y;
    Row direction_square;
    // These describe the corner of the tet that is not in front.
    std::array<Row, 3> top;
    Row top_value;
    Numbers top_point;

    std::array<Corner, 3> front;
    std::array<Row, 3> areas;
    std::array<Crossing, 2> crossings;  // of the tet that is passed: in() and out()
    std::size_t entry = 0;              // number of in(): out() becomes in()
    Crossing& in() { return crossings[entry]; }
    Crossing& out() { return crossings[1 - entry]; }
    const Crossing& in() const { return crossings[entry]; }
    const Crossing& out() const { return crossings[1 - entry]; }
    Row least, most;  // values at the tet's corners

    Numbers left_behind;  // the point of the face of entry that is not in the face of exit
    Numbers settled;      // not 0: the step is done; 0: floats do not decide it
};

// Walks some lines through a mesh side by side, so that one waits for memory while others are
// computed. Each passes the tets that RayWalk::follow() takes it through, with the same crossings.
// Each thread needs its own object.
class PacketWalk {
  public:
    static constexpr std::size_t width = WalkLanes::width;

    // `values`: one a point, to be interpolated.
    PacketWalk(const TetMesh& mesh, const FaceTree& open_faces, std::span<const double> values);

    // Returns a lane's line, to be aimed before the lane enters.
    RayWalk& ray(std::size_t lane) { return rays_[lane]; }
    // Lets the lane's line enter the mesh. step() moves it on until it leaves or stops.
    void enter(std::size_t lane, const RayWalk::Entry& entry);
    void stop(std::size_t lane) { walking_ &= ~lane_bit(lane); }
    LaneSet walking() const { return walking_; }

    // Takes every line that walks through one more tet.
    void step();

    // Results of the last step: the tets that the lines passed, and the places at which they
    // entered and left them.
    std::int32_t tet(std::size_t lane) const { return passed_[lane]; }
    const WalkLanes& lanes() const { return lanes_; }
    TetSegment segment(std::size_t lane) const;

  private:
    std::int32_t tet_behind(std::size_t lane) const;
    std::int32_t step_alone(std::size_t lane);
    void move(std::size_t lane, std::int32_t tet);
    static FaceCrossing crossing(const WalkLanes::Crossing& rows, std::size_t lane);
    void set_crossing(std::size_t lane, const FaceCrossing& crossing);
    RayFront front_of(std::size_t lane) const;
    void set_front(std::size_t lane, const RayFront& front);

    const TetMesh& mesh_;
    std::span<const double> values_;
    std::vector<RayWalk> rays_;
    std::array<std::int32_t, width> passed_{}, tets_{};  // by the last step, and by the next one
    std::array<std::size_t, width> steps_{};
    LaneSet walking_ = 0;
    WalkLanes lanes_{};
};

}  // namespace lamina
