// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/value_type.h"
#include "volume_files/zarr_store.h"

namespace lamina {

// A codec that turns bytes into bytes: a compression, or a checksum behind them. decode() returns
// false unless it gives exactly decoded.size() bytes.
struct ZarrCodec {
    const char* name;
    bool in_version_2, in_version_3;
    bool (*decode)(std::span<const char> stored, std::span<char> decoded);
    bool is_checksum = false;
};

// Upper bound on the bytes that one byte decodes to: zstd packs 2^17 equal bytes into 4.
inline constexpr std::size_t most_chunk_expansion = 1 << 16;

// Returns the codec of a name in a version of Zarr; null if there is none.
const ZarrCodec* zarr_codec(std::string_view name, int version);

// Decodes a chunk of exactly chunk.size() bytes. `codecs`: in the order in which they encode; at
// most one is a compression. Throws Error. `name`: the chunk's file, for messages.
void decode_chunk(std::span<const ZarrCodec* const> codecs, std::span<const char> stored,
                  std::span<char> chunk, const std::string& name);

// A filter of numcodecs, which turns a chunk into as many other bytes before it is packed: the
// bytes of elements by their number in each, or elements as differences from the one before.
struct ZarrFilter {
    enum class Kind { shuffle, delta } kind;
    std::size_t word;   // bytes of an element
    bool swap = false;  // elements are not in this machine's byte order
    bool are_floats = false;
};

// Undoes filters, which are in the order in which they encode. Ends early if a stop is requested.
void undo_filters(std::span<const ZarrFilter> filters, std::span<char> chunk);

// Chunks that lie together in one file (sharding codec, version 1.0). An index says where each
// begins and how many bytes it has.
struct ZarrShards {
    std::vector<std::size_t> axes;  // of the array, in the index from the slowest to the fastest
    bool index_at_end = true, swap_index = false;
    std::vector<const ZarrCodec*> index_codecs;  // checksums
};

// An array, as .zarray (version 2) or zarr.json (version 3) describes it.
struct ZarrArray {
    ZarrStore store;
    std::filesystem::path folder;
    const char* header = ".zarray";
    // Along each axis, 1 or more. `files`: samples of a file, which has one chunk, or, with shards,
    // a multiple of chunks along each axis.
    std::vector<std::int64_t> shape, chunks, files;
    ValueType type = ValueType::uint8;
    bool is_half = false;             // floats of 16 bits, which become float32
    bool swap = false;                // stored in the other byte order than this machine's
    std::vector<std::size_t> layout;  // axes in a chunk, from the slowest to the fastest
    // The sample, as it lies in memory, of chunks that are not there; nothing if no sample of this
    // type has the value that the file says.
    std::optional<std::array<char, 8>> fill;
    std::string fill_text;
    std::vector<const ZarrCodec*> codecs;  // of a chunk, in the order in which they encode
    std::vector<ZarrFilter> filters;       // of version 2, in that order, too, before the codecs
    std::optional<ZarrShards> shards;
    std::string key_begin;        // before the indices in the name of a file
    char separator = '.';         // between the indices
    nlohmann::json attributes;    // an object
    std::vector<double> missing;  // values of missing samples, unless the attributes name others
    std::vector<std::string> axis_names;  // empty, or one for each axis; axes without one have ""

    std::string header_name() const { return (folder / header).string(); }
    std::size_t stored_bytes() const { return is_half ? 2 : bytes_of(type); }  // of a sample
    std::int64_t chunk_count(std::size_t axis) const {
        return (shape[axis] + chunks[axis] - 1) / chunks[axis];
    }
    std::int64_t chunk_samples() const;
};

// Returns the attributes that .zattrs has in a folder (version 2); an empty object if there are
// none. Throws Error.
nlohmann::json zarr_attributes(const ZarrStore& store, const std::filesystem::path& folder);

// Reads the array in a folder: zarr.json, else .zarray. Throws Error if they are missing or
// invalid, or if lamina cannot read arrays of this kind.
ZarrArray read_zarr_array(const ZarrStore& store, const std::filesystem::path& folder);

// Reads an array of version 2. Throws Error.
ZarrArray read_zarray(const ZarrStore& store, const std::filesystem::path& folder);

// Returns a member of a header. Throws Error, which begins with `name`, the file's, if there is
// none.
const nlohmann::json& zarr_member(const nlohmann::json& object, const char* key,
                                  const std::string& name);

}  // namespace lamina
