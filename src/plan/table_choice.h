// SPDX-License-Identifier: Apache-2.0
// How fine a slicing plan's pre-integration table is.
#pragma once

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/table_plan.h"

namespace lamina {

// A table may add this share of max_error to the picture's error.
inline constexpr double table_share = 0.1;

// A table that knows only the limit of short segments has at most this optical depth in one
// segment: then the colour of a ray is off by less than depth / 12 of the colour's change within a
// segment, that is .5 / 255 (the front half of a segment of depth D weighs 1/2 + D/12 + O(D^3)).
inline constexpr double short_depth = 0.02;

// In 1/255: the largest error of a ray's colour that the table makes on Facts::scalar_rays, cut
// into `slabs` segments. Opacity is exact.
double table_error(const Scene& scene, const Facts& facts, int slabs, const TablePlan& table);

// Chooses the scalar nodes and the lengths of a coloured table whose max_length is set: the
// coarsest of a few with which it keeps table_share of max_error, else those of the least error
// that was found. `depth`: the largest optical depth of a segment; 0: the limit of short segments
// serves all.
void refine_table(const Scene& scene, const Facts& facts, int slabs, double depth,
                  TablePlan& table);

// The table as the scene asks; where segments of this view, the longest of which has `longest`
// world units, are longer than that table knows, one that serves all views of such a camera, with
// layers as close. Its error is found where Facts::scalar_rays are.
void take_table(const Scene& scene, const Facts& facts, int slabs, double longest, double unit,
                TablePlan& table);

}  // namespace lamina
