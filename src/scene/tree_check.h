// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace lamina {

// Errors where the scene's tree, spelled out, cannot be drawn. `single_color`: all that can be seen
// has one colour.
void check_slice_tree(const Scene& scene, bool single_color);
void check_project_tree(const Scene& scene, bool single_color);

}  // namespace lamina
