// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "panels/panel.h"

namespace lamina::view {

// Edits the bifurcation factors of the compositing tree, as text, and lists the errors and times of
// those tried with these settings in this view.
class FactorsPanel : public Panel {
  public:
    const char* title() const override { return "Bifurcation factors"; }
    void draw(PanelContext& context) override;

  private:
    void take(Document& document);
    void draw_tried(PanelContext& context);

    std::string text_, shown_;  // as edited, and as the scene has it
    std::string message_;       // of factors that make no sense
};

}  // namespace lamina::view
