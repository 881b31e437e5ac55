// SPDX-License-Identifier: Apache-2.0
// Good files of the fuzzers' corpus, and what becomes of them when a number is changed.
#pragma once

#include <cstring>
#include <string>

#include "base/input_file.h"

namespace lamina::testing {

inline std::string corpus_file(const std::string& name) {
    return read_file_bytes(std::string(LAMINA_SOURCE_DIR) + "/tests/fuzz/corpus/" + name);
}

template <typename T>
std::string with_number(std::string bytes, std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

}  // namespace lamina::testing
