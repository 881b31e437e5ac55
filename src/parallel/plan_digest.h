// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "plan/plan.h"

namespace lamina {

// A hash of what the renderers of one picture have in common, of the plan and of their shares.
// Renderers whose data differ have different ones.
std::string digest_of(SlicePlan plan, const std::vector<IndexBox>& shares);

}  // namespace lamina
