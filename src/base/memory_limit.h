// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/memory.h"

namespace lamina {

// How much memory the process may take for itself, beside memory_limit() for data.
constexpr std::uint64_t own_memory = 200'000'000;

bool memory_limit_is_told();  // whether somebody has set one

// Sets the limit that holds where nobody has set one.
void set_default_memory_limit(std::uint64_t bytes);

// The memory of the machine, or of the control group that the process is in.
std::uint64_t machine_memory();

// The process's resident memory in bytes; 0 where that is not known.
std::uint64_t resident_memory();

// The largest that it was, as the kernel keeps it for the program alone: that of getrusage()
// includes what the process held before it became lamina.
std::uint64_t peak_resident_memory();

// How much memory may still be taken: memory_limit() + own_memory - resident_memory(), 0 or more.
std::uint64_t memory_left();

}  // namespace lamina
