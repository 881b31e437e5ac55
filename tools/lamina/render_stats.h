// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lamina/report.h"
#include "plan/plan.h"

namespace lamina {

// Statistics of one `lamina render` (--stats): those of its first picture, with the largest counts
// of all pictures, and the times of all frames.
struct RunStatistics {
    FrameStatistics picture = {};  // before the first picture: only the stages so far
    std::vector<double> frames_ms = {};
    // Time from the start of reading the scene to the written picture, without the frames of
    // --frames.
    double first_picture_ms = 0;

    void add(const FrameStatistics& next);
};

// Raises each value of `largest` to the count of the same name, if that is larger.
void keep_largest(const std::map<std::string, std::int64_t>& counts,
                  std::map<std::string, std::int64_t>& largest);

nlohmann::ordered_json to_json(const RunStatistics& run, const Plan& plan);

}  // namespace lamina
