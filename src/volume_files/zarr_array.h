// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/value_type.h"
#include "volume_files/zarr_codec.h"

namespace lamina {

// What the .zarray of a Zarr v2 array says.
struct ZarrArray {
    std::filesystem::path folder;
    std::vector<std::int64_t> shape, chunks;  // of each axis, 1 or more; the last changes fastest
    ValueType type = ValueType::uint8;
    bool swap = false;     // the other byte order than this machine's
    bool fortran = false;  // in a chunk the first axis changes fastest
    double fill = 0;
    ZarrCodec codec = ZarrCodec::none;
    char separator = '.';  // between the numbers of a chunk

    std::int64_t chunk_count(std::size_t axis) const {
        return (shape[axis] + chunks[axis] - 1) / chunks[axis];
    }
    std::int64_t chunk_samples() const;
};

// Throws Error where the file is not that of an array, or of one that cannot be read.
ZarrArray read_zarray(const std::filesystem::path& folder);

// What is taken of an array: three of its axes for z, y and x (-1: the axis is not there, and has
// one sample), and an index of each other one.
struct ZarrSelection {
    std::array<int, 3> axes{-1, -1, -1};  // of z, y, x
    std::vector<std::int64_t> index;      // of each axis of the array; those of `axes` do not count
};

}  // namespace lamina
