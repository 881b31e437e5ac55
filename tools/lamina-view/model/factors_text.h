// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"

namespace lamina::view {

// Returns the bifurcation factors of a scene's tree, from the root to the leaves: "[16, 8, 4]";
// "auto", "none". The tree is one of slices or, if the scene draws tets, of tets.
std::string factors_text(const Scene& scene);

// The scene with other factors: as above, or as scene files may have them ("16x8x4", "4^5", "1024",
// nothing at all for none). What else it says of the tree stays. Throws Error if it makes no
// sense, with what was found and what was expected.
Scene with_factors(const Scene& scene, const std::string& text);

// Takes the tree away.
void without_tree(Scene& scene);

}  // namespace lamina::view
