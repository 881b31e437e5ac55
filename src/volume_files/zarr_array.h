// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json_text.h"
#include "base/value_type.h"

namespace lamina {

// How the chunks of a Zarr array are compressed (the "compressor" of its .zarray).
enum class ZarrCodec { none, zlib, gzip, zstd, lz4, blosc };

// Returns the codec by its id; an empty id is none. Throws Error for others. `name`: for messages.
ZarrCodec zarr_codec(const std::string& id, const std::string& name);

// Most bytes that a stored byte gives, whatever the codec: zstd repeats a byte 2^17 times in four
// bytes.
inline constexpr std::size_t most_chunk_expansion = 1 << 16;

// Decodes a chunk that has exactly chunk.size() bytes. Throws Error if it is damaged, or has
// another number of bytes. `name`: the chunk's file, for messages.
void decode_chunk(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk,
                  const std::string& name);

// Returns a value as messages show it: one short line.
inline std::string json_excerpt(const nlohmann::json& value) {
    return one_line(json_text(value).substr(0, 100));
}

// The contents of the .zarray of a Zarr v2 array.
struct ZarrArray {
    std::filesystem::path folder;
    std::vector<std::int64_t> shape, chunks;  // along each axis, 1 or more; the last is the fastest
    ValueType type = ValueType::uint8;
    bool swap = false;     // the other byte order than this machine's
    bool fortran = false;  // the first axis is the fastest in a chunk
    double fill = 0;
    ZarrCodec codec = ZarrCodec::none;
    char separator = '.';  // between the numbers of a chunk

    std::int64_t chunk_count(std::size_t axis) const {
        return (shape[axis] + chunks[axis] - 1) / chunks[axis];
    }
    std::int64_t chunk_samples() const;
};

// Throws Error if the file is not that of an array, or of one that cannot be read.
ZarrArray read_zarray(const std::filesystem::path& folder);

// The part that is taken of an array: three of its axes for z, y and x (-1: the axis is not there,
// and has one sample), and an index on each other one.
struct ZarrSelection {
    std::array<int, 3> axes{-1, -1, -1};  // for z, y, x
    std::vector<std::int64_t> index;      // on each axis of the array; those in `axes` do not count
};

}  // namespace lamina
