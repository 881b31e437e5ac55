// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/mesh_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/omission.h"
#include "plan/project_plan.h"

namespace lamina {

// The part of make_plan() for Method::project. Pre-integration tables are built on the way, to
// measure their error; they are kept (optics/segment_table.h), so that the renderer finds them.
ProjectPlan plan_projection(const Scene& scene, const MeshFacts& facts,
                            const Capabilities& capabilities, const OmissionSwitch& omissions,
                            std::vector<Omission>& omitted);

}  // namespace lamina
