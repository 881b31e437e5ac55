// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/order_graph.h"

namespace lamina {

// MPVO for nonconvex meshes (Williams, Visibility ordering meshed polyhedra, 1992; Kraus et al.
// 2004 draw with it). It is a depth-first search that draws a tet when all tets behind it across
// shared faces are drawn. It starts at the tets with open faces towards the eye, in descending
// order of the distance of the face's centroid. That order is a guess at what lies behind what
// across gaps. It takes its memory once.
class FarthestFirst {
  public:
    explicit FarthestFirst(const TetMesh& mesh);

    // Fills `order`, one place a tet, back to front. Returns how many edges of the graph are
    // broken, because there is no order without cycles.
    std::int64_t sort(const OrderGraph& graph, std::span<std::int32_t> order);

  private:
    struct Start {
        double distance;
        std::int32_t tet;
        bool operator<(const Start& other) const {  // farthest first
            return distance != other.distance ? distance > other.distance : tet < other.tet;
        }
    };
    void find_starts(const Eye& eye);
    void draw(const OrderGraph& graph, std::int32_t root, std::span<std::int32_t> order);

    const TetMesh& mesh_;
    std::vector<Start> starts_;
    // Next face of each tet to look across (farthest_first.cpp).
    std::vector<std::uint8_t> next_face_;
    std::size_t drawn_ = 0;
    std::int64_t broken_ = 0;
};

}  // namespace lamina
