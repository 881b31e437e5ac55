// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lamina {

// The cost of the last picture of a session.
struct FrameStatistics {
    std::string drawn_by;                     // the renderer, and its threads where they are known
    double draw_ms = 0;                       // all of draw()
    std::map<std::string, double> stages_ms;  // what took how long, when it was last done
    std::int64_t fragments = 0;  // segments of rays that were composited; 0: not counted
    std::int64_t bytes = 0;      // of memory beside the data itself
    double trace_error = 0;      // in 1/255, of a traced picture: as the tracer estimates it
};

}  // namespace lamina
