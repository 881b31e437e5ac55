// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "base/input_file.h"

namespace lamina {

// An encoded array of a VTK XML file, from its beginning to the end of what may belong to it.
struct VtuSource {
    std::string_view text;                   // in base64
    const RandomAccessFile* file = nullptr;  // or what this one has from `begin` to `end`
    std::uint64_t begin = 0, end = 0;
    bool base64 = true;

    std::uint64_t left() const { return file != nullptr ? end - begin : text.size(); }
    void skip(std::uint64_t count) {
        if (file != nullptr)
            begin += count;
        else
            text.remove_prefix(count);
    }
};

}  // namespace lamina
