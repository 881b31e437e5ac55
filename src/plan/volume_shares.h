// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

struct ShareCosts;

// A volume cut into boxes, one for each of the renderers that draw one picture together. The
// volume, and then each box, is cut in two by a plane through samples, until there are enough
// boxes.
class VolumeShares {
  public:
    // Cuts the volume so that each of `count` renderers takes about as long as the others for the
    // scene's view, as far as the ranges of bricks tell. `in_files`: reading counts, too.
    VolumeShares(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks, bool in_files,
                 int count);

    // Returns the boxes in the volume's index space; a box that reaches the volume's border is
    // endless on that side. Boxes are empty if there were too few samples to cut between.
    const std::vector<IndexBox>& boxes() const { return boxes_; }

    // Returns the boxes' numbers, sorted so that nearer ones come first along every ray of a view.
    std::vector<int> front_to_back(const Grid& grid, const View& view) const;

  private:
    // A plane across an axis, in index space.
    struct Cut {
        int axis = 0;
        double place = 0;
    };

    // Cuts `box`, which costs `costs`, into `count` boxes. `between`: its first and last samples.
    void divide(const ShareCosts& costs, const IndexBox& box, const IndexBox& between, int count);
    // Returns the cut of a box that is to become `count` boxes.
    static Cut best_cut(const ShareCosts& costs, const IndexBox& between, int count);

    // Preorder of the tree of cuts: a cut, the cuts of the box below it, those of the box above it.
    std::vector<Cut> cuts_;
    std::vector<IndexBox> boxes_;
};

}  // namespace lamina
