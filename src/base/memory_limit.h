// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/memory.h"

namespace lamina {

// What the process may have resident beside the data that memory_limit() is about.
constexpr std::uint64_t own_memory = 200'000'000;

bool memory_limit_is_told();  // not the default

// What the process has resident, in bytes; 0 where that is not known.
std::uint64_t resident_memory();

// What may still be taken: memory_limit() + own_memory - resident_memory(), 0 or more.
std::uint64_t memory_left();

}  // namespace lamina
