// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <string>

namespace lamina::view {

// Sets colours, spacing and font of the interface, before the first frame. `scale`: 1, or more if
// the screen has finer pixels than usual.
void set_theme(float scale);

// Returns a length in pixels. `lengths`: in heights of the font.
float em(float lengths);

// Writes a text at the cursor, wrapped at the end of the line.
void wrapped(const ImVec4& color, const std::string& text);

namespace theme {
inline constexpr ImU32 plot_back = IM_COL32(22, 23, 25, 255);
inline constexpr ImU32 plot_frame = IM_COL32(60, 63, 68, 255);
inline constexpr ImU32 grid = IM_COL32(255, 255, 255, 16);
inline constexpr ImU32 histogram = IM_COL32(96, 106, 122, 120);
inline constexpr ImU32 label = IM_COL32(158, 164, 172, 255);
inline constexpr ImU32 curve = IM_COL32(232, 234, 238, 255);
inline constexpr ImU32 handle = IM_COL32(240, 242, 246, 255);
inline constexpr ImU32 selected = IM_COL32(255, 176, 60, 255);
inline constexpr ImU32 marker = IM_COL32(110, 200, 255, 220);
inline const ImVec4 dim{.58f, .6f, .64f, 1};
inline const ImVec4 bad{1, .5f, .44f, 1};
inline const ImVec4 warning{1, .78f, .4f, 1};
}  // namespace theme

}  // namespace lamina::view
