// SPDX-License-Identifier: Apache-2.0
#pragma once

// Lines that show the world's axes: the triad, and the box around the data.

#include <functional>

#include "annotation/layout.h"

namespace lamina {

// Makes a block: arrows along the world's axes, as seen from the camera without perspective. Those
// of a patient's axes have the letters of the directions in which they grow.
Block axes_triad(Pen& pen, const Annotation& wanted, const Scene& scene, const AnnotatedData& data);

// Draws the edges of the data's box over the picture, those at its back dimmer, and numbers at the
// ends of three outer edges: coordinates, or lengths if the box does not lie along the world's
// axes. Volume and box do not hide each other. `make_room` makes texts in these rectangles
// readable, or returns false if something else is there. Warns of edges without numbers.
void draw_box(Pen& pen, const Annotation& wanted, const Scene& scene, const AnnotatedData& data,
              const std::function<bool(const std::vector<Rectangle>&)>& make_room);

}  // namespace lamina
