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

    // Reads a box inside the volume, in the volume's type and native byte order, x fastest. Throws
    // Error if the files do not have it any more.
    virtual void read(const SampleBox& box, void* to) const = 0;

    // Returns the size of the boxes, on multiples of it, that are read at the least cost. 0: any
    // size.
    virtual std::array<std::int64_t, 3> block() const { return {0, 0, 0}; }

    // Brings boxes that will be read soon from the disk into the system's cache, in the order of
    // the files, if there is room for them.
    virtual void will_read(std::span<const SampleBox> /*boxes*/) const {}

    // Returns the most bytes that it keeps in memory.
    virtual std::uint64_t memory() const { return 0; }

    // Tells whether all samples of the box are 0, if that is known without reading them: so it is
    // for holes in sparse files.
    virtual bool known_as_zero(const SampleBox& /*box*/) const { return false; }

    // Throws Error if the files have changed since they were opened.
    virtual void check_unchanged() const = 0;

    // Return the file or folder that stands for the files, and the names of all files with what is
    // taken of them.
    virtual std::filesystem::path main_file() const = 0;
    virtual std::string name() const = 0;
    // Identifies these samples as they are now: also by the files' sizes and times, and a hash of
    // some samples.
    virtual std::string identity() const = 0;
};

// A box of a volume's samples in memory, x fastest. Samples beyond the box repeat its border; if
// the box reaches the volume's border, so does the volume.
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
