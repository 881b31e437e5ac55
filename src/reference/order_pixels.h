// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Counts the pixels that an order gets wrong: the viewing ray through the pixel's centre meets two
// tets one after the other, and the order has them in reverse.
struct OrderPixels {
    std::int64_t covered = 0;  // pixels whose ray meets a tet
    std::int64_t wrong = 0;    // covered pixels that are wrong
    // Wrong pixels with a wrong pair that is not within one reported cycle.
    std::int64_t outside_cycles = 0;
    // Those outside cycles on whose ray the mesh overlaps itself.
    std::int64_t overlapping = 0;
};

// Checks the last result of each order, which must have been sorted for eye_of(view), against the
// exact list of the tets on each ray. A segment of a ray counts if it is longer than 1e-12 of the
// distance from the eye to the end of the mesh. Positions on a ray have errors of some 1e-15 of
// that distance, and shorter segments are invisible. `open_faces`: tree of the mesh's open faces.
// Calls `row_done` after each row, from any thread. Parallel; the result does not depend on the
// number of threads.
std::vector<OrderPixels> judge_pixels(const TetMesh& mesh, const FaceTree& open_faces,
                                      const View& view,
                                      std::span<const VisibilityOrder* const> orders,
                                      const std::function<void()>& row_done = {});

}  // namespace lamina
