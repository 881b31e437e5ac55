// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "scene/scene_mesh.h"
#include "selftest/drawing_way.h"
#include "selftest/pixel_bounds.h"
#include "selftest/selftest_scene.h"

namespace lamina::selftest {

// Every pixel as it is exactly, and where a way to draw may put it.
struct PictureBounds {
    int width = 0, height = 0;
    std::vector<std::array<double, 4>> exact;
    std::vector<PixelBounds> possible;
};

// Of a layered box; `mesh` for ways that draw one.
PictureBounds layered_picture(const SelftestScene& scene, const DrawingWay& way,
                              const SceneMesh* mesh);

// Of any mesh in one colour: opacity follows from the optical depths of its tets together, in
// whatever order they come.
PictureBounds one_color_picture(const Scene& scene, const DrawingWay& way, const SceneMesh& mesh);

// How a picture fits.
struct Fit {
    bool fits = true;
    double error = 0, bound = 0;  // in 1/255, where it fits worst
    double largest_error = 0;     // in 1/255
    std::string where;            // "pixel 3, 4, channel R", for what does not fit
};
Fit fit_of(const PreciseImage& picture, const PictureBounds& bounds);

// Of two pictures of the same thing: no further apart than both bounds allow.
Fit fit_of(const PreciseImage& a, const PictureBounds& bounds_a, const PreciseImage& b,
           const PictureBounds& bounds_b);

}  // namespace lamina::selftest
