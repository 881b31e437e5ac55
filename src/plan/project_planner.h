// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/mesh_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/omission.h"
#include "plan/project_plan.h"

namespace lamina {

// Makes the plan for Method::project. It builds pre-integration tables to measure their error. They
// are kept (optics/segment_table.h), so that the renderer does not build them again.
ProjectPlan plan_projection(const Scene& scene, const MeshFacts& facts,
                            const Capabilities& capabilities, const OmissionSwitch& omissions,
                            std::vector<Omission>& omitted);

}  // namespace lamina
