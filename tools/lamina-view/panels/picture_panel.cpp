// SPDX-License-Identifier: Apache-2.0
#include "panels/picture_panel.h"

#include <imgui.h>

namespace lamina::view {

void PicturePanel::draw(PanelContext& context) {
    const Shown& shown = context.shown;
    if (!shown.full) return;
    ImGui::Text("%d x %d pixels in %.0f ms", shown.full->width, shown.full->height,
                shown.statistics.draw_ms);
    ImGui::TextWrapped("%s", shown.statistics.drawn_by.c_str());
    for (const std::string& warning : shown.warnings)
        ImGui::TextWrapped("Warning: %s", warning.c_str());
}

}  // namespace lamina::view
