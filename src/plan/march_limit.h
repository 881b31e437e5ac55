// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// llvmpipe silently ends all loops of a fragment after 65535 rounds together
// (LP_MAX_TGSI_LOOP_ITERATIONS); other drivers have no such limit.

// Returns the number of slabs that one fragment can march through. With exact segments, for `slabs`
// slabs, at least least_exact_slabs().
int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                       int slabs);

// Returns the number of slabs into which a ray must be cut so that one fragment can walk through
// the cells of each.
int least_exact_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities);

// Returns the least render.max_error to which one fragment can cut a lit ray; 0 if nothing is
// limited.
double least_lit_error(const Scene& scene, const Facts& facts, const Capabilities& capabilities);

}  // namespace lamina
