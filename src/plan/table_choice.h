// SPDX-License-Identifier: Apache-2.0
// The choice of a slicing plan's pre-integration table.
#pragma once

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "preintegration/table_cache.h"

namespace lamina {

// Share of max_error that a table may add to the picture's error.
inline constexpr double table_share = 0.1;

// Largest optical depth of a segment for which a table of a single layer, the limit of short
// segments, is enough. The front half of a segment of depth D weighs 1/2 + D/12 + O(D^3). So the
// colour of a ray is then off by less than depth / 12 of the colour's change within a segment, at
// most .5 / 255.
inline constexpr double short_depth = 0.02;

// Gets the table that the plan's request asks for, from the cache or built.
void get_table(const Scene& scene, const Facts& facts, TablePlan& table, TableCache& tables);

// Returns the largest error of a ray's colour, in 1/255, that the built table makes on
// Facts::scalar_rays cut into `slabs` segments. Opacity is exact.
double table_error(const Scene& scene, const Facts& facts, int slabs, const TablePlan& table);

// Chooses the scalar nodes and the lengths of a coloured table whose range and max_length are set.
// Among a few sizes it takes the coarsest that keeps the error within table_share of max_error; if
// none does, the one with the least error found. `depth`: the largest optical depth of a segment,
// or 0 if the limit of short segments is enough for all.
void refine_table(const Scene& scene, const Facts& facts, int slabs, double depth, TablePlan& table,
                  TableCache& tables);

// Takes the table that the scene asks for, over the range that is set. If the longest segment of
// this view, of `longest` world units, is longer than that table knows, the table is extended, with
// layers as close, for all views of such a camera. The table is built, and its error measured, if
// there are Facts::scalar_rays.
void take_table(const Scene& scene, const Facts& facts, int slabs, double longest, double unit,
                TablePlan& table, TableCache& tables);

}  // namespace lamina
