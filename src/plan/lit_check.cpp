// SPDX-License-Identifier: Apache-2.0
#include "plan/lit_check.h"

#include "base/error.h"

namespace lamina {

namespace {

void check_smallest_gradient(const Scene& scene) {
    if (scene.lighting->smallest_gradient) return;
    fail("{}: lighting.smallest_gradient: has not been chosen from the data", scene.file.string());
}

}  // namespace

void check_lit_slicing(const Scene& scene) {
    if (!scene.lighting) return;
    check_smallest_gradient(scene);
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
