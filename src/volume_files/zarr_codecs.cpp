// SPDX-License-Identifier: Apache-2.0
// The bytes of chunks as numcodecs packs them, and the checksum of RFC 3720 (iSCSI), appendix B.4.
#include "volume_files/zarr_array.h"

#include <blosc.h>
#include <lz4.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/input_file.h"

namespace lamina {
namespace {

// Decodes zlib and gzip streams alike, each as a whole.
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

// Decodes a block of LZ4. numcodecs puts the length before it, in four bytes.
bool decode_lz4(std::span<const char> stored, std::span<char> chunk) {
    std::uint32_t size = 0;
    if (stored.size() < sizeof size) return false;
    std::memcpy(&size, stored.data(), sizeof size);
    if constexpr (std::endian::native == std::endian::big) size = __builtin_bswap32(size);
    stored = stored.subspan(sizeof size);
    return size == chunk.size() && std::in_range<int>(stored.size()) &&
           LZ4_decompress_safe(stored.data(), chunk.data(), static_cast<int>(stored.size()),
                               static_cast<int>(size)) == static_cast<int>(size);
}

bool decode_blosc(std::span<const char> stored, std::span<char> chunk) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(stored.data(), stored.size(), &size) != 0) return false;
    if (size != chunk.size()) return false;
    if (size == 0) return true;
    return blosc_decompress_ctx(stored.data(), chunk.data(), chunk.size(), 1) ==
           static_cast<int>(size);
}

constexpr std::size_t checksum_bytes = 4;

// CRC-32C of each byte: Castagnoli's polynomial, reflected.
constexpr auto checksum_table = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
        std::uint32_t rest = byte;
        for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ ((rest & 1) != 0 ? 0x82f63b78u : 0);
        table[byte] = rest;
    }
    return table;
}();

// Verifies the checksum of bytes, which lies behind them, the lowest byte first.
bool verify_checksum(std::span<const char> stored, std::span<char> chunk) {
    if (stored.size() != chunk.size() + checksum_bytes) return false;
    std::uint32_t sum = 0xffffffffu, expected = 0;
    for (const char byte : stored.first(chunk.size()))
        sum = sum >> 8 ^ checksum_table[(sum ^ static_cast<unsigned char>(byte)) & 0xff];
    for (std::size_t i = checksum_bytes; i-- > 0;)
        expected = expected << 8 | static_cast<unsigned char>(stored[chunk.size() + i]);
    if (~sum != expected) return false;
    std::memcpy(chunk.data(), stored.data(), chunk.size());
    return true;
}

constexpr ZarrCodec zarr_codecs[] = {
    {"blosc", true, true, decode_blosc}, {"zlib", true, false, inflate_all},
    {"gzip", true, true, inflate_all},   {"zstd", true, true, decode_zstd},
    {"lz4", true, false, decode_lz4},    {"crc32c", false, true, verify_checksum, true}};

}  // namespace

const ZarrCodec* zarr_codec(std::string_view name, int version) {
    for (const ZarrCodec& codec : zarr_codecs) {
        if (name == codec.name && (version == 2 ? codec.in_version_2 : codec.in_version_3))
            return &codec;
    }
    return nullptr;
}

void decode_chunk(std::span<const ZarrCodec* const> codecs, std::span<const char> stored,
                  std::span<char> chunk, const std::string& name) {
    if (codecs.empty()) {
        if (stored.size() != chunk.size())
            fail("{}: found {} bytes, expected {}", name, stored.size(), chunk.size());
        std::memcpy(chunk.data(), stored.data(), chunk.size());
    }
    ByteBuffer held;
    for (std::size_t i = codecs.size(); i-- > 0;) {
        // A checksum behind a compression does not know how many bytes that has made.
        const bool is_packed = std::ranges::any_of(
            codecs.first(i), [](const ZarrCodec* codec) { return !codec->is_checksum; });
        ByteBuffer decoded(i == 0      ? 0
                           : is_packed ? stored.size() - std::min(stored.size(), checksum_bytes)
                                       : chunk.size() + i * checksum_bytes);
        if (!codecs[i]->decode(stored, i == 0 ? chunk : decoded.span())) {
            fail("{}: damaged {} data in its {} bytes, or not of the {} bytes that a chunk has",
                 name, codecs[i]->name, stored.size(), chunk.size());
        }
        held = std::move(decoded);
        stored = held.text();
    }
}

}  // namespace lamina
