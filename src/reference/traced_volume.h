// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "lamina/volume.h"
#include "mesh/box_corners.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "reference/tiles.h"
#include "reference/transfer_intervals.h"
#include "reference/visible_cells.h"

namespace lamina {

// This holds what all rays of a picture share. `Samples` are as in CellSamples.
template <typename Samples>
struct TracedVolume {
    TracedVolume(const Volume& volume, const Samples& first_sample,
                 const TransferIntervals& intervals, const VisibleCells& visible_cells,
                 const TraceOptions& how)
        : grid(volume.grid()),
          axes(grid),
          samples(grid, first_sample),
          gradients(grid, first_sample),
          transfer(intervals),
          visible(visible_cells),
          options(how) {
        // A share of the diagonal to spare, for axes that are not quite orthogonal (by 1e-5 at
        // most, volume_files/grid_check.cpp), and for rounding.
        const double spare =
            1e-4 * glm::distance(grid.to_world(axes.lowest), grid.to_world(axes.highest));
        glm::dvec3 steps;
        for (int axis = 0; axis < 3; ++axis)
            steps[axis] = spare / glm::length(grid.step[static_cast<std::size_t>(axis)]);
        corners = box_corners(axes.lowest - steps, axes.highest + steps);
        for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    }

    const Grid& grid;
    GridAxes axes;
    std::array<glm::dvec3, 8> corners;  // around the box, in the world
    CellSamples<Samples> samples;
    GradientSamples<Samples> gradients;
    const TransferIntervals& transfer;
    const VisibleCells& visible;  // empty where it is not known
    const TraceOptions& options;
};

}  // namespace lamina
