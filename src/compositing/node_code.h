// SPDX-License-Identifier: Apache-2.0
// Codes of nodes: how a node of a compositing tree stores its optical depth in the alpha channel of
// a low-precision image (docs/numerics.md, section 4). Twin of shaders/compositing/node_code.glsl,
// to float32.
#pragma once

#include "lamina/tree_settings.h"

namespace lamina {

// The optical depth that a code of 1 represents: opaque.
inline constexpr double opaque_node_depth = 1e4;

// Returns the code in [0, 1] of optical depth S >= 0 in a node that holds `share` (0 < share <= 1)
// of its ray's samples. sigma = S / share is the optical depth of a whole ray that is filled like
// the node.
double encode_depth(NodeCode code, double depth, double share);

// Returns the optical depth S of a code in [0, 1].
double decode_depth(NodeCode code, double value, double share);

}  // namespace lamina
