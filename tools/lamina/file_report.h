// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/value_statistics.h"

namespace lamina {

inline nlohmann::ordered_json json_vector(const glm::dvec3& vector) {
    return nlohmann::ordered_json::array({vector.x, vector.y, vector.z});
}

// Adds the keys "percentiles" {"0.1": value, ...} and "histogram" {edges, counts}; both are null if
// there is no finite value.
void add_statistics(const ValueStatistics& statistics, nlohmann::ordered_json& info);

// Return the values of these two keys, which must not be null, as text; a histogram has at most 16
// rows.
std::string percentiles_text(const nlohmann::ordered_json& percentiles);
// Lists at most 16 labels with their names and shares.
std::string labels_text(const nlohmann::ordered_json& labels);
std::string histogram_text(const nlohmann::ordered_json& histogram);

// Returns `above` on white, and under it the picture below(width). `width` is that of `above`, but
// at least 480 pixels.
CodedImage above_one_another(const CodedImage& above, const std::function<CodedImage(int)>& below);

// Returns the row of a table for the lists "arrays", "channels", "times" and "levels" of a report:
// what there is to choose from, and how. Empty if there is nothing to choose.
std::string choice_text(const std::string& key, const nlohmann::ordered_json& list,
                        const std::string& kind);

// Reports of `lamina info FILE` (docs/info.md), and the picture that it writes to `png` unless
// that is empty. Throw Error.
nlohmann::ordered_json report_on_volume(const std::string& file, const std::string& png,
                                        const VolumeRequest& request);
nlohmann::ordered_json report_on_mesh(const std::string& file, const std::string& png,
                                      std::int64_t time);

}  // namespace lamina
