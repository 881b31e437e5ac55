// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "lamina/volume.h"

namespace lamina {

// The samples first .. first + size - 1 of a grid.
struct SampleBox {
    std::array<std::int64_t, 3> first{0, 0, 0};
    std::array<std::int64_t, 3> size{1, 1, 1};

    std::int64_t count() const { return size[0] * size[1] * size[2]; }
};

// Samples of a volume that stay in files and are read when they are needed. Safe from any thread.
class SampleSource {
  public:
    SampleSource() = default;
    virtual ~SampleSource() = default;
    SampleSource(const SampleSource&) = delete;
    SampleSource& operator=(const SampleSource&) = delete;

    // Reads a box inside the volume, in its type and native byte order, x fastest. Throws Error.
    virtual void read(const SampleBox& box, void* to) const = 0;

    // Returns the size of the cheapest boxes to read, which begin at multiples of it; 0: any.
    virtual std::array<std::int64_t, 3> block() const { return {0, 0, 0}; }

    // Brings boxes that will be read soon into the system's cache, in file order, if they fit.
    virtual void will_read(std::span<const SampleBox> /*boxes*/) const {}

    // Returns the most bytes that the source keeps in memory.
    virtual std::uint64_t memory() const { return 0; }

    // Tells if the box is known to be 0 without reading it, as in holes of sparse files.
    virtual bool known_as_zero(const SampleBox& /*box*/) const { return false; }

    // Throws Error if the files have changed since they were opened.
    virtual void check_unchanged() const = 0;

    // Returns the file or folder beside which the volume's index file lies.
    virtual std::filesystem::path main_file() const = 0;
    // Returns a text of all files' names and what is read of them. It names the cached index file.
    virtual std::string name() const = 0;
    // Returns a text that identifies the samples as they are now: also by the files' sizes and
    // times, and a hash of some samples.
    virtual std::string identity() const = 0;
};

// A box of a volume's samples in memory, x fastest. Places beyond the box have the samples at its
// border; they must lie beyond the volume's border, too.
template <typename T>
struct SampleWindow {
    SampleBox box;
    const T* samples = nullptr;

    const T* row(std::int64_t y, std::int64_t z) const {
        return samples + (inside(2, z) * box.size[1] + inside(1, y)) * box.size[0];
    }
    T at(std::int64_t x, std::int64_t y, std::int64_t z) const { return row(y, z)[inside(0, x)]; }

    // Copies the samples (x, y, z) .. (x + count - 1, y, z).
    void copy_row(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t count, T* to) const {
        const T* const from = row(y, z);
        const std::int64_t begin = std::clamp<std::int64_t>(box.first[0] - x, 0, count);
        const std::int64_t end =
            std::clamp<std::int64_t>(box.first[0] + box.size[0] - x, begin, count);
        std::fill(to, to + begin, from[0]);
        std::copy(from + (x + begin - box.first[0]), from + (x + end - box.first[0]), to + begin);
        std::fill(to + end, to + count, from[box.size[0] - 1]);
    }

  private:
    std::int64_t inside(std::size_t axis, std::int64_t at) const {
        return std::clamp<std::int64_t>(at - box.first[axis], 0, box.size[axis] - 1);
    }
};

// Calls visitor(0), a zero of the C++ type that `type` names.
template <typename Visitor>
decltype(auto) with_sample_type(SampleType type, const Visitor& visitor) {
    switch (type) {
        case SampleType::uint8:
            return visitor(std::uint8_t{});
        case SampleType::int16:
            return visitor(std::int16_t{});
        case SampleType::uint16:
            return visitor(std::uint16_t{});
        case SampleType::float32:
            return visitor(float{});
    }
    __builtin_unreachable();  // there is a case for every value
}

}  // namespace lamina
