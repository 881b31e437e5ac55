// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace lamina {

// `text` for a message: where it has more than `most` bytes, it is cut between two characters.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
    if (text.size() <= most) return text;
    const auto continues = [&](std::size_t at) {
        // A continuation byte of UTF-8.
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
    };
    std::size_t end = most - 3;
    while (end > most - 6 && continues(end)) --end;
    return text.substr(0, end) + "...";
}

}  // namespace lamina
