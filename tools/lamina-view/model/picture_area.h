// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace lamina::view {

// Rectangle of the picture in the window, in units of the pointer, from the upper left corner.
struct PictureArea {
    glm::dvec2 corner{0};
    glm::dvec2 size{1};
    int columns = 1;  // pixels of the picture across

    bool contains(const glm::dvec2& place) const {
        const glm::dvec2 inside = place - corner;
        return inside.x >= 0 && inside.y >= 0 && inside.x < size.x && inside.y < size.y;
    }
    // Returns the pixel at a place; a pixel's centre has whole numbers.
    glm::dvec2 pixel(const glm::dvec2& place) const {
        return (place - corner) * (columns / size.x) - glm::dvec2(.5);
    }
    // Returns a place in shares of the height from the middle, to the right and up.
    glm::dvec2 share(const glm::dvec2& place) const {
        const glm::dvec2 from_middle = place - corner - .5 * size;
        return {from_middle.x / size.y, -from_middle.y / size.y};
    }
    double aspect() const { return size.x / size.y; }
};

}  // namespace lamina::view
