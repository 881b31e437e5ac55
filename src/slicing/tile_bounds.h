// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "slicing/slab_mask.h"
#include "slicing/tile_slabs.h"

namespace lamina {

// Where the rays of a square of pixels run: between two straight lines on each axis.
class TileBounds {
  public:
    TileBounds() = default;
    // `column`, `row`: of the first of edge x edge pixels.
    TileBounds(const TileRays& rays, const TileBrickView& brick, int column, int row, int edge);

    // Calls found(first, end) for runs of slabs among first .. end - 1, nearest first: in no other
    // does a ray come near an occupied one of the bricks.
    template <class Found>
    void for_each_shown(const OccupiedBricks& bricks, const TileRays& rays, int first, int end,
                        const Found& found) const {
        while (first < end) {
            const Stretch stretch = next_stretch(bricks, rays, first, end);
            if (stretch.shown) found(first, stretch.end);
            first = stretch.end;
        }
    }

    // Of the ray in the middle, in the volume.
    glm::dvec3 middle_at(double depth) const { return middle_ + depth * middle_change_; }

  private:
    struct Stretch {
        int end;  // slab
        bool shown;
    };
    Stretch next_stretch(const OccupiedBricks& bricks, const TileRays& rays, int first,
                         int end) const;
    bool shows(const OccupiedBricks& bricks, const TileRays& rays, int first, int end) const;

    // Index space of the volume, by depth from the nearest slab's front on.
    glm::dvec3 middle_{0}, middle_change_{0};
    glm::dvec3 reach_{0}, reach_change_{0};  // from the middle, with what points may be wrong by
};

}  // namespace lamina
