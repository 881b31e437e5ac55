// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "base/value_type.h"

namespace lamina {

// Reads `count` numbers, separated by blanks or commas, into `samples` of `type`. (teem 1.12 reads
// words of any length into a buffer of fixed length, and wraps numbers that do not fit their type.)
// Throws Error; `file` is for messages.
void read_text_samples(std::FILE* stream, const std::string& file, ValueType type,
                       std::int64_t count, void* samples);

}  // namespace lamina
