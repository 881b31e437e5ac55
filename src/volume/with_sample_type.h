// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/volume.h"

namespace lamina {

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
