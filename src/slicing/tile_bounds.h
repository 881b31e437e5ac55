// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "compositing/tree_shape.h"
#include "slicing/tile_slabs.h"

namespace lamina {

// Where the rays of a square of pixels run, by those of its corners.
class TileBounds {
  public:
    // `column`, `row`: of the first of edge x edge pixels.
    TileBounds(const TileRays& rays, const TileBrickView& brick, int column, int row, int edge);

    // Slabs first .. end - 1 without those, at either end, in which no ray comes near an occupied
    // brick. slabs.occupied must be set.
    SampleSpan shown(const TileSlabs& slabs, int first, int end) const;

  private:
    struct Box {
        glm::dvec3 min, max;
    };
    // At each depth, points are linear in column and row: all lie between the corners'.
    Box box_at(double depth) const;
    bool shows(const TileSlabs& slabs, int first, int end) const;

    std::array<std::array<double, 4>, 3> origin_{}, direction_{};  // index space of the volume
    double margin_;                                                // of points in float, in voxels
};

}  // namespace lamina
