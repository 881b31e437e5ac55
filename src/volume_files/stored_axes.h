// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "volume_files/byte_reader.h"

namespace lamina {

// An axis of an array in a file.
struct StoredAxis {
    std::int64_t size = 1;
    std::optional<std::int64_t> taken;  // the one that is wanted; all where empty
};

// Number of bytes of an array, or of what is taken of it. Throws Error where no file holds as much.
// `file`: for messages.
std::size_t stored_bytes(const std::string& file, std::span<const StoredAxis> axes,
                         std::size_t value_bytes);
std::size_t taken_bytes(const std::string& file, std::span<const StoredAxis> axes,
                        std::size_t value_bytes);

// Reads what is taken of an array, the fastest axis first in `axes` and in the file; the order of
// the other axes stays. `to` has room for taken_bytes(). It uses all of the array's bytes.
void read_taken(ByteReader& reader, std::span<const StoredAxis> axes, std::size_t value_bytes,
                void* to);

// Which of `count` things, such as channels, is taken: the wanted one, else the first, and then a
// warning says so. `what`: "channel" or "time", as the key is called. Throws Error where the wanted
// one is none of them.
std::int64_t taken_of(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count);

}  // namespace lamina
