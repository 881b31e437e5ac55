// SPDX-License-Identifier: Apache-2.0
#pragma once

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

// Finds the pixels of a tile that may see something.
class TileSight {
  public:
    TileSight(const View& view, const PictureTile& tile);

    // The pixels whose lines, which go on behind the eye, may meet the convex hull of some points:
    // all of them, and perhaps others.
    SeenPixels around(std::span<const glm::dvec3> points) const;

  private:
    const View& view_;
    glm::ivec2 size_;
    glm::dvec2 middle_;  // of the picture, in pixels from the middle of the tile's first
    double error_;       // of places, as a share of distances
    double eye_norm_;
};

}  // namespace lamina
