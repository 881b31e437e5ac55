// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "panels/panel.h"

namespace lamina::view {

// Shows the picture's size, which engine drew it, and its warnings.
class PicturePanel : public Panel {
  public:
    const char* title() const override { return "Picture"; }
    void draw(PanelContext& context) override;
};

// Shows the plan of the picture: method, omissions with their reasons, predicted error; and why the
// last change could not be drawn.
class PlanPanel : public Panel {
  public:
    const char* title() const override { return "Plan"; }
    void draw(PanelContext& context) override;
};

// Shows the predicted error of the picture, the error measured by the tracer so far, and max_error.
class ErrorPanel : public Panel {
  public:
    const char* title() const override { return "Error"; }
    void draw(PanelContext& context) override;

  private:
    void draw_wanted(Document& document);

    std::optional<float> wanted_;  // set while the slider is dragged
};

// A graph of the times of the last pictures, by stage.
class FramesPanel : public Panel {
  public:
    const char* title() const override { return "Frame times"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
