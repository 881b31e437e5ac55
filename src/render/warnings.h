// SPDX-License-Identifier: Apache-2.0
// Warnings about data, plan and picture that every front end shows in these words.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/client.h"
#include "choice/field.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "plan/plan.h"
#include "scene/scene.h"
#include "visibility/visibility_order.h"
#include "volume/volume_data.h"

namespace lamina {

using Warnings = std::vector<std::string>;

// Warns of samples and cells that are not drawn, or are drawn otherwise than the file says.
Warnings data_warnings(const VolumeData& data);
Warnings data_warnings(const Scene& scene, const SceneMesh& mesh);

// Warns of errors above the scene's max_error, and of colours that the target clamps. Nothing in
// the scene may be automatic.
Warnings plan_warnings(const Scene& scene, const SlicePlan& plan);
// Warns of colours that the target clamps, and of tets of the mesh that overlap others, if their
// order counts.
Warnings plan_warnings(const Scene& scene, const ProjectPlan& plan, const MeshOverlap& overlap);

// Warns of tets that were drawn in a wrong order.
Warnings frame_warnings(const OrderReport& order);
// Warns of pixels whose rays meet tets that overlap.
Warnings trace_warnings(std::int64_t overlapping_rays);

void warn_of_all(const Warnings& all);

// Warns if the picture shows (almost) nothing, with the reason; if more than half of the pixels
// that show something are saturated; and if the colours change only outside the data's range.
// Nothing in the scene may be automatic; `field` is that of its data.
void warn_of_picture(const Scene& scene, const Field& field, const Image& picture);

// Returns the number of points of the transfer function whose colour has a component above 1, which
// a fixed-point target clamps; 0 for other targets.
std::int64_t clamped_colors(const Scene& scene);

}  // namespace lamina
