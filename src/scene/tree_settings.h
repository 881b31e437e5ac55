// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "compositing/node_code.h"

namespace lamina {

// Who composites in a node of a tree: a program, in float, or a fixed-point buffer (the paper's).
enum class NodeArithmetic { shader, fixed };

struct TreeSettings {
    bool automatic = false;    // "tree": "auto": the plan chooses factors and code
    std::vector<int> factors;  // from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
};

}  // namespace lamina
