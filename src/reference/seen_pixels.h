// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "reference/trace_tiles.h"
#include "scene/camera.h"

namespace lamina {

// Some pixels of a tile, counted from its first: those from `first` to `last`.
struct SeenPixels {
    glm::ivec2 first, last;

    bool empty() const { return first.x > last.x || first.y > last.y; }
};

// The pixels of a tile whose lines, which go on behind the eye, may meet the convex hull of some
// points: all of them, and perhaps others.
SeenPixels pixels_around(const View& view, const PictureTile& tile,
                         std::span<const glm::dvec3> points);

}  // namespace lamina
