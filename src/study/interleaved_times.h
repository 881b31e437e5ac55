// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::study {

// Something to time: `draw` makes one frame and returns when it is complete; `warm_up` makes it
// ready.
struct TimedFrame {
    std::string name;
    std::function<void()> warm_up, draw;
};

struct FrameTimes {
    double ms = 0;            // median, by the clock
    double cpu_ms = 0;        // median, of all threads of the process
    double min = 0, max = 0;  // ms, by the clock
    std::size_t count = 0;
};

// Rounds A B C, A B C ...: what slows the machine for a while slows all of them. At least three
// rounds.
std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds);

// Names beside times, and ratios to the first frame: [{technique, ms, ratio, cpu_ms, ...}].
nlohmann::ordered_json time_rows(const std::vector<TimedFrame>& frames,
                                 const std::vector<FrameTimes>& times);

}  // namespace lamina::study
