// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compositing/tree_shape.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// Errors where the scene's tree, spelled out, cannot be drawn. `single_color`: all that can be seen
// has one colour.
void check_slice_tree(const Scene& scene, bool single_color);
void check_project_tree(const Scene& scene, bool single_color);

// Error where a leaf has more than `most` slabs, the rounds of the context's loops.
void check_leaves(const Scene& scene, const TreeShape& shape, int most,
                  const Capabilities& capabilities);

}  // namespace lamina
