// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/bricks.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

struct Facts;

// Shares of the slabs along the rays of all pixels: in the clipped box, in visible bricks, and in
// the constant ones of these (Facts::constant_bricks). Members *_before_opaque count only slabs
// before the ray is almost opaque. They are counted on rays all over the picture, and a plan
// predicts its work from them.
struct RayShares {
    double box = 0, occupied = 0, constant = 0;
    double box_before_opaque = 0, occupied_before_opaque = 0, constant_before_opaque = 0;
};

// Share of max_error: a ray ends if nothing behind can change a channel by more than this. It is
// less than the errors of tables and roundings, so that measurements may end rays, too.
inline constexpr double hidden_share = 1.0 / 1024;

// Returns the optical depth behind which nothing changes a channel by more than hidden_share of
// max_error.
double opaque_depth(double max_error, double max_color);

// Measures the shares; grid, view and bricks come from the facts.
RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts);

// Scalars along rays of the view, on which tables of segments are tried.

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
