// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace lamina {

// The cost of a picture, and what was counted on the way (docs/stats.md has the names).
struct FrameStatistics {
    std::string drawn_by;                     // the renderer, and its threads where they are known
    double draw_ms = 0;                       // all of draw()
    std::map<std::string, double> stages_ms;  // what took how long, when it was last done
    std::int64_t fragments = 0;  // segments of rays that were composited; 0: not counted
    std::int64_t bytes = 0;      // of memory beside the data itself
    double trace_error = 0;      // in 1/255, of a traced picture: as the tracer estimates it

    std::string renderer;              // without its threads
    bool native = false;               // the native engine drew
    int slabs = 0;                     // of method slice
    std::int64_t tets_drawn = 0;       // that cover the centre of a pixel
    std::int64_t bytes_gpu = 0;        // of OpenGL memory, with the data
    std::optional<double> mesh_error;  // of a mesh made from a volume, as a share of its range
    std::map<std::string, std::int64_t> counts;  // what was clamped, skipped, dropped, ...
};

}  // namespace lamina
