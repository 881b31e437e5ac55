// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/colormap.h"

namespace lamina {

// Tells whether lamina ships a colour map of this name (share/colormaps).
bool is_colormap_name(const std::string& name);

}  // namespace lamina
