// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/ray_walk.h"
#include "reference/walk_lanes.h"

namespace lamina {

// Walks some lines through a mesh side by side, so that no step waits for the memory of another.
// Each passes the same tets as RayWalk::follow() takes it through, with the same crossings. Each
// thread needs its own object.
class PacketWalk {
  public:
    static constexpr std::size_t width = WalkLanes::width;

    // `values`: one a point, to be interpolated.
    PacketWalk(const TetMesh& mesh, const FaceTree& open_faces, std::span<const double> values);

    // A lane's line, to be aimed before the lane enters.
    RayWalk& ray(std::size_t lane) { return rays_[lane]; }
    // The lane's line enters the mesh, and takes part in step() until it leaves or stops.
    void enter(std::size_t lane, const RayWalk::Entry& entry);
    void stop(std::size_t lane) { walking_ &= ~(1u << lane); }
    bool walks(std::size_t lane) const { return (walking_ >> lane & 1) != 0; }
    bool any_walks() const { return walking_ != 0; }
    // Calls visit(lane) for each that walks. Lanes may stop, and enter again, meanwhile.
    template <typename Visit>
    void for_each(const Visit& visit) {
        for (std::uint32_t left = walking_; left != 0; left &= left - 1)
            visit(static_cast<std::size_t>(std::countr_zero(left)));
    }

    // Takes every line that walks through one more tet.
    void step();

    // Of the last step: the tet, the parameters and the values where the line entered and left it,
    // and the range of the values at its corners.
    std::int32_t tet(std::size_t lane) const { return tets_[lane]; }
    double from(std::size_t lane) const { return lanes_.in.at[lane]; }
    double to(std::size_t lane) const { return lanes_.out.at[lane]; }
    double front(std::size_t lane) const { return lanes_.in.value[lane]; }
    double back(std::size_t lane) const { return lanes_.out.value[lane]; }
    double least(std::size_t lane) const { return lanes_.least[lane]; }
    double most(std::size_t lane) const { return lanes_.most[lane]; }
    TetSegment segment(std::size_t lane) const;
    // Whether there is no tet behind that one.
    bool left(std::size_t lane) const { return next_[lane] == TetMesh::no_neighbor; }

  private:
    void fetch(std::size_t lane);
    void step_alone(std::size_t lane);
    void set_next(std::size_t lane, std::int32_t tet);
    static FaceCrossing crossing(const WalkLanes::Crossing& rows, std::size_t lane);
    void set_crossing(std::size_t lane, const FaceCrossing& crossing);
    RayFront front_of(std::size_t lane) const;
    void set_front(std::size_t lane, const RayFront& front);

    const TetMesh& mesh_;
    std::span<const double> values_;
    std::vector<RayWalk> rays_;
    std::array<std::int32_t, width> tets_{}, next_{};
    std::array<std::size_t, width> steps_{};
    std::uint32_t walking_ = 0;
    WalkLanes lanes_{};
};

}  // namespace lamina
