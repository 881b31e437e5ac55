// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace lamina {

// What `work` returns, done with a stack of at least 8 MiB: here, or, where the limit of the main
// thread's (ulimit -s) is lower, in a thread of its own. Threads that libraries start later get as
// much. `work` must not throw. Throws std::system_error where there is no memory for the stack.
// (lamina-tetrahedralize, which takes no library of lamina, has this file, too.)
int with_large_stack(const std::function<int()>& work);

}  // namespace lamina
