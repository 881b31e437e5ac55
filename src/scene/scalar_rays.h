// SPDX-License-Identifier: Apache-2.0
// Scalars along rays of the view: what tables of segments are tried on.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "volume/volume.h"

namespace lamina {

struct Facts;

struct ScalarRays {
    struct Ray {
        double length_per_depth = 1;  // world length per unit of eye-space depth
        // At depths evenly from `near` to `far`: the scalar, NaN outside of the box, and the
        // optical depth in front of it.
        std::vector<float> scalars;
        std::vector<float> optical_depths;
    };
    double near = 0, far = 0;  // eye-space depths of the first and the last scalar
    std::vector<Ray> rays;     // all over the picture, each with some scalar inside the box
};

// Takes its grid and view from the facts.
ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts);

}  // namespace lamina
