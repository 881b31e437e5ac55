// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "panels/panel.h"

namespace lamina::view {

// Shows the picture's size, who drew it, its error, and its warnings.
class PicturePanel : public Panel {
  public:
    const char* title() const override { return "Picture"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
