// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/occupied_bricks.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

struct Facts;

// Of N slabs along the ray of each pixel, the share that lies in the box, in bricks that show
// something, in those of them that are constant (Facts::constant_bricks), and of each what comes
// before the ray is as good as opaque: counted on rays all over the picture, from which a plan
// predicts its work.
struct RayShares {
    double box = 0, occupied = 0, constant = 0;
    double box_before_opaque = 0, occupied_before_opaque = 0, constant_before_opaque = 0;
};

// A ray ends where all that may lie behind changes no channel by more than this share of the wanted
// error: less than the errors
// of tables and roundings, so that it may stand in what is measured, too.
inline constexpr double hidden_share = 1.0 / 1024;

// Optical depth behind which nothing changes a channel by more than hidden_share of max_error.
double opaque_depth(double max_error, double max_color);

// Takes its grid, view and bricks from the facts.
RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts);

}  // namespace lamina
