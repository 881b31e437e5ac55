// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace lamina
