// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/ray_walk.h"
#include "reference/walk_lanes.h"
#include "simd/lane_set.h"

namespace lamina {

// Walks some lines through a mesh side by side, so that one is read for from memory while others
// are computed. Each passes the same tets as RayWalk::follow() takes it through, with the same
// crossings. Each thread needs its own object.
class PacketWalk {
  public:
    static constexpr std::size_t width = WalkLanes::width;

    // `values`: one a point, to be interpolated.
    PacketWalk(const TetMesh& mesh, const FaceTree& open_faces, std::span<const double> values);

    // A lane's line, to be aimed before the lane enters.
    RayWalk& ray(std::size_t lane) { return rays_[lane]; }
    // The lane's line enters the mesh, and takes part in step() until it leaves or stops.
    void enter(std::size_t lane, const RayWalk::Entry& entry);
    void stop(std::size_t lane) { walking_ &= ~lane_bit(lane); }
    LaneSet walking() const { return walking_; }

    // Takes every line that walks through one more tet.
    void step();

    // These tell of the last step: which tets the lines passed, and where they entered and left
    // them.
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
