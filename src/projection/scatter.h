// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "projection/tet_part.h"

namespace lamina {

// A random order, the same whatever the order before: parts of one region come to lie in different
// leaves of a tree.
void scatter(std::span<TetPart> parts);

}  // namespace lamina
