// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/memory.h"
#include "base/sparse_bytes.h"
#include "lamina/volume.h"

namespace lamina {

// A range of finite scalars in float32, which holds every sample type exactly; lo > hi where there
// are none.
struct BrickRange {
    float lo = 1;
    float hi = 0;
};

// Ranges, two samples of the volume's type each: a 32nd of the volume's memory. At first all are
// [0, 0], and take no memory.
class BrickRanges {
  public:
    BrickRanges() = default;
    BrickRanges(std::size_t count, SampleType type)
        : count_(count), type_(type), memory_(count * 2 * bytes_of(type)) {}

    std::size_t size() const { return count_; }
    SampleType type() const { return type_; }
    std::size_t byte_count() const { return memory_.size(); }
    std::byte* data() { return memory_.data(); }
    const std::byte* data() const { return memory_.data(); }

    BrickRange operator[](std::size_t i) const {
        switch (type_) {
            case SampleType::uint8:
                return range_as<std::uint8_t>(i);
            case SampleType::int16:
                return range_as<std::int16_t>(i);
            case SampleType::uint16:
                return range_as<std::uint16_t>(i);
            case SampleType::float32:
                return range_as<float>(i);
        }
        __builtin_unreachable();  // there is a case for every value
    }

    // Whether `count` ranges, 1 or more, are [0, 0].
    bool all_zero(std::size_t first, std::size_t count) const {
        const std::size_t each = 2 * bytes_of(type_);
        return lamina::all_zero(memory_.data() + first * each, count * each);
    }

    // The range as one number, lo + 256 hi; of samples of 8 bits alone.
    std::size_t byte_pair(std::size_t i) const {
        const auto* const range = reinterpret_cast<const std::uint8_t*>(memory_.data()) + 2 * i;
        return range[0] + (std::size_t{range[1]} << 8);
    }

    // T: the volume's type.
    template <typename T>
    void set(std::size_t i, T lo, T hi) {
        const T range[2] = {lo, hi};
        std::memcpy(memory_.data() + i * sizeof range, range, sizeof range);
    }

  private:
    template <typename T>
    BrickRange range_as(std::size_t i) const {
        T range[2];
        std::memcpy(range, memory_.data() + i * sizeof range, sizeof range);
        return {static_cast<float>(range[0]), static_cast<float>(range[1])};
    }

    std::size_t count_ = 0;
    SampleType type_ = SampleType::uint8;
    ReservedMemory memory_;
};

}  // namespace lamina
