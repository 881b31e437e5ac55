// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/export.h"

namespace lamina {

// Memory that the process may take for data, in bytes. Volumes that a scene names and that do not
// fit stay in their files, and parts of them are read when they are drawn. The default is half of
// the machine's memory, or of its control group's. A change counts for volumes that are opened
// later.
LAMINA_API std::uint64_t memory_limit();
LAMINA_API void set_memory_limit(std::uint64_t bytes);  // 0: the default

}  // namespace lamina
