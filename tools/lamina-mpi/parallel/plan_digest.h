// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "plan/plan.h"

namespace lamina {

// A hash of what the renderers of one picture must have in common: what the plan says of all of
// them, and their shares.
std::string digest_of(const SlicePlan& plan, const std::vector<IndexBox>& shares);

}  // namespace lamina
