// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "papers/ramp.h"

namespace lamina::papers {

struct NamedCurve {
    std::string name;
    Curve curve;
};

// NAME.csv, NAME.svg and NAME.png.
std::vector<std::string> ramp_figure_files(const std::string& name);

// Writes a figure of ramps, `curves[0]` being the exact one, into `folder`: NAME.csv (a column a
// curve), NAME.svg (their plot) and NAME.png (a grey strip a curve, as the paper shows them).
// Returns {files, curves: {name: [...]}, errors: {name: {linf, l1, l2}}}, in units of 1/255.
nlohmann::ordered_json write_ramp_figure(const std::filesystem::path& folder,
                                         const std::string& name, const std::string& title,
                                         const std::vector<NamedCurve>& curves);

}  // namespace lamina::papers
