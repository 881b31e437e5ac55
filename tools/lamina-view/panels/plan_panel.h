// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// Shows what runs for the picture, what is left out and why, the predicted error, and why the last
// change has no picture.
class PlanPanel : public Panel {
  public:
    const char* title() const override { return "Plan"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
