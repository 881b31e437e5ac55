// SPDX-License-Identifier: Apache-2.0
#include "parallel/wire.h"

#include "base/error.h"
#include "base/shortened.h"
#include "base/unreachable.h"

namespace lamina {

const char* name_of(Wire wire) {
    switch (wire) {
        case Wire::float32:
            return "float32";
        case Wire::half:
            return "half";
        case Wire::coded:
            return "coded";
    }
    unreachable_enum();
}

Wire wire_of(const std::string& word) {
    for (const Wire wire : {Wire::float32, Wire::half, Wire::coded})
        if (word == name_of(wire)) return wire;
    throw UsageError(
        fmt::format("--wire: found {}, expected float32, half or coded", shortened(word)));
}

}  // namespace lamina
