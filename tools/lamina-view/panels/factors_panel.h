// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "panels/panel.h"

namespace lamina::view {

// Edits the bifurcation factors of the compositing tree as text. Lists the errors and times of
// factors that were tried with the other settings and the view as they are now.
class FactorsPanel : public Panel {
  public:
    const char* title() const override { return "Bifurcation factors"; }
    void draw(PanelContext& context) override;

  private:
    void take(Document& document);
    void draw_tried(PanelContext& context);

    std::string text_, shown_;  // as edited, and as in the scene
    std::string message_;       // why the last factors were refused
};

}  // namespace lamina::view
