// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compositing/tree_shape.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// Throws Error where a tree whose factors the scene gives cannot be drawn. `single_color`: whether
// all that can be seen has one colour.
void check_slice_tree(const Scene& scene, bool single_color);
void check_project_tree(const Scene& scene, bool single_color);

// Throws Error where a leaf has more than `most` slabs, the limit of the context's loops
// (plan/march_limit.h).
void check_leaves(const Scene& scene, const TreeShape& shape, int most,
                  const Capabilities& capabilities);

}  // namespace lamina
