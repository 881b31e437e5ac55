// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/occupied_bricks.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

struct Facts;

// Shares of the slabs along the rays of all pixels: of those in the clipped box, of those in bricks
// that show something, and of those in constant ones of these bricks (Facts::constant_bricks). The
// members *_before_opaque count only slabs before the ray is as good as opaque. All are counted on
// rays all over the picture, and a plan predicts its work from them.
struct RayShares {
    double box = 0, occupied = 0, constant = 0;
    double box_before_opaque = 0, occupied_before_opaque = 0, constant_before_opaque = 0;
};

// A ray ends where all that may lie behind changes no channel by more than this share of max_error.
// The share is less than the errors of tables and roundings, so that measurements may end rays,
// too.
inline constexpr double hidden_share = 1.0 / 1024;

// The optical depth behind which nothing changes a channel by more than hidden_share of max_error.
double opaque_depth(double max_error, double max_color);

// Takes the grid, the view and the bricks from the facts.
RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts);

}  // namespace lamina
