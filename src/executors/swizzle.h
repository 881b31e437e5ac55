// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "compositing/tree_shape.h"

namespace lamina {

// What each code of a child is worth in its node (LaMar 2004, section 6.2): 1 - (1 - Phi)^share
// times the largest code, as its whole part and the rest, in double precision.
struct Swizzle {
    std::vector<float> whole, rest;
};

// All that a tree of fixed-point nodes needs, by the samples of child and node. `bits`: of a code.
using Swizzles = std::map<std::pair<int, int>, Swizzle>;
Swizzles make_swizzles(const TreeShape& shape, int bits);

}  // namespace lamina
