// SPDX-License-Identifier: Apache-2.0
#include "parallel/wire.h"

#include "base/enum_words.h"
#include "base/error.h"
#include "base/shortened.h"

namespace lamina {

const char* name_of(Wire wire) {
    return word_of(wire, {"float32", "half", "coded"});
}

Wire wire_of(const std::string& word) {
    if (const auto found = value_of_word<Wire>(word)) return *found;
    throw UsageError(
        fmt::format("--wire: found {}, expected {}", shortened(word), alternatives<Wire>()));
}

}  // namespace lamina
