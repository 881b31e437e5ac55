// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace lamina {

struct CssColor {
    std::string_view name;
    std::uint32_t rgb;  // 0xrrggbb, sRGB
};

// The named colours of CSS (W3C, "CSS Color Module Level 4", section 6.1), by name.
std::span<const CssColor> css_colors();

// The code of a name in small letters.
std::optional<std::uint32_t> css_color(std::string_view name);

}  // namespace lamina
