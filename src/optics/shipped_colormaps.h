// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "optics/colormap.h"

namespace lamina {

// The names of the colour maps that lamina has with it (share/colormaps), in order of name.
std::vector<std::string> colormap_names();
bool is_colormap_name(const std::string& name);

// The shipped map of this name, or else the ParaView preset of this path. Throws Error: with the
// nearest name where there is neither.
Colormap load_colormap(const std::string& name_or_path,
                       ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina
