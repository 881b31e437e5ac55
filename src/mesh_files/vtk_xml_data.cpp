// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtk_xml_data.h"

#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>

#include "base/client.h"
#include "base/error.h"
#include "base/lz4_block.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

// Decodes the bytes of a binary array of a VTK XML file, raw or base64. Base64 may consist of
// several runs with padding of their own, because VTK encodes the header and the compressed blocks
// separately.
class EncodedBytes {
  public:
    // `what`: names the file and the array in messages.
    EncodedBytes(const VtkXmlSource& source, std::string what)
        : source_(source), text_(source.text), what_(std::move(what)) {}

    // Returns an upper bound on the number of bytes that can still be read.
    std::uint64_t at_most_left() const {
        return source_.base64 ? left() / 4 * 3 + decoded_count_ : left();
    }
    std::uint64_t used() const { return before_ + position_; }  // bytes of the source
    // Throws Error if there are fewer, or if it is not base64.
    void read(char* bytes, std::size_t count);

  private:
    std::uint64_t left() const { return source_.left() - used(); }
    bool read_on();
    bool decode_four();
    std::size_t decode_whole_groups(char* bytes, std::size_t count);

    VtkXmlSource source_;
    ByteBuffer window_;      // a part of the source, if that is in a file
    std::string_view text_;  // the source's, or the window's
    std::string what_;
    std::uint64_t before_ = 0;  // bytes of the source before the text
    std::size_t position_ = 0;  // in the text
    char decoded_[3] = {};      // the last decoded_count_ of these are not read yet
    std::size_t decoded_count_ = 0;
    std::size_t decoded_at_ = 0;
};

constexpr std::uint8_t bad = 255, padding = 64;

constexpr std::array<std::uint8_t, 256> digits = [] {
    std::array<std::uint8_t, 256> table{};
    table.fill(bad);
    constexpr std::string_view alphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
    for (std::size_t i = 0; i < alphabet.size(); ++i) {
        table[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    }
    return table;
}();

// Goes on to the next part of the source's file. Returns false at the end of the source.
bool EncodedBytes::read_on() {
    constexpr std::uint64_t window_bytes = 1 << 20;
    if (source_.file == nullptr) return false;
    before_ += text_.size();
    position_ = 0;
    window_ = ByteBuffer(std::min(left(), window_bytes));
    source_.file->read(source_.begin + before_, window_.data(), window_.size());
    text_ = window_.text();
    return !text_.empty();
}

// Returns false at the end of the source.
bool EncodedBytes::decode_four() {
    std::array<std::uint8_t, 4> digit{};
    for (std::size_t i = 0; i < 4;) {
        if (position_ == text_.size() && !read_on()) {
            if (i == 0) return false;
            fail("{}: the base64 text ends within a group of four characters", what_);
        }
        const char c = text_[position_++];
        if (TextReader::is_blank(c)) continue;
        digit[i] = digits[static_cast<unsigned char>(c)];
        if (digit[i] == bad || (digit[i] == padding && i < 2)) {
            fail("{}: found {}, expected base64", what_,
                 next_word(TextReader(text_.substr(position_ - 1))));
        }
        ++i;
    }
    const auto bits = static_cast<std::uint32_t>((digit[0] & 63) << 18 | (digit[1] & 63) << 12 |
                                                 (digit[2] & 63) << 6 | (digit[3] & 63));
    decoded_count_ = digit[2] == padding ? 1 : digit[3] == padding ? 2 : 3;
    for (std::size_t i = 0; i < 3; ++i) decoded_[i] = static_cast<char>(bits >> (16 - 8 * i));
    decoded_at_ = 0;
    return true;
}

// Decodes groups of four digits without blanks and padding, as nearly all are. Returns the number
// of bytes.
std::size_t EncodedBytes::decode_whole_groups(char* bytes, std::size_t count) {
    const auto* at = reinterpret_cast<const unsigned char*>(text_.data()) + position_;
    const std::size_t groups = std::min(count / 3, (text_.size() - position_) / 4);
    std::size_t done = 0;
    for (; done < groups; ++done, at += 4) {
        const std::uint32_t a = digits[at[0]], b = digits[at[1]], c = digits[at[2]],
                            d = digits[at[3]];
        if ((a | b | c | d) > 63) break;
        const std::uint32_t bits = a << 26 | b << 20 | c << 14 | d << 8;
        const std::uint32_t in_order = __builtin_bswap32(bits);
        std::memcpy(bytes + 3 * done, &in_order, 3);
    }
    position_ += 4 * done;
    return 3 * done;
}

void EncodedBytes::read(char* bytes, std::size_t count) {
    if (count > at_most_left()) {
        fail("{}: found {} bytes, expected {}", what_, at_most_left(), count);
    }
    if (!source_.base64) {
        source_.file->read(source_.begin + before_, bytes, count);
        before_ += count;
        return;
    }
    for (std::size_t done = 0; done < count;) {
        if (decoded_count_ == 0) done += decode_whole_groups(bytes + done, count - done);
        if (done == count) return;
        if (decoded_count_ == 0 && !decode_four()) {
            fail("{}: found {} bytes of base64, expected {}", what_, done, count);
        }
        const std::size_t some = std::min(decoded_count_, count - done);
        std::memcpy(bytes + done, decoded_ + decoded_at_, some);
        decoded_at_ += some;
        decoded_count_ -= some;
        done += some;
    }
}

// How a VTK XML file compresses the blocks of its arrays: the names of VTK's classes.
class VtkXmlCompressor {
  public:
    // Throws Error for a class that is not known. `what`: names the file and the array in messages.
    static VtkXmlCompressor named(const std::string& name, const std::string& what);

    const char* word() const { return word_; }  // "zlib", "LZ4", "LZMA"
    // Most bytes that one stored byte gives.
    std::uint64_t most_expansion() const { return most_expansion_; }
    // Decodes a block of exactly block.size() bytes. Returns how many of the `stored` bytes it
    // took, or -1 if it is damaged or has another number of bytes.
    std::int64_t decode(std::span<const char> stored, std::span<char> block) const {
        return decode_(stored, block);
    }

  private:
    using Decode = std::int64_t (*)(std::span<const char>, std::span<char>);

    VtkXmlCompressor(const char* word, std::uint64_t most_expansion, Decode decoder)
        : word_(word), most_expansion_(most_expansion), decode_(decoder) {}

    const char* word_;
    std::uint64_t most_expansion_;
    Decode decode_;
};

std::int64_t decode_zlib(std::span<const char> stored, std::span<char> block) {
    uLongf size = block.size(), used = stored.size();
    const int result = uncompress2(reinterpret_cast<Bytef*>(block.data()), &size,
                                   reinterpret_cast<const Bytef*>(stored.data()), &used);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    return result == Z_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

std::int64_t decode_lz4(std::span<const char> stored, std::span<char> block) {
    return decode_lz4_block(stored, block) ? static_cast<std::int64_t>(stored.size()) : -1;
}

// vtkLZMADataCompressor writes .xz streams.
std::int64_t decode_lzma(std::span<const char> stored, std::span<char> block) {
    std::uint64_t most_memory = std::uint64_t{256} << 20;  // xz -9 takes 65 MiB
    std::size_t used = 0, size = 0;
    const lzma_ret result = lzma_stream_buffer_decode(
        &most_memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(stored.data()), &used,
        stored.size(), reinterpret_cast<std::uint8_t*>(block.data()), &size, block.size());
    if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
    return result == LZMA_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

VtkXmlCompressor VtkXmlCompressor::named(const std::string& name, const std::string& what) {
    // Deflate codes at most 258 bytes in 2 bits (zlib, "Technical details": 1032:1).
    if (name == "vtkZLibDataCompressor") return {"zlib", 1032, decode_zlib};
    if (name == "vtkLZ4DataCompressor") return {"LZ4", lz4_expansion, decode_lz4};
    // LZMA codes at most 273 bytes in a few adapted bits, each of .02 bits at least: below 2^15.
    if (name == "vtkLZMADataCompressor") return {"LZMA", 1 << 15, decode_lzma};
    fail(
        "{}: compressor: found '{}', expected 'vtkZLibDataCompressor', 'vtkLZ4DataCompressor', "
        "'vtkLZMADataCompressor' or none",
        what, one_line(name));
}

std::uint64_t read_header_word(EncodedBytes& bytes, const VtkXmlEncoding& encoding) {
    char word[8];
    bytes.read(word, bytes_of(encoding.header_type));
    return values_from_bytes<std::uint64_t>(encoding.header_type, word, 1, encoding.swap_bytes)[0];
}

void check_length(std::uint64_t found, std::uint64_t expected, const std::string& what) {
    if (found == expected) return;
    fail("{}: found {} bytes in its header, expected {}", what, found, expected);
}

ByteBuffer read_plain(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::uint64_t expected,
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
// size of the last if it is not full (else 0), then the stored size of each.
std::vector<Block> read_blocks(EncodedBytes& bytes, const VtkXmlEncoding& encoding,
                               const VtkXmlCompressor& compressor, std::uint64_t expected,
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

ByteBuffer read_compressed(EncodedBytes& bytes, const VtkXmlEncoding& encoding,
                           std::uint64_t expected, const std::string& what) {
    const VtkXmlCompressor compressor = VtkXmlCompressor::named(encoding.compressor, what);
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

ByteBuffer read_vtk_xml_bytes(VtkXmlSource& source, const VtkXmlEncoding& encoding, ValueType type,
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
std::vector<To> read_vtk_xml_values(VtkXmlSource& source, const VtkXmlEncoding& encoding,
                                    ValueType type, std::int64_t count, const std::string& what) {
    if (count == 0) return {};
    ByteBuffer values = read_vtk_xml_bytes(source, encoding, type, count, what);
    return values_from_bytes<To>(type, values.data(), static_cast<std::size_t>(count),
                                 encoding.swap_bytes);
}

template std::vector<double> read_vtk_xml_values(VtkXmlSource&, const VtkXmlEncoding&, ValueType,
                                                 std::int64_t, const std::string&);
template std::vector<std::int64_t> read_vtk_xml_values(VtkXmlSource&, const VtkXmlEncoding&,
                                                       ValueType, std::int64_t, const std::string&);

}  // namespace lamina
