// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/capabilities.h"

namespace lamina {

// The capabilities of the native engine on this machine. The renderer's name is, for example, "cpu:
// AVX3".
Capabilities tile_capabilities();

}  // namespace lamina
