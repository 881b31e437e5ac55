// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/point_probe.h"
#include "lamina/scene.h"
#include "mesh/face_tree.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Returns the point of the ray through (column, row) of the scene's picture at which half of the
// ray's opacity is reached: 1 - exp(-depth in front of it) is half of 1 - exp(-depth of the whole
// ray). Depths are those of the tracer. None if the ray has no opacity.
std::optional<SeenPoint> seen_point(const Scene& scene, const Volume& volume, double column,
                                    double row);
// `open_faces`: tree of the mesh's open faces.
std::optional<SeenPoint> seen_point(const Scene& scene, const SceneMesh& mesh,
                                    const FaceTree& open_faces, double column, double row);

}  // namespace lamina
