// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// Throws Error where the picture does not fit the context's render targets.
void check_limits(const Scene& scene, const Capabilities& capabilities);

}  // namespace lamina
