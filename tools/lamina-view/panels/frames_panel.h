// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// A graph of the times of the last pictures, by stages.
class FramesPanel : public Panel {
  public:
    const char* title() const override { return "Frame times"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
