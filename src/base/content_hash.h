// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace lamina {

// A hash that identifies contents: FNV-1a over words of 64 bits, with a final mix (Steele et al.
// 2014, SplitMix64). It protects against accidents, not against attacks.
class ContentHash {
  public:
    void add(const void* bytes, std::size_t count) {
        add_word(count);
        const auto* const from = static_cast<const unsigned char*>(bytes);
        for (std::size_t i = 0; i < count; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, from + i, count - i < sizeof word ? count - i : sizeof word);
            add_word(word);
        }
    }
    void add(std::string_view text) { add(text.data(), text.size()); }
    void add(double value) { add(&value, sizeof value); }

    std::uint64_t word() const {
        std::uint64_t mixed = state_;
        mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
        mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
        return mixed ^ (mixed >> 31);
    }
    std::string hex() const { return fmt::format("{:016x}", word()); }  // 16 digits

  private:
    // Multiplication changes only higher bits; the rotation brings high bits down again.
    void add_word(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3u;
        state_ = (state_ << 29) | (state_ >> 35);
    }

    std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace lamina
