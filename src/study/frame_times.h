// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::study {

// A kind of frame to time. `draw` draws one frame and returns when it is complete; `warm_up`
// prepares it.
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

// Times frames in rounds A B C, A B C, ..., so that a slow phase of the machine affects all of
// them. There must be at least three rounds.
std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds);

// Returns rows of names, times and ratios to the first frame: [{technique, ms, ratio, cpu_ms,
// ...}].
nlohmann::ordered_json time_rows(const std::vector<TimedFrame>& frames,
                                 const std::vector<FrameTimes>& times);

// Returns {machine, processors, date}: the processor's name, how many of them this process may run
// on, and today (UTC).
nlohmann::ordered_json describe_machine();

}  // namespace lamina::study
