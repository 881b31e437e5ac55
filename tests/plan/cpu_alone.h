// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/capabilities.h"

namespace lamina {

// Returns what the cpu engine can do.
inline Capabilities cpu_alone() {
    Capabilities capabilities;
    capabilities.cpu = true;
    capabilities.max_texture_size = capabilities.max_3d_texture_size = 16384;
    return capabilities;
}

}  // namespace lamina
