// SPDX-License-Identifier: Apache-2.0
// The bytes of chunks as numcodecs packs them, and the checksum of RFC 3720 (iSCSI), appendix B.4.
#include "volume_files/zarr_array.h"

#include <blosc.h>
#include <bzlib.h>
#include <lz4.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_samples.h"

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

bool decode_bz2(std::span<const char> stored, std::span<char> chunk) {
    if (!std::in_range<unsigned>(stored.size()) || !std::in_range<unsigned>(chunk.size()))
        return false;
    auto size = static_cast<unsigned>(chunk.size());
    const int result =
        BZ2_bzBuffToBuffDecompress(chunk.data(), &size, const_cast<char*>(stored.data()),
                                   static_cast<unsigned>(stored.size()), 0, 0);
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    return result == BZ_OK && size == chunk.size();
}

// Puts byte b of element i, which lies at b * count + i, back to i * word + b.
void unshuffle(std::size_t word, std::span<char> chunk) {
    const std::size_t count = chunk.size() / word;
    const std::vector<char> stored(chunk.begin(), chunk.end());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < word; ++b) chunk[i * word + b] = stored[b * count + i];
}

// Adds up differences behind the first value, which is kept as it is: 0 + -0 is 0. Whole numbers
// wrap, as NumPy's do.
template <typename Value>
void add_up(std::span<char> chunk) {
    Value sum = 0, difference = 0;
    if (chunk.size() < sizeof sum) return;
    std::memcpy(&sum, chunk.data(), sizeof sum);
    for (std::size_t at = sizeof sum; at < chunk.size(); at += sizeof sum) {
        std::memcpy(&difference, &chunk[at], sizeof sum);
        sum = static_cast<Value>(sum + difference);
        std::memcpy(&chunk[at], &sum, sizeof sum);
    }
}

void undo_delta(const ZarrFilter& filter, std::span<char> chunk) {
    const auto count = static_cast<std::int64_t>(chunk.size() / filter.word);
    if (filter.swap) swap_bytes_alone(chunk.data(), count, filter.word);
    if (filter.are_floats) {
        filter.word == 4 ? add_up<float>(chunk) : add_up<double>(chunk);
    } else {
        const auto add = filter.word == 1   ? add_up<std::uint8_t>
                         : filter.word == 2 ? add_up<std::uint16_t>
                         : filter.word == 4 ? add_up<std::uint32_t>
                                            : add_up<std::uint64_t>;
        add(chunk);
    }
    if (filter.swap) swap_bytes_alone(chunk.data(), count, filter.word);
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

constexpr ZarrCodec zarr_codecs[] = {{"blosc", true, true, decode_blosc},
                                     {"zlib", true, false, inflate_all},
                                     {"gzip", true, true, inflate_all},
                                     {"zstd", true, true, decode_zstd},
                                     {"lz4", true, false, decode_lz4},
                                     {"bz2", true, false, decode_bz2},
                                     {"crc32c", false, true, verify_checksum, true}};

}  // namespace

const ZarrCodec* zarr_codec(std::string_view name, int version) {
    for (const ZarrCodec& codec : zarr_codecs) {
        if (name == codec.name && (version == 2 ? codec.in_version_2 : codec.in_version_3))
            return &codec;
    }
    return nullptr;
}

void undo_filters(std::span<const ZarrFilter> filters, std::span<char> chunk) {
    for (std::size_t i = filters.size(); i-- > 0;) {
        check_interrupt();
        if (filters[i].kind == ZarrFilter::Kind::shuffle)
            unshuffle(filters[i].word, chunk);
        else
            undo_delta(filters[i], chunk);
    }
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
