// SPDX-License-Identifier: Apache-2.0
// The reference for every picture of a tetrahedral mesh. It follows the viewing rays from tet to
// tet in double precision. The field is linear inside a tet, so every piece of the transfer
// function is integrated in closed form (docs/numerics.md, section 5).
#pragma once

#include <cstdint>
#include <span>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "mesh/face_tree.h"
#include "mesh/tet_mesh.h"
#include "reference/tiles.h"
#include "scene/camera.h"

namespace lamina {

struct MeshTraceResult {
    PreciseImage image;  // associated RGBA in linear light, before any background
    // The largest error over all pixels and channels, as a share of full scale. It is a bound on
    // the rounding in segments and in the places where the ray crosses faces. Nothing else is
    // approximate but light, which is integrated to the tolerance.
    double error_estimate = 0;
    std::int64_t segments = 0;  // number of ray segments inside one tet that were integrated
    // Number of rays on which the mesh overlaps itself. There its tets are composited one after the
    // other, in the order in which the ray enters them.
    std::int64_t overlapping_rays = 0;
};

// `scalar`: one value a point. Tets with a corner whose value is NaN or infinite are transparent.
// `open_faces`: tree of the mesh's open faces. It uses all cores; the result does not depend on
// their number. Throws Error for options out of range.
MeshTraceResult trace_mesh(const TetMesh& mesh, const FaceTree& open_faces,
                           std::span<const double> scalar,
                           const TransferFunction& transfer_function, const View& view,
                           const TraceOptions& options = {}, const TileDone& tile_done = {});

}  // namespace lamina
