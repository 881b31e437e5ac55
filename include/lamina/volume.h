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

// Scalars on a regular grid, in the file's own type; x changes fastest. A volume is immutable, and
// copies share the samples.
class Volume {
  public:
    // `samples`: grid.sample_count() values of `type` in native byte order.
    Volume(Grid grid, SampleType type, std::shared_ptr<const void> samples)
        : grid_(grid), type_(type), samples_(std::move(samples)) {}

    const Grid& grid() const { return grid_; }
    SampleType type() const { return type_; }
    const void* data() const { return samples_.get(); }
    const std::shared_ptr<const void>& shared_data() const { return samples_; }
    std::size_t byte_count() const {
        return static_cast<std::size_t>(grid_.sample_count()) * bytes_of(type_);
    }

    // Calls visitor(pointer to the first sample). The pointer has the type of the samples:
    // std::uint8_t, std::int16_t, std::uint16_t or float.
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
};

}  // namespace lamina
