// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/reserved_memory.h"

namespace lamina {

// Bytes of which most have one value, the background: pages that hold nothing else take no memory.
// Copies share the bytes. Different ones may be set from several threads.
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

    // The bytes combined with the background by exclusive or. Three more than size() may be read,
    // because vectors read four at a time.
    const std::uint8_t* coded() const {
        return reinterpret_cast<const std::uint8_t*>(memory_->data());
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
