// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Counts the pixels on whose rays a visibility order has two tets in reverse ("wrong" pixels).
struct OrderPixels {
    std::int64_t covered = 0;  // pixels whose ray meets a tet
    std::int64_t wrong = 0;    // covered pixels on whose ray two tets are in reverse
    // Wrong pixels with a reversed pair of tets that do not share a reported cycle of the order.
    std::int64_t outside_cycles = 0;
    // Pixels of outside_cycles on whose ray the mesh overlaps itself.
    std::int64_t overlapping = 0;
};

// Checks the last results of some orders, for eye_of(view), against the exact tets on each ray.
// Segments count if longer than 1e-12 of the distance to the mesh's far end (places err by 1e-15).
// Calls `row_done` after each row, from any thread. Parallel.
std::vector<OrderPixels> judge_pixels(const TetMesh& mesh, const FaceTree& open_faces,
                                      const View& view,
                                      std::span<const VisibilityOrder* const> orders,
                                      const std::function<void()>& row_done = {});

}  // namespace lamina
