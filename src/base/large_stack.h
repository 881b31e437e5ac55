// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace lamina {

// Runs `work`, which must not throw, with a stack of at least 8 MiB: in this thread or, if the main
// thread's limit (ulimit -s) is lower, in a new one; later threads get as large a stack. Throws
// std::system_error if there is no memory for it. (lamina-tetrahedralize, too, compiles this file.)
int with_large_stack(const std::function<int()>& work);

}  // namespace lamina
