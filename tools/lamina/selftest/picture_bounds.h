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

// The exact value of every pixel, and the bounds between which a way to draw may put it.
struct PictureBounds {
    int width = 0, height = 0;
    std::vector<std::array<double, 4>> exact;
    std::vector<PixelBounds> possible;
};

// The bounds for a layered box; `mesh` is for ways that draw a mesh.
PictureBounds layered_picture(const SelftestScene& scene, const DrawingWay& way,
                              const SceneMesh* mesh);

// The bounds for any mesh in one colour. Opacity follows from the sum of the optical depths of its
// tets, in whatever order they are drawn.
PictureBounds one_color_picture(const Scene& scene, const DrawingWay& way, const SceneMesh& mesh);

// How well a picture fits its bounds.
struct Fit {
    bool fits = true;
    double error = 0, bound = 0;  // in 1/255, in the pixel and channel that fits worst
    double largest_error = 0;     // in 1/255
    std::string where;            // where it does not fit: "pixel 3, 4, channel R"
};
Fit fit_of(const PreciseImage& picture, const PictureBounds& bounds);

// How well two pictures of the same thing fit: they may differ by no more than both bounds allow.
Fit fit_of(const PreciseImage& a, const PictureBounds& bounds_a, const PreciseImage& b,
           const PictureBounds& bounds_b);

}  // namespace lamina::selftest
