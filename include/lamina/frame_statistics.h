// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace lamina {

// Cost of a picture, and what was counted on the way (docs/stats.md has the names).
struct FrameStatistics {
    std::string drawn_by;                     // the renderer, and its threads if they are known
    double draw_ms = 0;                       // all of draw()
    std::map<std::string, double> stages_ms;  // time of each stage when it last ran
    std::int64_t fragments = 0;  // segments of rays that were composited; 0: not counted
    std::int64_t bytes = 0;      // memory beside the data itself
    double trace_error = 0;      // the tracer's estimate of its error, in 1/255

    std::string renderer;         // drawn_by without its threads
    bool native = false;          // the native engine drew
    int slabs = 0;                // number of slabs of the method slice
    std::int64_t tets_drawn = 0;  // tets that cover the centre of a pixel
    std::int64_t bytes_gpu = 0;   // OpenGL memory, with the data
    // Error of a mesh that was made from a volume, as a share of the volume's range of values.
    std::optional<double> mesh_error;
    std::map<std::string, std::int64_t> counts;  // what was clamped, skipped, dropped, ...
};

}  // namespace lamina
