// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/value_type.h"

namespace lamina {

// Writes a Zarr v2 array of the axes z, y, x in chunks that Blosc packs (lz4). Chunks of zeros are
// not written: the fill value is 0.
class ZarrWriter {
  public:
    // `folder`: is there, and empty. `size`, `edge`: of the array and of a chunk, samples along x,
    // y and z. Throws Error.
    ZarrWriter(std::filesystem::path folder, const std::array<std::int64_t, 3>& size,
               const std::array<std::int64_t, 3>& edge, ValueType type,
               const nlohmann::json& attributes);

    // The slices of one layer of chunks, the next one each time, in native byte order. Throws
    // Error.
    void write_layer(const void* samples);
    // Writes the hashes of all chunks, after the last layer. Throws Error.
    void finish() const;

    std::int64_t layer_count() const { return counts_[2]; }
    // Slices of a layer: the last one may have fewer than a chunk.
    std::int64_t slices_of(std::int64_t layer) const;
    std::int64_t chunk_count() const { return counts_[0] * counts_[1] * counts_[2]; }
    std::uint64_t bytes_written() const { return bytes_written_; }

  private:
    std::uint64_t write_chunk(std::int64_t x, std::int64_t y, const char* layer);

    std::filesystem::path folder_;
    std::array<std::int64_t, 3> size_, edge_, counts_{};
    std::size_t bytes_;  // of a sample
    std::int64_t next_ = 0;
    std::uint64_t bytes_written_ = 0;
    std::vector<std::uint64_t> hashes_;  // of chunks (volume_files/chunk_hashes.h)
};

}  // namespace lamina
