// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lamina {

// `count`: 1 or more.
inline bool all_equal(const void* bytes, std::size_t count, std::uint8_t value) {
    const auto* const first = static_cast<const std::uint8_t*>(bytes);
    return *first == value && std::memcmp(first, first + 1, count - 1) == 0;
}

inline bool all_zero(const void* bytes, std::size_t count) {
    return all_equal(bytes, count, 0);
}

}  // namespace lamina
