// SPDX-License-Identifier: Apache-2.0
#include "volume/volume.h"

#include <cassert>

namespace lamina {

std::size_t bytes_of(SampleType type) {
    switch (type) {
        case SampleType::uint8:
            return 1;
        case SampleType::int16:
        case SampleType::uint16:
            return 2;
        case SampleType::float32:
            return 4;
    }
    assert(false);
    return 0;
}

const char* name_of(SampleType type) {
    switch (type) {
        case SampleType::uint8:
            return "uint8";
        case SampleType::int16:
            return "int16";
        case SampleType::uint16:
            return "uint16";
        case SampleType::float32:
            return "float";
    }
    assert(false);
    return "";
}

}  // namespace lamina
