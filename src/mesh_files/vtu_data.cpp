// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtu_data.h"

#include <algorithm>
#include <span>

#include "base/client.h"
#include "base/error.h"
#include "mesh_files/encoded_bytes.h"
#include "mesh_files/text_reader.h"
#include "mesh_files/vtu_compressor.h"

namespace lamina {
namespace {

std::uint64_t read_header_word(EncodedBytes& bytes, const VtuEncoding& encoding) {
    char word[8];
    bytes.read(word, bytes_of(encoding.header_type));
    return values_from_bytes<std::uint64_t>(encoding.header_type, word, 1, encoding.swap_bytes)[0];
}

void check_length(std::uint64_t found, std::uint64_t expected, const std::string& what) {
    if (found == expected) return;
    fail("{}: found {} bytes in its header, expected {}", what, found, expected);
}

ByteBuffer read_plain(EncodedBytes& bytes, const VtuEncoding& encoding, std::uint64_t expected,
                      const std::string& what) {
    check_length(read_header_word(bytes, encoding), expected, what);
    if (expected > bytes.at_most_left()) {
        fail("{}: found {} bytes before the end of the file's data, expected {}", what,
             bytes.at_most_left(), expected);
    }
    ByteBuffer values(expected);
    bytes.read(values.data(), values.size());
    return values;
}

struct Block {
    std::uint64_t stored = 0, size = 0;
};

// Reads the header of compressed data: the number of blocks, the size of each but the last, the
// size of the last where it is not full, then the stored size of each.
std::vector<Block> read_blocks(EncodedBytes& bytes, const VtuEncoding& encoding,
                               const VtuCompressor& compressor, std::uint64_t expected,
                               const std::string& what) {
    const std::uint64_t count = read_header_word(bytes, encoding);
    const std::uint64_t full = read_header_word(bytes, encoding);
    const std::uint64_t last = read_header_word(bytes, encoding);
    if (count > bytes.at_most_left() / bytes_of(encoding.header_type)) {
        fail("{}: the header promises {} compressed blocks, the file holds {} bytes after it", what,
             count, bytes.at_most_left());
    }
    std::vector<Block> blocks(count);
    std::uint64_t stored = 0, size = 0;
    bool overflow = false;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        Block& block = blocks[i];
        block.size = i + 1 == blocks.size() && last > 0 ? last : full;
        block.stored = read_header_word(bytes, encoding);
        overflow |= __builtin_add_overflow(stored, block.stored, &stored);
        overflow |= __builtin_add_overflow(size, block.size, &size);
        if (block.size / compressor.most_expansion() > block.stored) {
            fail("{}: block {} promises {} bytes out of {} of {} data, more than {} can hold", what,
                 i + 1, block.size, block.stored, compressor.word(), compressor.word());
        }
    }
    if (overflow) fail("{}: damaged header: the sizes of its blocks have no sum", what);
    check_length(size, expected, what);
    if (stored > bytes.at_most_left()) {
        fail(
            "{}: found {} bytes before the end of the file's data, expected {} of compressed "
            "blocks",
            what, bytes.at_most_left(), stored);
    }
    return blocks;
}

ByteBuffer read_compressed(EncodedBytes& bytes, const VtuEncoding& encoding, std::uint64_t expected,
                           const std::string& what) {
    const VtuCompressor compressor = VtuCompressor::named(encoding.compressor, what);
    const std::vector<Block> blocks = read_blocks(bytes, encoding, compressor, expected, what);
    ByteBuffer values(expected);
    std::string packed;
    std::size_t done = 0;
    std::uint64_t surplus = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        check_interrupt();
        packed.resize(blocks[i].stored);
        bytes.read(packed.data(), packed.size());
        const std::int64_t used =
            compressor.decode(packed, values.span().subspan(done, blocks[i].size));
        if (used < 0) {
            fail("{}: damaged {} data in block {} of {}", what, compressor.word(), i + 1,
                 blocks.size());
        }
        done += blocks[i].size;
        surplus += packed.size() - static_cast<std::size_t>(used);
    }
    if (surplus > 0) {
        warn(
            fmt::format("{}: found {} bytes behind the {} data of its {} blocks, expected none: "
                        "they are not used",
                        what, surplus, compressor.word(), blocks.size()));
    }
    return values;
}

}  // namespace

ByteBuffer read_vtu_bytes(VtuSource& source, const VtuEncoding& encoding, ValueType type,
                          std::int64_t count, const std::string& what) {
    if (count == 0) return {};
    std::uint64_t expected = 0;
    if (__builtin_mul_overflow(static_cast<std::uint64_t>(count), bytes_of(type), &expected)) {
        fail("{}: the file promises {} values, more than any file holds", what, count);
    }
    EncodedBytes bytes(source, what);
    ByteBuffer values;
    if (encoding.compressor.empty()) {
        values = read_plain(bytes, encoding, expected, what);
    } else {
        values = read_compressed(bytes, encoding, expected, what);
    }
    source.skip(bytes.used());
    return values;
}

template <typename To>
std::vector<To> read_vtu_data(VtuSource& source, const VtuEncoding& encoding, ValueType type,
                              std::int64_t count, const std::string& what) {
    if (count == 0) return {};
    ByteBuffer values = read_vtu_bytes(source, encoding, type, count, what);
    return values_from_bytes<To>(type, values.data(), static_cast<std::size_t>(count),
                                 encoding.swap_bytes);
}

template std::vector<double> read_vtu_data(VtuSource&, const VtuEncoding&, ValueType, std::int64_t,
                                           const std::string&);
template std::vector<std::int64_t> read_vtu_data(VtuSource&, const VtuEncoding&, ValueType,
                                                 std::int64_t, const std::string&);

}  // namespace lamina
