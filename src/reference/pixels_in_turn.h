// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <utility>

#include "base/interrupt.h"

namespace lamina {

// Called as a row of pixels is done.
using RowDone = std::function<void()>;

// Gives the pixels of a rectangle, row by row. It ends where the user interrupts.
class PixelsInTurn {
  public:
    // From `first` to `last`.
    PixelsInTurn(const glm::ivec2& first, const glm::ivec2& last, RowDone row_done)
        : first_(first), last_(last), next_(first), row_done_(std::move(row_done)) {}

    bool any() const { return next_.x <= last_.x && next_.y <= last_.y; }
    glm::ivec2 take() {
        const glm::ivec2 pixel = next_;
        check_interrupt();
        if (pixel.x == first_.x && pixel.y > first_.y) row_done_();
        next_ = pixel.x < last_.x ? pixel + glm::ivec2(1, 0) : glm::ivec2(first_.x, pixel.y + 1);
        return pixel;
    }

  private:
    glm::ivec2 first_, last_, next_;
    RowDone row_done_;
};

}  // namespace lamina
