// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>

#include "base/interrupt.h"

namespace lamina {

// Calls body(i) for every i in [0, count) on all cores, in no particular order; an exception of one
// call ends the loop and is rethrown, and so does Ctrl-C. `grain`: how many calls make one task
// (make a task at least some 10 us long).
template <typename Body>
void parallel_for(std::int64_t count, std::int64_t grain, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, static_cast<std::size_t>(grain)),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                          check_interrupt();
                          for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
}

}  // namespace lamina
