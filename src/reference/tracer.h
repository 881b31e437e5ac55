// SPDX-License-Identifier: Apache-2.0
// The reference tracer, in double precision, that every picture is compared with. It follows
// viewing rays through the exact trilinear field of a volume (docs/numerics.md, section 9), or from
// tet to tet of a mesh. The field is linear inside a tet, so there every piece of the transfer
// function is integrated in closed form (docs/numerics.md, section 5).
#pragma once

#include <glm/vec4.hpp>

#include "lamina/image.h"
#include "lamina/sampling.h"
#include "lamina/scene.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "mesh/face_tree.h"
#include "reference/tiles.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lamina {

// Traces a picture of a volume. Cells with a NaN or infinite corner are transparent. The result
// does not depend on the number of cores. Throws Error for options out of range.
TraceResult trace_volume(const Volume& volume, const TransferFunction& transfer_function,
                         const View& view, const TraceOptions& options,
                         const TileDone& tile_done = {});

// Results of trace_pixels(): the colours of pixels (column, row), the same as in a whole picture.
struct TracedPixels {
    std::vector<glm::dvec4> rgba;  // associated, linear light, in the order of the pixels
    double error_estimate = 0;     // as in TraceResult
};
TracedPixels trace_pixels(const Volume& volume, const TransferFunction& transfer_function,
                          const View& view, std::span<const glm::ivec2> pixels,
                          const TraceOptions& options);

// Traces a picture of a mesh as trace_volume() does of a volume. `scalar` has one value for each
// point; tets with a value that is not finite are transparent. `open_faces`: tree of open faces.
TraceResult trace_mesh(const TetMesh& mesh, const FaceTree& open_faces,
                       std::span<const double> scalar, const TransferFunction& transfer_function,
                       const View& view, const TraceOptions& options = {},
                       const TileDone& tile_done = {});

// Returns the point on the ray of the pixel (column, row) at which half of the ray's opacity is
// reached; none if it has no opacity. The distance along the ray comes from the tracer's integrals.
std::optional<SeenPoint> seen_point(const Scene& scene, const Volume& volume, double column,
                                    double row);
std::optional<SeenPoint> seen_point(const Scene& scene, const SceneMesh& mesh,
                                    const FaceTree& open_faces, double column, double row);

}  // namespace lamina
