// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/capabilities.h"

namespace lamina {

// Of the native engine on this machine; the renderer is "cpu: AVX3".
Capabilities tile_capabilities();

}  // namespace lamina
