// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "base/memory.h"

namespace lamina {

// Tells whether all bytes have one value. `count`: 1 or more.
inline bool all_equal(const void* bytes, std::size_t count, std::uint8_t value) {
    const auto* const first = static_cast<const std::uint8_t*>(bytes);
    return *first == value && std::memcmp(first, first + 1, count - 1) == 0;
}

inline bool all_zero(const void* bytes, std::size_t count) {
    return all_equal(bytes, count, 0);
}

// An array of bytes most of which have one value, the background. Pages of memory that hold nothing
// else take none. Copies share the bytes. Different bytes may be set from several threads.
class SparseBytes {
  public:
    SparseBytes() = default;
    SparseBytes(std::size_t size, std::uint8_t background)
        : size_(size),
          background_(background),
          memory_(std::make_shared<ReservedMemory>(size + padding)) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::uint8_t background() const { return background_; }
    std::uint8_t operator[](std::size_t i) const {
        return static_cast<std::uint8_t>(coded()[i] ^ background_);
    }
    void set(std::size_t i, std::uint8_t value) {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        auto* const at = reinterpret_cast<std::uint8_t*>(memory_->data()) + i;
        if (*at != code) *at = code;
    }
    // Sets the bytes from `first` on. Pages that get the background alone stay without memory, and
    // the others are written without being read first, which would map them twice.
    void set(std::size_t first, std::span<const std::uint8_t> values) {
        constexpr std::size_t page = 4096;
        std::array<std::uint8_t, page> codes;
        auto* const bytes = reinterpret_cast<std::uint8_t*>(memory_->data());
        while (!values.empty()) {
            const std::size_t count = std::min(page - first % page, values.size());
            for (std::size_t i = 0; i < count; ++i)
                codes[i] = static_cast<std::uint8_t>(values[i] ^ background_);
            if (!all_zero(codes.data(), count) || !all_zero(bytes + first, count))
                std::memcpy(bytes + first, codes.data(), count);
            first += count;
            values = values.subspan(count);
        }
    }

    // Returns the bytes as they are stored: each combined with the background by exclusive or.
    // Three more than size() may be read, because vector code reads four at a time.
    const std::uint8_t* coded() const {
        return reinterpret_cast<const std::uint8_t*>(memory_->data());
    }

    // Returns the first place in first .. end - 1 that has this value, or `end` if none has it.
    std::size_t find(std::uint8_t value, std::size_t first, std::size_t end) const {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        if (first == end || coded()[first] == code) return first;
        const void* const found = std::memchr(coded() + first, code, end - first);
        if (found == nullptr) return end;
        return static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - coded());
    }

    std::size_t count(std::uint8_t value) const {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        std::size_t found = 0;
        for (std::size_t i = 0; i < size_; ++i) found += coded()[i] == code;
        return found;
    }

  private:
    static constexpr std::size_t padding = 3;

    std::size_t size_ = 0;
    std::uint8_t background_ = 0;
    std::shared_ptr<ReservedMemory> memory_;
};

}  // namespace lamina
