// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plan/plan.h"

namespace lamina {

// What a render cost and what happened on the way (--stats).
struct RenderStats {
    // From the start of reading the scene to the written picture, without the frames of --frames.
    double first_picture_ms = 0;
    std::vector<double> frames_ms;
    std::map<std::string, double> stages_ms;
    int samples = 0;              // slabs
    std::uint64_t fragments = 0;  // of the scene's own frame
    std::int64_t tets_drawn = 0;  // that cover the centre of a pixel in that frame
    std::int64_t bytes_gpu = 0;
    std::int64_t bytes_host = 0;                  // of the native engine, beside the data itself
    std::string renderer;                         // what drew
    std::string context;                          // with its threads
    bool on_tiles = false;                        // the native engine drew
    std::optional<double> error_estimate;         // trace
    std::optional<double> mesh_error;             // of a mesh made from a volume, of the range
    std::optional<nlohmann::ordered_json> ranks;  // what each rank of several took
    std::map<std::string, std::int64_t> counts;   // what was clamped, dropped, ...
};

// Raises each of `largest` to what `counts` has of its name.
void keep_largest(const std::map<std::string, std::int64_t>& counts,
                  std::map<std::string, std::int64_t>& largest);

nlohmann::ordered_json to_json(const RenderStats& stats, const Plan& plan);

}  // namespace lamina
