// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

namespace lamina {

// `count`: 1 or more.
inline bool all_zero(const void* bytes, std::size_t count) {
    const auto* const first = static_cast<const char*>(bytes);
    return *first == 0 && std::memcmp(first, first + 1, count - 1) == 0;
}

}  // namespace lamina
