// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina::gl {

// Of one context.
struct ContextCounts {
    std::int64_t bytes_allocated = 0;  // of buffers and textures, now
    std::int64_t bytes_uploaded = 0;   // to textures, until now
};

}  // namespace lamina::gl
