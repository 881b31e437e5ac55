// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "lamina/export.h"
#include "lamina/grid.h"

namespace lamina {

enum class SampleType { uint8, int16, uint16, float32 };

LAMINA_API std::size_t bytes_of(SampleType type);
LAMINA_API const char* name_of(SampleType type);  // "uint8", "int16", "uint16", "float"

class VolumeStore;

// Scalars on a regular grid, in the file's own type; x changes fastest. A volume is immutable, and
// copies share the samples. Volumes that do not fit the memory limit (lamina/memory.h) stay in
// their files, and parts of them are read when they are drawn. The library's functions return and
// take only volumes in memory.
class Volume {
  public:
    // `samples`: grid.sample_count() values of `type` in native byte order.
    Volume(Grid grid, SampleType type, std::shared_ptr<const void> samples)
        : grid_(grid), type_(type), samples_(std::move(samples)) {}
    // A volume that stays in its files.
    Volume(Grid grid, SampleType type, std::shared_ptr<const VolumeStore> store)
        : grid_(grid), type_(type), store_(std::move(store)) {}

    const Grid& grid() const { return grid_; }
    SampleType type() const { return type_; }
    bool in_memory() const { return store_ == nullptr; }
    const VolumeStore& store() const { return *store_; }  // only if it is not in memory
    const void* data() const { return samples_.get(); }   // null if it is not in memory
    const std::shared_ptr<const void>& shared_data() const { return samples_; }
    // Returns these samples on another grid, which has as many of them along each axis.
    Volume on(const Grid& grid) const {
        Volume placed = *this;
        placed.grid_ = grid;
        return placed;
    }
    bool shares_samples(const Volume& other) const {
        return samples_ == other.samples_ && store_ == other.store_;
    }
    std::size_t byte_count() const {
        return static_cast<std::size_t>(grid_.sample_count()) * bytes_of(type_);
    }

    // Calls visitor(pointer to the first sample); the volume must be in memory. The pointer has the
    // type of the samples: std::uint8_t, std::int16_t, std::uint16_t or float.
    template <typename Visitor>
    decltype(auto) visit(Visitor&& visitor) const {
        switch (type_) {
            case SampleType::uint8:
                return visitor(static_cast<const std::uint8_t*>(data()));
            case SampleType::int16:
                return visitor(static_cast<const std::int16_t*>(data()));
            case SampleType::uint16:
                return visitor(static_cast<const std::uint16_t*>(data()));
            case SampleType::float32:
                return visitor(static_cast<const float*>(data()));
        }
        __builtin_unreachable();  // there is a case for every value
    }

  private:
    Grid grid_;
    SampleType type_;
    std::shared_ptr<const void> samples_;
    std::shared_ptr<const VolumeStore> store_;
};

}  // namespace lamina
