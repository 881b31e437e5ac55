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
    StoredAxis(std::int64_t a_size = 1, std::optional<std::int64_t> a_taken = {},
               const char* its_name = "", bool is_told = false)
        : size(a_size), taken(a_taken), what(its_name), told(is_told) {}

    std::int64_t size;
    std::optional<std::int64_t> taken;  // the one that is wanted; all where empty
    const char* what;                   // "channel" or "time", where one is taken
    bool told;                          // by the request, which one
};

// An axis of `count` things, such as channels, of which one is taken: the wanted one, else the
// first. `what`: "channel" or "time", as the request's key is called. Throws Error where the wanted
// one is none of them.
StoredAxis taken_axis(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count);

// Warns of every axis of which the first was taken untold.
void say_taken(const std::string& file, std::span<const StoredAxis> axes);

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

// The same of an array in memory.
void take_of_memory(const char* from, std::span<const StoredAxis> axes, std::size_t value_bytes,
                    char* to);

// Both at once: which one is taken.
std::int64_t taken_of(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count);

}  // namespace lamina
