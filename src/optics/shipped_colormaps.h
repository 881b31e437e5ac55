// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/colormap.h"

namespace lamina {

// Whether lamina has a colour map of this name with it (share/colormaps).
bool is_colormap_name(const std::string& name);

}  // namespace lamina
