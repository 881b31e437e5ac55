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
#include "base/input_file.h"
#include "volume/sample_source.h"
#include "volume_files/packed_values.h"
#include "volume_files/sample_sources.h"
#include "volume_files/zarr_array.h"

namespace lamina {

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

    // Tells if a chunk was there when this was made; if not, all its samples have the fill value.
    bool has(std::int64_t chunk) const { return place(chunk).begin != nowhere; }
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

    // Returns a chunk's samples, decoded, in native byte order. Throws Error if it is damaged, has
    // another hash, or has changed since this was made.
    ByteBuffer decoded(std::int64_t chunk) const;
    // Copies the samples of a decoded chunk that lie in a box to that box at `to`, x fastest.
    void copy(const ByteBuffer& samples, std::int64_t chunk, const SampleBox& box, char* to) const;

  private:
    static constexpr std::uint64_t nowhere = ~std::uint64_t{0};
    // The bytes of a chunk in its file, which had this state; state 0: there is no such file.
    struct Place {
        std::uint64_t state = 0, begin = nowhere, bytes = 0;
    };
    const Place& place(std::int64_t chunk) const {
        return places_[static_cast<std::size_t>(chunk)];
    }
    Triple index_of(std::int64_t chunk) const;
    std::filesystem::path file_of(const Triple& index) const;
    void find_chunks(const Triple& first);
    ByteBuffer read_index(const std::filesystem::path& file, std::uint64_t file_bytes) const;
    std::uint64_t number_in_file(const Triple& index) const;
    std::size_t step_of(std::size_t axis) const;
    void fill(ByteBuffer& samples) const;
    void copy_samples(const char* from, std::size_t step, char* to, std::int64_t count) const;

    ZarrArray array_;
    ZarrSelection selection_;
    std::size_t bytes_;  // of a sample
    Triple size_{1, 1, 1}, edge_{1, 1, 1}, counts_{1, 1, 1};
    Triple each_file_{1, 1, 1};  // chunks of a file
    std::vector<Place> places_;
    std::vector<std::uint64_t> hashes_;
    ContentHash files_;
    std::uint64_t stored_ = 0;  // bytes of all files
};

class ZarrSource : public ChunkedSource {
  public:
    // `values`: missing ones become NaN, if there are any, in the array's type.
    explicit ZarrSource(ZarrChunks chunks, PackedValues values = {});

    void check_unchanged() const override { header_.check_unchanged(); }
    std::filesystem::path main_file() const override {
        return chunks_.array().store.on_disk(chunks_.array().folder);
    }
    std::string name() const override;
    std::string identity() const override;

  private:
    void decode(std::int64_t chunk, const SampleBox& box, void* to) const override;
    bool is_zero(std::int64_t chunk) const override;

    ZarrChunks chunks_;
    PackedValues values_;
    FileState header_;
};

}  // namespace lamina
