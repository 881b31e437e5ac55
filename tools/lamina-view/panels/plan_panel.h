// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// What runs for the picture, what is left out and why, the error that was predicted, and why the
// last change has no picture.
class PlanPanel : public Panel {
  public:
    const char* title() const override { return "Plan"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
