// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace lamina {

// `text` as a message shows it: cut where it has more than `most` bytes, between two characters.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
    if (text.size() <= most) return text;
    const auto continues = [&](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;  // of a character in UTF-8
    };
    std::size_t end = most - 3;
    while (end > most - 6 && continues(end)) --end;
    return text.substr(0, end) + "...";
}

}  // namespace lamina
