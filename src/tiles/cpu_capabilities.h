// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/capabilities.h"

namespace lamina {

// Returns the capabilities of the engine `cpu` here. `renderer` is, for example, "cpu: AVX3".
Capabilities cpu_capabilities();

}  // namespace lamina
