// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "input_parts.h"
#include "json_paths.h"
#include "optics/segment_integral.h"
#include "runs.h"
#include "scene_files/scene_keys.h"
#include "violation.h"

namespace lamina::fuzz {
namespace {

void check_integral(const IntegrationCase& segment) {
    const SegmentIntegral found =
        integrate_segment(segment.transfer_function, segment.front, segment.back, segment.length);
    require(found.alpha >= 0 && found.alpha <= 1, "alpha is no opacity");
    for (int channel = 0; channel < 3; ++channel) {
        require_finite(found.color[channel], "a colour");
        require(found.color[channel] >= 0, "a colour is negative");
    }
}

}  // namespace

// Reads and integrates cases. The second part of the input is the colour map that they may name,
// map.json.
void run_integrate(std::string_view input) {
    const InputParts parts = parts_of(input);
    const auto file = scratch_file("cases.json", parts.first);
    scratch_file("map.json", parts.second);
    may_fail([&] {
        const nlohmann::json cases = load_json(file);
        if (!cases.is_array() || !paths_stay_in_folder(cases)) return;
        for (const nlohmann::json& each : cases) {
            may_fail([&] { check_integral(read_integration_case(JsonReader(each, file))); });
        }
    });
}

}  // namespace lamina::fuzz
