// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"

namespace lamina::view {

// Returns the bifurcation factors of a scene's tree, from the root to the leaves, as "[16, 8, 4]",
// "auto" or "none". The tree is that of tets if the scene draws tets, else that of slabs.
std::string factors_text(const Scene& scene);

// Returns the scene with other factors, in the form of factors_text() or of scene files ("16x8x4",
// "4^5", "1024"); an empty text is "none". Other settings of the tree stay. Throws Error for any
// other text.
Scene with_factors(const Scene& scene, const std::string& text);

void without_tree(Scene& scene);

}  // namespace lamina::view
