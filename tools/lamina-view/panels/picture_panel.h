// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// What the picture is: its size, who drew it, its error, and what is noteworthy.
class PicturePanel : public Panel {
  public:
    const char* title() const override { return "Picture"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
