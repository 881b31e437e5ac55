// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/content_hash.h"
#include "base/input_file.h"
#include "volume/sample_source.h"
#include "volume_files/zarr_array.h"

namespace lamina {

inline constexpr std::int64_t most_chunks = 1'000'000;

// The chunks of an array that hold what is selected of it. Safe from any thread.
class ZarrChunks {
  public:
    using Triple = std::array<std::int64_t, 3>;  // of z, y, x

    // Throws Error where the files cannot hold what is selected.
    ZarrChunks(ZarrArray array, ZarrSelection selection);

    const ZarrArray& array() const { return array_; }
    const Triple& size() const { return size_; }  // samples that are selected
    const Triple& edge() const { return edge_; }  // of a chunk
    std::int64_t count() const { return counts_[0] * counts_[1] * counts_[2]; }
    std::size_t selected_bytes() const;
    std::size_t chunk_bytes() const {
        return static_cast<std::size_t>(array_.chunk_samples()) * bytes_;
    }

    // Which of the files, as they were at first, a chunk is: a hash of its size and time; 0 where
    // there is none, and the fill value counts.
    std::uint64_t state(std::int64_t chunk) const {
        return states_[static_cast<std::size_t>(chunk)];
    }
    // Tells all files from copies of them that have the same sizes and times.
    std::uint64_t files() const { return files_.word(); }
    std::int64_t missing() const;
    // Takes the hashes of all chunks (volume_files/chunk_hashes.h): decoded() then expects them.
    // Throws Error if a chunk is missing.
    void expect(std::vector<std::uint64_t> hashes);
    // Throws Error where the files cannot hold all that is selected, what is missing included.
    void expect_all() const;
    std::string selection_text() const;  // tells what is selected from what else might be

    // A chunk's samples, decoded, in the byte order of the file. Throws Error where it is damaged,
    // has another hash, or is not the one that was there at first.
    ByteBuffer decoded(std::int64_t chunk) const;
    // Copies what a decoded chunk has of a box of the selected samples, which is at `to`, x
    // fastest.
    void copy(const ByteBuffer& samples, std::int64_t chunk, const SampleBox& box, char* to) const;

  private:
    Triple place_of(std::int64_t chunk) const;
    std::filesystem::path file_of(std::int64_t chunk) const;
    struct FileNow {
        std::uint64_t state = 0, bytes = 0, inode = 0;
        std::int64_t changed = 0;  // nanoseconds
    };
    FileNow file_now(std::int64_t chunk) const;
    std::size_t step_of(std::size_t axis) const;
    void fill(ByteBuffer& samples) const;
    template <typename Value>
    Value fill_as() const;
    void copy_samples(const char* from, std::size_t step, char* to, std::int64_t count) const;

    ZarrArray array_;
    ZarrSelection selection_;
    std::size_t bytes_;  // of a sample
    Triple size_{1, 1, 1}, edge_{1, 1, 1}, counts_{1, 1, 1};
    std::vector<std::uint64_t> states_, hashes_;
    ContentHash files_;
    std::uint64_t stored_ = 0;  // bytes of all files
};

}  // namespace lamina
