// SPDX-License-Identifier: Apache-2.0
// Scalars along rays of the view, on which tables of segments are tried.
#pragma once

#include <vector>

#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

struct Facts;
struct MinMaxBricks;

struct ScalarRays {
    struct Ray {
        double length_per_depth = 1;  // world length per unit of eye-space depth
        double near = 0, far = 0;     // eye-space depths where it enters and leaves the clipped box
        // The scalar, and the optical depth in front of it, at two or more evenly spaced depths
        // from `near` to `far`.
        std::vector<float> scalars;
        std::vector<float> optical_depths;
    };
    std::vector<Ray> rays;  // all over the picture, each through the box
};

// Largest numbers of rays, and of scalars on a ray.
struct RaySampling {
    std::size_t rays = 1024;
    double scalars = 1024;
};

// Samples rays; grid and view come from the facts. `bricks`: those of the volume, or null; with
// them less is read of a volume that stays in its files.
ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts,
                       const MinMaxBricks* bricks = nullptr, const RaySampling& sampling = {});

}  // namespace lamina
