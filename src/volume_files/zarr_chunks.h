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
    bool swap = false;     // not in this machine's byte order
    bool fortran = false;  // the first axis is the fastest in a chunk
    double fill = 0;
    // Compression of the chunks (the "compressor"); null: none.
    const ZarrCodec* codec = nullptr;
    char separator = '.';  // between the indices in a chunk's file name

    std::int64_t chunk_count(std::size_t axis) const {
        return (shape[axis] + chunks[axis] - 1) / chunks[axis];
    }
    std::int64_t chunk_samples() const;
};

// Reads a folder's .zarray. Throws Error if the file is missing or invalid, or if lamina cannot
// read arrays of this kind.
ZarrArray read_zarray(const std::filesystem::path& folder);

// Selects a volume from an array: says which of its axes are z, y and x (-1: the array has no such
// axis, and the volume has one sample there), and gives one index on each other axis.
struct ZarrSelection {
    std::array<int, 3> axes{-1, -1, -1};  // for z, y, x
    std::vector<std::int64_t> index;      // on each axis of the array; those in `axes` do not count
};

// An array that lamina wrote has a file with the hashes of its chunks, in the order of ZarrChunks,
// so that a damaged or lost chunk is never drawn. no_chunk is the hash of a chunk without a file:
// all its samples have the fill value, which is 0 in these arrays.
inline constexpr std::uint64_t no_chunk = 0;

std::uint64_t hash_of_chunk(std::span<const char> stored);

// Writes the hashes, with one of .zarray and .zattrs, into the array's folder. Throws Error.
void write_chunk_hashes(const std::filesystem::path& folder,
                        const std::vector<std::uint64_t>& hashes);

// Reads the hashes. Returns nothing if there is no such file, if it is damaged or of another number
// of chunks, or if .zarray or .zattrs have changed since it was written.
std::optional<std::vector<std::uint64_t>> read_chunk_hashes(const std::filesystem::path& folder,
                                                            std::int64_t count);

inline constexpr std::int64_t most_chunks = 1'000'000;

// The chunks of an array that hold its selected samples. Safe from any thread.
class ZarrChunks {
  public:
    using Triple = std::array<std::int64_t, 3>;  // along z, y, x

    // Throws Error if there are more than most_chunks chunks, or if none has a file.
    ZarrChunks(ZarrArray array, ZarrSelection selection);

    const ZarrArray& array() const { return array_; }
    const Triple& size() const { return size_; }  // samples that are selected
    const Triple& edge() const { return edge_; }  // of a chunk
    std::int64_t count() const { return counts_[0] * counts_[1] * counts_[2]; }
    std::size_t selected_bytes() const;
    std::size_t chunk_bytes() const {
        return static_cast<std::size_t>(array_.chunk_samples()) * bytes_;
    }

    // Returns a hash of the size and time that a chunk's file had when this was made; 0 if it had
    // none, so that all its samples have the fill value.
    std::uint64_t state(std::int64_t chunk) const {
        return states_[static_cast<std::size_t>(chunk)];
    }
    // Returns a hash of the state of all chunk files. Copies of the files give another hash, even
    // with equal sizes and times.
    std::uint64_t files() const { return files_.word(); }
    std::int64_t missing() const;
    // Sets the hashes that decoded() expects, one for each chunk. Throws Error if a chunk with a
    // hash has no file.
    void set_expected_hashes(std::vector<std::uint64_t> hashes);
    // Throws Error if the files are so small that no compression could hold all selected samples.
    void check_plausible_size() const;
    std::string selection_text() const;  // identifies what is selected

    // Returns a chunk's samples, decoded, in the byte order of the file. Throws Error if it is
    // damaged, has another hash, or has changed since this was made.
    ByteBuffer decoded(std::int64_t chunk) const;
    // Copies the samples of a decoded chunk that lie in a box to that box at `to`, x fastest.
    void copy(const ByteBuffer& samples, std::int64_t chunk, const SampleBox& box, char* to) const;

  private:
    Triple place_of(std::int64_t chunk) const;
    std::filesystem::path file_of(std::int64_t chunk) const;
    // The present state of a chunk's file; all 0 if there is none. `state`: as state() returns it.
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
