// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <teem/nrrd.h>

#include <string>

#include "lamina/grid.h"

namespace lamina {

// The grid that a parsed header describes (docs/scene.md, "What is drawn"). `file` is for messages.
// `has_spacings`: the header has a field of that name, which then must give every spacing that
// nothing else tells. Throws Error where the axes are not three, not spatial, not orthogonal, or
// not finite.
Grid nrrd_grid(const std::string& file, const Nrrd& nrrd, bool has_spacings);

}  // namespace lamina
