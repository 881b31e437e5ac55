// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/document.h"

namespace lamina::view {

// Menus that cut data away by the words of the command line, "x>10" and "x0:x1,y0:y1,z0:z1"
// (docs/first-picture.md). Each takes the place of what it has cut before.
class ClipMenus {
  public:
    // Draws what is inside of a menu. `bounds`: of the data, in the world.
    void draw_clip(Document& document, const Grid::Bounds& bounds);
    void draw_crop(Document& document, const Grid::Bounds& bounds);

  private:
    void follow(const Document& document, const Grid::Bounds& bounds);

    Grid::Bounds bounds_, crop_;  // of the data, and the box as edited
    glm::dvec3 place_{0};         // of planes across the axes
    bool editing_ = false;        // a slider of the box is being moved
};

}  // namespace lamina::view
