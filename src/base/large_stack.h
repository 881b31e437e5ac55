// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace lamina {

// Runs `work` with a stack of at least 8 MiB and returns its result. It runs in the calling thread
// or, if the limit of the main thread (ulimit -s) is lower, in a new thread; threads that libraries
// start later get as large a stack. `work` must not throw. Throws std::system_error if there is no
// memory for the stack. (lamina-tetrahedralize, which links no library of lamina, compiles this
// file, too.)
int with_large_stack(const std::function<int()>& work);

}  // namespace lamina
