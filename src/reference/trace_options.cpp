// SPDX-License-Identifier: Apache-2.0
#include "reference/trace_options.h"

#include "base/error.h"

namespace lamina {

void check(const TraceOptions& options) {
    if (!(options.tolerance >= TraceOptions::smallest_tolerance && options.tolerance <= 1)) {
        fail("render.trace.tolerance: {} is out of range, expected {} to 1", options.tolerance,
             TraceOptions::smallest_tolerance);
    }
    if (options.lighting && options.lighting->smallest_gradient.is_automatic()) {
        fail(
            "lighting.smallest_gradient: is \"auto\", expected a number: it has not been chosen "
            "from the data");
    }
}

}  // namespace lamina
