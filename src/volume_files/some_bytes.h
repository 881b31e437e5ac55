// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/client.h"
#include "base/content_hash.h"

namespace lamina {

// Adds bytes from all over `all` bytes to a hash that is to notice other contents, without reading
// all of them. read(place, to, count) gives so many bytes from a place on.
template <typename Read>
void add_some_bytes(ContentHash& hash, std::uint64_t all, const Read& read) {
    constexpr std::uint64_t places = 64, bytes_each = 4096;
    char bytes[bytes_each];
    for (std::uint64_t i = 0; i < places; ++i) {
        check_interrupt();
        const std::uint64_t place = all / places * i;
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes_each, all - place));
        read(place, bytes, count);
        hash.add(bytes, count);
    }
}

}  // namespace lamina
