// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace lamina {

// The gradient in a tet of one view, linear in space, for a lit cell fragment: beside its
// record, as shaders/projection/silhouette.vert reads it: 3 uvec4. Gradients are in the axes of
// the world and in units in which the longest at a point of the mesh is 1
// (projection/stored_gradients.h).
struct alignas(16) GradientRecord {
    // One component: at the point of SeenTet::center, its change along the ray per unit of z, and
    // its change per pixel to the right and upwards (in perspective views, per pixel at z = 1).
    struct Component {
        float at_center, per_z, per_column, per_row;
    };
    std::array<Component, 3> components;
};
static_assert(sizeof(GradientRecord) == 48);

}  // namespace lamina
