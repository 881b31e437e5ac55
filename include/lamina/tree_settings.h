// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// How a node of a tree stores its optical depth S, with which it would fill a whole ray with the
// depth sigma (docs/numerics.md, section 4).
// phi:     1 - exp(-sigma), the paper's: opacity as if the node's share filled the whole ray
// alpha:   1 - exp(-S), the node's own opacity
// minimax: equal worst effect of one rounding on the ray's opacity, for every sigma
enum class NodeCode { minimax, phi, alpha };

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
