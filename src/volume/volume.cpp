// SPDX-License-Identifier: Apache-2.0
#include "lamina/volume.h"

#include "base/enum_words.h"

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
    unreachable_enum();
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
    unreachable_enum();
}

}  // namespace lamina
