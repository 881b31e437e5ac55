// SPDX-License-Identifier: Apache-2.0
// numcodecs: what Zarr's chunks hold.
#include "volume_files/zarr_codec.h"

#include <blosc.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>

#include "base/error.h"
#include "base/lz4_block.h"

namespace lamina {
namespace {

constexpr const char* codec_names[] = {"none", "zlib", "gzip", "zstd", "lz4", "blosc"};

// zlib and gzip streams alike, the whole of them.
bool inflate_all(std::span<const char> stored, std::span<char> chunk) {
    constexpr int any_header = 15 + 32;
    if (stored.size() > std::numeric_limits<uInt>::max()) return false;
    z_stream stream{};
    if (inflateInit2(&stream, any_header) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
    stream.avail_in = static_cast<uInt>(stored.size());
    std::size_t done = 0;
    int result = Z_OK;
    while (result == Z_OK) {
        const std::size_t room =
            std::min<std::size_t>(chunk.size() - done, std::numeric_limits<uInt>::max());
        stream.next_out = reinterpret_cast<Bytef*>(chunk.data() + done);
        stream.avail_out = static_cast<uInt>(room);
        result = inflate(&stream, room == 0 ? Z_FINISH : Z_NO_FLUSH);
        done += room - stream.avail_out;
    }
    inflateEnd(&stream);
    return result == Z_STREAM_END && done == chunk.size();
}

bool decode_zstd(std::span<const char> stored, std::span<char> chunk) {
    return ZSTD_decompress(chunk.data(), chunk.size(), stored.data(), stored.size()) ==
           chunk.size();
}

// numcodecs puts the length before the block, in four bytes.
bool decode_lz4(std::span<const char> stored, std::span<char> chunk) {
    std::uint32_t size = 0;
    if (stored.size() < sizeof size) return false;
    std::memcpy(&size, stored.data(), sizeof size);
    if constexpr (std::endian::native == std::endian::big) size = __builtin_bswap32(size);
    return size == chunk.size() && decode_lz4_block(stored.subspan(sizeof size), chunk);
}

bool decode_blosc(std::span<const char> stored, std::span<char> chunk) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(stored.data(), stored.size(), &size) != 0) return false;
    if (size != chunk.size()) return false;
    if (size == 0) return true;
    return blosc_decompress_ctx(stored.data(), chunk.data(), chunk.size(), 1) ==
           static_cast<int>(size);
}

bool decode(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk) {
    switch (codec) {
        case ZarrCodec::zlib:
        case ZarrCodec::gzip:
            return inflate_all(stored, chunk);
        case ZarrCodec::zstd:
            return decode_zstd(stored, chunk);
        case ZarrCodec::lz4:
            return decode_lz4(stored, chunk);
        case ZarrCodec::blosc:
            return decode_blosc(stored, chunk);
        case ZarrCodec::none:
            break;
    }
    if (stored.size() != chunk.size()) return false;
    std::memcpy(chunk.data(), stored.data(), chunk.size());
    return true;
}

}  // namespace

ZarrCodec zarr_codec(const std::string& id, const std::string& name) {
    if (id.empty()) return ZarrCodec::none;
    for (const ZarrCodec codec :
         {ZarrCodec::zlib, ZarrCodec::gzip, ZarrCodec::zstd, ZarrCodec::lz4, ZarrCodec::blosc}) {
        if (id == codec_names[static_cast<std::size_t>(codec)]) return codec;
    }
    fail("{}: compressor: found \"{}\", expected blosc, zlib, gzip, zstd, lz4 or null", name,
         one_line(id));
}

void decode_chunk(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk,
                  const std::string& name) {
    if (decode(codec, stored, chunk)) return;
    if (codec == ZarrCodec::none)
        fail("{}: found {} bytes, expected {}", name, stored.size(), chunk.size());
    fail("{}: damaged {} data in its {} bytes, or not of the {} bytes that a chunk has", name,
         codec_names[static_cast<std::size_t>(codec)], stored.size(), chunk.size());
}

}  // namespace lamina
