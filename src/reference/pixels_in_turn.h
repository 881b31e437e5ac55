// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "base/interrupt.h"

namespace lamina {

// Gives the pixels of a rectangle, row by row. It ends where the user interrupts.
class PixelsInTurn {
  public:
    // From `first` to `last`.
    PixelsInTurn(const glm::ivec2& first, const glm::ivec2& last)
        : first_(first), last_(last), next_(first) {}

    bool any() const { return next_.x <= last_.x && next_.y <= last_.y; }
    glm::ivec2 take() {
        const glm::ivec2 pixel = next_;
        if (pixel.x == first_.x) check_interrupt();
        next_ = pixel.x < last_.x ? pixel + glm::ivec2(1, 0) : glm::ivec2(first_.x, pixel.y + 1);
        return pixel;
    }

  private:
    glm::ivec2 first_, last_, next_;
};

}  // namespace lamina
