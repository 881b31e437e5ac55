// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "slicing/slab_mask.h"
#include "slicing/tile_slabs.h"

namespace lamina {

// Bounds on the rays of a square of pixels: on each axis they run between two straight lines.
class TileBounds {
  public:
    TileBounds() = default;
    // `column`, `row`: the first of edge x edge pixels.
    TileBounds(const TileRays& rays, const TileBrickView& brick, int column, int row, int edge);

    // Calls found(first, end) for runs of slabs among first .. end - 1, nearest first. In slabs
    // outside these runs no ray comes near an occupied brick.
    template <class Found>
    void for_each_shown(const OccupiedBricks& bricks, const TileRays& rays, int first, int end,
                        const Found& found) const {
        while (first < end) {
            const Stretch stretch = next_stretch(bricks, rays, first, end);
            if (stretch.shown) found(first, stretch.end);
            first = stretch.end;
        }
    }

    // Returns the point of the middle ray at a depth, in the volume's index space.
    glm::dvec3 middle_at(double depth) const { return middle_ + depth * middle_change_; }

  private:
    struct Stretch {
        int end;  // slab
        bool shown;
    };
    Stretch next_stretch(const OccupiedBricks& bricks, const TileRays& rays, int first,
                         int end) const;
    bool shows(const OccupiedBricks& bricks, const TileRays& rays, int first, int end) const;

    // The middle ray in the volume's index space, as a linear function of depth from the nearest
    // slab's front on.
    glm::dvec3 middle_{0}, middle_change_{0};
    // Largest distance from the middle ray, including the error of points.
    glm::dvec3 reach_{0}, reach_change_{0};
};

}  // namespace lamina
