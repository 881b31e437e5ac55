// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lamina/auto.h"

namespace lamina {

// Codes by which a node of a compositing tree stores its optical depth S. Here sigma is the optical
// depth of a whole ray that is filled like the node's share of it (docs/numerics.md, section 4).
//
//   phi:     1 - exp(-sigma), as in the paper: the opacity if the node's share filled the whole ray
//   alpha:   1 - exp(-S), the node's own opacity
//   minimax: rounding has the same worst effect on the ray's opacity for every sigma
enum class NodeCode { minimax, phi, alpha };

// Arithmetic that composites the children of a node. shader: floats in a program. fixed: a
// fixed-point buffer, as in the paper.
enum class NodeArithmetic { shader, fixed };

struct TreeSettings {
    std::vector<int> factors;  // children of a node, for each level from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
};

// Returns the tree if its factors are given, else null.
inline const TreeSettings* given_tree(const std::optional<Auto<TreeSettings>>& tree) {
    return tree && tree->is_given() ? &**tree : nullptr;
}

}  // namespace lamina
