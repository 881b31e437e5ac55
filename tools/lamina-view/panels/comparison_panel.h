// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// Chooses the picture to compare with, and how both pictures are shown.
class ComparisonPanel : public Panel {
  public:
    const char* title() const override { return "Compare"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
