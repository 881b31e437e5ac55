// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Counts the pixels on whose rays an order has two tets in reverse.
struct OrderPixels {
    std::int64_t covered = 0;  // pixels whose ray meets a tet
    std::int64_t wrong = 0;    // covered pixels that are wrong
    // Wrong pixels with a wrong pair that is not within one reported cycle.
    std::int64_t outside_cycles = 0;
    // Those outside cycles on whose ray the mesh overlaps itself.
    std::int64_t overlapping = 0;
};

// Checks the orders' last results, for eye_of(view), against the exact list of the tets on each
// ray. Segments count if longer than 1e-12 of the way to the mesh's end: places have errors of some
// 1e-15. Calls `row_done` after each row, from any thread. Parallel.
std::vector<OrderPixels> judge_pixels(const TetMesh& mesh, const FaceTree& open_faces,
                                      const View& view,
                                      std::span<const VisibilityOrder* const> orders,
                                      const std::function<void()>& row_done = {});

}  // namespace lamina
