// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/capabilities.h"
#include "scene/mesh_facts.h"
#include "scene/omission.h"
#include "scene/project_plan.h"
#include "scene/scene.h"

namespace lamina {

// The part of make_plan() for Method::project. Pre-integration tables are built on the way, to
// measure their error; they are kept (optics/segment_table.h), so that the renderer finds them.
ProjectPlan plan_projection(const Scene& scene, const MeshFacts& facts,
                            const Capabilities& capabilities, const OmissionSwitch& omissions,
                            std::vector<Omission>& omitted);

}  // namespace lamina
