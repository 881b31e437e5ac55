// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>

#include "bindings.h"

namespace lamina::python {

using StoppableWork = std::function<void(std::stop_token, const ProgressCallback&)>;

// Runs work in a thread of its own, without the GIL. The calling thread meanwhile lets Python
// handle its signals and calls `progress`(activity, share), which may be None: an exception of
// either, such as KeyboardInterrupt, stops the work and is thrown once that has ended. Exceptions
// of the work are thrown, too.
void run_waiting(const StoppableWork& work, const py::object& progress = py::none());

}  // namespace lamina::python
