// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "compositing/tree_shape.h"

namespace lamina {

// The value of each code Phi of a child in its node (LaMar 2004, section 6.2): 1 - (1 - Phi)^share
// times the largest code. It is computed in double precision and split into its whole part and the
// rest.
struct Swizzle {
    std::vector<float> whole, rest;
};

// Swizzles that a tree of fixed-point nodes needs. The key is the number of samples of the child
// and of the node. `bits`: length of a code.
using Swizzles = std::map<std::pair<int, int>, Swizzle>;
Swizzles make_swizzles(const TreeShape& shape, int bits);

}  // namespace lamina
