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

#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/value_type.h"
#include "volume/sample_source.h"
#include "volume_files/sample_sources.h"

namespace lamina {

struct ZarrCodec;

// Returns a member of an object, or null if it has none of that name or is no object.
inline const nlohmann::json* member_of(const nlohmann::json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found == object.end() ? nullptr : &*found;
}

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
    // How chunks are packed (the "compressor"); null: they are not.
    const ZarrCodec* codec = nullptr;
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

// Hashes of the chunks of an array that lamina wrote, in the order of ZarrChunks, so that a damaged
// or lost chunk is never drawn.
inline constexpr std::uint64_t no_chunk = 0;  // hash for a chunk of zeros, which has no file

std::uint64_t hash_of_chunk(std::span<const char> stored);

// Writes the hashes into the array's folder, with one of .zarray and .zattrs, which must be there.
// Throws Error.
void write_chunk_hashes(const std::filesystem::path& folder,
                        const std::vector<std::uint64_t>& hashes);

// Returns nothing if there is no such file, if it is damaged or of another number of chunks, or if
// .zarray or .zattrs are not those that were written.
std::optional<std::vector<std::uint64_t>> read_chunk_hashes(const std::filesystem::path& folder,
                                                            std::int64_t count);

inline constexpr std::int64_t most_chunks = 1'000'000;

// The chunks of an array that hold its selected samples. Safe from any thread.
class ZarrChunks {
  public:
    using Triple = std::array<std::int64_t, 3>;  // along z, y, x

    // Throws Error if the files cannot hold what is selected.
    ZarrChunks(ZarrArray array, ZarrSelection selection);

    const ZarrArray& array() const { return array_; }
    const Triple& size() const { return size_; }  // samples that are selected
    const Triple& edge() const { return edge_; }  // a chunk's
    std::int64_t count() const { return counts_[0] * counts_[1] * counts_[2]; }
    std::size_t selected_bytes() const;
    std::size_t chunk_bytes() const {
        return static_cast<std::size_t>(array_.chunk_samples()) * bytes_;
    }

    // Returns a hash of the size and time that a chunk's file had at first; 0 if there is no file,
    // and the fill value counts.
    std::uint64_t state(std::int64_t chunk) const {
        return states_[static_cast<std::size_t>(chunk)];
    }
    // Returns a hash that tells all files from copies of them with the same sizes and times.
    std::uint64_t files() const { return files_.word(); }
    std::int64_t missing() const;
    // Takes the hashes of all chunks, which decoded() then expects. Throws Error if a chunk is
    // missing.
    void expect(std::vector<std::uint64_t> hashes);
    // Throws Error if the files cannot hold all that is selected, missing chunks included.
    void expect_all() const;
    std::string selection_text() const;  // tells what is selected from what else might be

    // Returns a chunk's samples, decoded, in the byte order of the file. Throws Error if it is
    // damaged, has another hash, or is not the one that was there at first.
    ByteBuffer decoded(std::int64_t chunk) const;
    // Copies the part of a decoded chunk that lies in a box of the selected samples to that box, at
    // `to`, x fastest.
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

// Samples in the chunks of a Zarr array.
class ZarrSource : public ChunkedSource {
  public:
    explicit ZarrSource(ZarrChunks chunks);

    void check_unchanged() const override { header_.check_unchanged(); }
    std::filesystem::path main_file() const override { return chunks_.array().folder; }
    std::string name() const override;
    std::string identity() const override;

  private:
    void decode(std::int64_t chunk, const SampleBox& box, void* to) const override;
    bool is_zero(std::int64_t chunk) const override;

    ZarrChunks chunks_;
    FileState header_;
};

}  // namespace lamina
