// SPDX-License-Identifier: Apache-2.0
// The part of `lamina info` about the values of volumes and meshes.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "image/coded_image.h"
#include "volume/value_statistics.h"

namespace lamina {

// Adds the keys "percentiles" {"0.1": value, ...} and "histogram" {edges, counts}: null if there
// is no finite value.
void add_statistics(const ValueStatistics& statistics, nlohmann::ordered_json& info);

// Return the values of the two keys, which must not be null, as lines for people: at most 16
// intervals of the histogram.
std::string percentiles_text(const nlohmann::ordered_json& percentiles);
std::string histogram_text(const nlohmann::ordered_json& histogram);

// Returns `above` on white, and under it the picture that `below` makes for its width, at least 480
// pixels.
CodedImage above_one_another(const CodedImage& above, const std::function<CodedImage(int)>& below);

}  // namespace lamina
