// SPDX-License-Identifier: Apache-2.0
// Follows lines through a mesh from tet to tet, one in each lane of a vector:
//   1. `front` holds the face by which the line enters: its three corners projected along the line,
//      and for each edge twice the signed area of the triangle (line, edge).
//   2. While there is a tet behind the face:
//      a. `top` = the tet's fourth corner, which is not in `front`.
//      b. area_to(i) = twice the signed area of the triangle (line, edge from front[i] to `top`).
//      c. The line leaves by the face of `top` and of the two corners between which area_to turns
//         from - to +.
//      d. Replace the third corner of `front` by `top`, and interpolate where the line crosses.
// If rounding leaves the sign of an area unknown in a lane, RayWalk::step() does that lane exactly.
// A segment between two crossings is drawn only if it may be visible:
//   1. Cut it to the range that the clip keeps; at its new ends interpolate the scalar linearly.
//   2. It may be visible if an interval of the transfer function between its ends has extinction.
#pragma once

#include "mesh/ray_walk.h"
#include "reference/chord.h"
#include "reference/transfer_intervals.h"
#include "simd/lane_set.h"

namespace lamina {

// The state of all lines, line i in column i. Names are as in LineFrame, RayFront, FaceCrossing.
struct WalkLanes {
    static constexpr std::size_t width = longest_vector;
    using Row = LaneRow;
    struct alignas(64) Numbers : std::array<std::int64_t, width> {};

    // (x, y): place across the line; at: parameter along it; reach: bound on the rounding of x, y.
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
    // The corner of the tet that is not in front: its place, value and index.
    std::array<Row, 3> top;
    Row top_value;
    Numbers top_point;

    std::array<Corner, 3> front;
    std::array<Row, 3> areas;
    std::array<Crossing, 2> crossings;  // in() and out(): where the line enters and leaves the tet
    std::size_t entry = 0;  // index of in() in `crossings`; toggled, so that out() becomes in()
    Crossing& in() { return crossings[entry]; }
    Crossing& out() { return crossings[1 - entry]; }
    const Crossing& in() const { return crossings[entry]; }
    const Crossing& out() const { return crossings[1 - entry]; }
    Row least, most;  // values at the tet's corners

    Numbers left_behind;  // the corner of the entered face that is not in the face of exit
    Numbers settled;      // not 0: the step is done; 0: rounding leaves the sign of an area unknown
};

// Walks lines side by side, so that one waits for memory while others are computed. Each passes the
// same tets, with the same crossings, as RayWalk::follow(). Each thread needs its own object.
class PacketWalk {
  public:
    static constexpr std::size_t width = WalkLanes::width;

    // `values`: one a point, to be interpolated.
    PacketWalk(const TetMesh& mesh, const FaceTree& open_faces, std::span<const double> values);

    // Returns the line of a lane. The caller aims it before enter().
    RayWalk& ray(std::size_t lane) { return rays_[lane]; }
    // Starts the line at an entry. step() moves it until it leaves the mesh or stop() is called.
    void enter(std::size_t lane, const RayWalk::Entry& entry);
    void stop(std::size_t lane) { walking_ &= ~lane_bit(lane); }
    LaneSet walking() const { return walking_; }

    // Moves all walking lines through one tet.
    void step();

    // Returns the tet that the last step passed.
    std::int32_t tet(std::size_t lane) const { return passed_[lane]; }
    const WalkLanes& lanes() const { return lanes_; }
    TetSegment segment(std::size_t lane) const;

  private:
    std::int32_t tet_behind(std::size_t lane) const;
    std::int32_t step_alone(std::size_t lane);
    void move(std::size_t lane, std::int32_t tet);
    void take_corners(std::size_t lane);
    void enter_again(std::size_t lane);
    static FaceCrossing crossing(const WalkLanes::Crossing& rows, std::size_t lane);
    void set_crossing(std::size_t lane, const FaceCrossing& crossing);
    RayFront front_of(std::size_t lane) const;
    void set_front(std::size_t lane, const RayFront& front);

    const TetMesh& mesh_;
    std::span<const double> values_;
    std::vector<RayWalk> rays_;
    std::array<std::int32_t, width> passed_{}, tets_{};
    std::array<std::size_t, width> steps_{};
    LaneSet walking_ = 0;
    WalkLanes lanes_{};
};

// The part of a tet's segment that the clip keeps, between two parameters of the ray. The scalar is
// linear, from `front` to `back`. The segment is empty unless from < to.
struct SeenSegment {
    double from, to;
    double front, back;
};
// Cuts a tet's segment, from the ray's entry into the tet to its exit, to the range `seen`.
SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen);
SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar);

struct SeenLanes {
    using Row = LaneRow;

    Row first, last;  // SeenRange
    Row world_per_z;  // world length per unit of the parameter

    Row from, to, front, back;  // SeenSegment
    Row length;                 // in world units
    Row slack;                  // scalar_slack()
    LaneSet shown = 0;          // lanes whose segment is not empty and may be visible
};

inline constexpr double scalar_epsilons = 64;
// Bounds the rounding error of a scalar interpolated in a tet with values least..most: 0 if these
// are equal, else scalar_epsilons epsilons of the larger absolute value.
inline double scalar_slack(double least, double most) {
    if (least == most) return 0;
    return scalar_epsilons * std::numeric_limits<double>::epsilon() *
           std::max(std::abs(least), std::abs(most));
}

// Sets the SeenSegments of the lanes and tells which may be visible.
void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen);

}  // namespace lamina
