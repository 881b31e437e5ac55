// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace lamina {

// A file of the source tree that the build embeds into the program (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
    std::string_view name;  // relative to the embedded folder: "slicing/slab.frag"
    std::string_view text;
};

}  // namespace lamina
