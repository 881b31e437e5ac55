// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/mesh_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/omission.h"
#include "plan/project_plan.h"
#include "preintegration/table_cache.h"

namespace lamina {

// Makes the plan for Method::project. Pre-integration tables are built to measure their error.
ProjectPlan plan_projection(const Scene& scene, const MeshFacts& facts,
                            const Capabilities& capabilities, const OmissionSwitch& omissions,
                            std::vector<Omission>& omitted, TableCache& tables);

}  // namespace lamina
