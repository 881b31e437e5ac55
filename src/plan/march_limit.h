// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// How many slabs one fragment can march through. llvmpipe silently ends all loops of a fragment
// after 65535 rounds together (LP_MAX_TGSI_LOOP_ITERATIONS); other drivers have no such limit.
int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities);

}  // namespace lamina
