// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/occupied_bricks.h"
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

}  // namespace lamina
