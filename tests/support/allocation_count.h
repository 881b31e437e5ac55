// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina::test {

// Returns how often operator new was called so far in this program, by any thread.
std::int64_t allocation_count();

}  // namespace lamina::test
