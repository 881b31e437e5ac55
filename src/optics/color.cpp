// SPDX-License-Identifier: Apache-2.0
#include "lamina/color.h"

#include <glm/common.hpp>

#include <cctype>
#include <cstddef>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "image/srgb.h"
#include "optics/color_space.h"
#include "optics/css_colors.h"

namespace lamina {
namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

glm::dvec3 display_of_code(std::uint32_t rgb) {
    return glm::dvec3(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255) / 255.0;
}

std::optional<std::uint32_t> code_of_hex(const std::string& text) {
    constexpr const char* digits = "0123456789abcdef";
    if (text.size() != 7 || text.find_first_not_of(digits, 1) != std::string::npos) return {};
    return static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16));
}

}  // namespace

glm::dvec3 color_of_display(const glm::dvec3& display, ImageColorSpace space) {
    return space == ImageColorSpace::display ? display : linear_from_srgb(display);
}

glm::dvec3 display_of_color(const glm::dvec3& color, ImageColorSpace space) {
    glm::dvec3 display = glm::clamp(color, 0.0, 1.0);
    if (space == ImageColorSpace::linear) {
        for (int c = 0; c < 3; ++c) display[c] = srgb_from_linear(display[c]);
    }
    return display;
}

glm::dvec3 color_of(const std::string& text, ImageColorSpace space) {
    const std::string word = lower(text);
    const bool hex = word.starts_with('#');
    if (const auto code = hex ? code_of_hex(word) : css_color(word))
        return color_of_display(display_of_code(*code), space);
    if (hex)
        fail("found \"{}\", expected # and six hexadecimal digits, as in \"#ff8019\"",
             shortened(text));
    std::set<std::string> names;
    for (const CssColor& color : css_colors()) names.emplace(color.name);
    const std::string near = suggestion(names, word);
    fail("found \"{}\"{}", shortened(text),
         near.starts_with(", did") ? near
                                   : ", expected \"#rrggbb\" or the name of a CSS colour, as in "
                                     "\"tomato\"");
}

}  // namespace lamina
