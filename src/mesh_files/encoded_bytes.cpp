// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/encoded_bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

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

}  // namespace

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

// Groups of four digits without blanks and padding, as nearly all are. Returns the bytes that they
// make.
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

}  // namespace lamina
