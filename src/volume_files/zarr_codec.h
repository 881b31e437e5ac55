// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lamina {

// How the chunks of a Zarr array are compressed (the "compressor" of its .zarray).
enum class ZarrCodec { none, zlib, gzip, zstd, lz4, blosc };

// By its id; an empty id is none. Throws Error for others. `name`: for messages.
ZarrCodec zarr_codec(const std::string& id, const std::string& name);

// A stored byte stands for at most so many bytes, whatever the codec (zstd repeats a byte 2^17
// times in four bytes).
inline constexpr std::size_t most_chunk_expansion = 1 << 16;

// Decodes a chunk that has exactly chunk.size() bytes. Throws Error where it is damaged, or has
// another number of bytes. `name`: of the chunk's file, for messages.
void decode_chunk(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk,
                  const std::string& name);

}  // namespace lamina
