// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "panels/panel.h"

namespace lamina::view {

// Shows the picture's size, who drew it, its error, and its warnings.
class PicturePanel : public Panel {
  public:
    const char* title() const override { return "Picture"; }
    void draw(PanelContext& context) override;
};

// Shows what runs for the picture, what is left out and why, the predicted error, and why the last
// change has no picture.
class PlanPanel : public Panel {
  public:
    const char* title() const override { return "Plan"; }
    void draw(PanelContext& context) override;
};

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

// A graph of the times of the last pictures, by stages.
class FramesPanel : public Panel {
  public:
    const char* title() const override { return "Frame times"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
