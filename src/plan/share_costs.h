// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

#include "facts/facts.h"
#include "lamina/scene.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// What it costs to draw parts of a volume, estimated on rays all over the view from the ranges of
// bricks alone, in cells that rays walk through. In each part rays end once the part by itself is
// opaque.
class ShareCosts {
  public:
    // `in_files`: what the view shows is also read from files.
    ShareCosts(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks, bool in_files);

    // The costs of the parts below and above a plane across an axis.
    struct Pair {
        double below = 0, above = 0;
    };
    Pair of_parts(int axis, double place) const;

    // The costs inside one of these parts.
    ShareCosts part(int axis, double place, bool above) const;

  private:
    ShareCosts() = default;

    // A stretch of a ray in bricks that show something.
    struct Stretch {
        glm::vec3 middle;     // in index space
        float cells;          // that it walks through
        float optical_depth;  // estimated
        std::int32_t ray;
    };
    void find_stretches(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks);
    void find_pages(const Scene& scene, const Facts& facts);

    std::vector<Stretch> stretches_;  // ray by ray, front to back
    std::vector<glm::vec3> pages_;    // middles of the cache's bricks that are read, in index space
    double opaque_depth_ = 0, page_cost_ = 0;
};

}  // namespace lamina
