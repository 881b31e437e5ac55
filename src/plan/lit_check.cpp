// SPDX-License-Identifier: Apache-2.0
#include "plan/lit_check.h"

#include "base/error.h"

namespace lamina {

void check_lit_slicing(const Scene& scene) {
    if (!scene.lighting) return;
    fail("{}: lighting: method \"slice\" draws no lit pictures yet, expected method \"trace\"",
         scene.file.string());
}

// The two colourings interpolate colours, or one opacity, between the vertices of a fan: they have
// no place for a gradient.
void check_lit_projection(const Scene& scene) {
    if (!scene.lighting) return;
    const Coloring coloring = scene.project.coloring;
    if (coloring == Coloring::vertex || coloring == Coloring::attenuation) {
        fail(
            "{}: render.project.coloring: found \"{}\", expected \"preintegrated\" or \"analytic\" "
            "with lighting",
            scene.file.string(), name_of(coloring));
    }
    fail("{}: lighting: method \"project\" draws no lit pictures yet, expected method \"trace\"",
         scene.file.string());
}

}  // namespace lamina
