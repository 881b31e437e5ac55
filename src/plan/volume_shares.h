// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

struct ShareCosts;

// A volume cut into boxes, for renderers that draw one picture together, each its own box. A box is
// cut in two by a plane through samples, again and again.
class VolumeShares {
  public:
    // Cuts the volume so that each of `count` renderers takes about as long as the others for the
    // scene's view, as far as the ranges of bricks tell. `in_files`: reading counts, too.
    VolumeShares(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks, bool in_files,
                 int count);

    // Returns the boxes in the volume's index space, endless if they reach the volume's border.
    // Boxes are empty if there were too few samples to cut between.
    const std::vector<IndexBox>& boxes() const { return boxes_; }

    // Returns the numbers of the boxes, sorted so that along every ray of a view nearer ones come
    // first.
    std::vector<int> front_to_back(const Grid& grid, const View& view) const;

  private:
    struct Cut {
        int axis = 0;
        double place = 0;
    };

    // `costs`: inside `box`; `between`: its first and last sample on each axis.
    void divide(const ShareCosts& costs, const IndexBox& box, const IndexBox& between, int count);
    static Cut best_cut(const ShareCosts& costs, const IndexBox& between, int count);

    // Order: a cut, those below it, those above it. Boxes come in this order, too.
    std::vector<Cut> cuts_;
    std::vector<IndexBox> boxes_;
};

}  // namespace lamina
