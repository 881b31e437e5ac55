// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// A graph of what the last pictures took, by stages.
class FramesPanel : public Panel {
  public:
    const char* title() const override { return "Frame times"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
