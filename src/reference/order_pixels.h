// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/eye.h"
#include "mesh/face_tree.h"
#include "mesh/tet_mesh.h"
#include "visibility/visibility_order.h"
#include "scene/camera.h"

namespace lamina {

// Pixels that an order gets wrong: two tets are met by the viewing ray through the pixel's centre
// one after the other, and are not drawn so.
struct OrderPixels {
    std::int64_t covered = 0;         // pixels whose ray meets a tet
    std::int64_t wrong = 0;           // of these
    std::int64_t outside_cycles = 0;  // of these: a wrong pair is not within one reported cycle
    std::int64_t overlapping = 0;     // of these: parts of the mesh overlap on the ray
};

// Judges what each of the orders last sorted, which must have been for eye_of(view), by the exact
// list of the tets on each ray. A part of a ray counts where it is longer than 1e-12 of the ray's
// way from the eye to the end of the mesh: places on a ray are good to some 1e-15 of that, and what
// is shorter cannot be seen. `open_faces`: of the mesh. Calls `row_done` after each row, from any
// thread. Parallel; the result does not depend on the number of threads.
std::vector<OrderPixels> judge_pixels(const TetMesh& mesh, const FaceTree& open_faces,
                                      const View& view,
                                      std::span<const VisibilityOrder* const> orders,
                                      const std::function<void()>& row_done = {});

}  // namespace lamina
