// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

// How pixels travel between ranks.
enum class Wire {
    float32,  // 16 bytes a pixel: nothing is lost
    half,     // 8 bytes: four halves, associated
    coded,    // 5 bytes, then 8: docs/cluster.md
};

const char* name_of(Wire wire);
Wire wire_of(const std::string& word);  // throws UsageError where it is none of these

}  // namespace lamina
