// SPDX-License-Identifier: Apache-2.0
// LaMar's ramp (2004, section 4) as a scene.
#pragma once

#include <vector>

#include "optics/opacity.h"
#include "slicing_fixture.h"

namespace lamina {

inline constexpr int ramp_width = 256, ramp_height = 4;

// Returns the scene. Value x has opacity x / 255 over the volume's depth of one unit; each pixel
// looks at one voxel.
inline Scene ramp_scene(const glm::dvec3& color) {
    std::vector<TransferKnot> points;
    for (int x = 0; x < ramp_width; ++x) {
        points.push_back(knot(x, color, extinction_from_opacity(x / 255.0, 1)));
    }
    Scene scene;
    scene.slice.classification = Classification::post;
    scene.transfer_function = TransferFunction::nearest(points);
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {127.5, 1.5, 10};
    scene.camera->center = {127.5, 1.5, 0};
    scene.camera->height = ramp_height;
    scene.width = ramp_width;
    scene.height = ramp_height;
    scene.target = Target::emulated;
    return scene;
}

}  // namespace lamina
