// SPDX-License-Identifier: Apache-2.0
#include "parallel/wire.h"

#include "base/enum_words.h"
#include "base/error.h"
#include "base/shortened.h"

namespace lamina {

// Its words are listed by enum_words() (base/enum_words.h), too.
const char* name_of(Wire wire) {
    switch (wire) {
        case Wire::float32:
            return "float32";
        case Wire::half:
            return "half";
        case Wire::coded:
            return "coded";
    }
    return nullptr;
}

Wire wire_of(const std::string& word) {
    if (const auto found = value_of_word<Wire>(word)) return *found;
    throw UsageError(
        fmt::format("--wire: found {}, expected {}", shortened(word), alternatives<Wire>()));
}

}  // namespace lamina
