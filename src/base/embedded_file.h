// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace lamina {

// A file of the source tree that the build put into the program (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
    std::string_view name;  // relative to the folder that was embedded: "slicing/slab.frag"
    std::string_view text;
};

}  // namespace lamina
