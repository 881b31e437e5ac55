// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lamina {

// The steps of a series that --time names: first, first + step, ... up to last.
struct TimeRange {
    std::int64_t first = 0, last = 0, step = 1;

    std::vector<std::int64_t> steps() const;
};

// Reads "FIRST:LAST" or "FIRST:LAST:STEP": whole numbers from 0, LAST not below FIRST, STEP from 1,
// at most 100000 steps. Throws UsageError.
TimeRange time_range(const std::string& text);

}  // namespace lamina
