// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "panels/panel.h"

namespace lamina::view {

// Shows the predicted error of the picture, the error that the tracer has measured so far, and the
// largest error wanted.
class ErrorPanel : public Panel {
  public:
    const char* title() const override { return "Error"; }
    void draw(PanelContext& context) override;

  private:
    void draw_wanted(Document& document);

    std::optional<float> wanted_;  // while the slider is dragged
};

}  // namespace lamina::view
