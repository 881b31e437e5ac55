// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"

namespace lamina::view {

// Returns the bifurcation factors of a scene's tree, from the root to the leaves: "[16, 8, 4]";
// "auto", "none". The tree is one of slices or, if the scene draws tets, of tets.
std::string factors_text(const Scene& scene);

// Returns the scene with other factors: as above, or as scene files may have them ("16x8x4", "4^5",
// "1024", an empty text for none). Other settings of the tree stay. Throws Error for a text of
// another form, with what was found and what was expected.
Scene with_factors(const Scene& scene, const std::string& text);

// Removes the tree.
void without_tree(Scene& scene);

}  // namespace lamina::view
