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

// The files that write_ramp_figure() writes: NAME.csv and NAME.svg.
std::vector<std::string> ramp_figure_files(const std::string& name);

// Writes a figure of ramps into `folder`; `curves[0]` is the exact one. NAME.csv has one column for
// each curve, and NAME.svg is their plot. Returns {files, curves: {name: [...]}, errors: {name:
// {linf, l1, l2}}, panels}, in units of 1/255. The panels are one grey strip for each curve, as in
// the paper.
nlohmann::ordered_json write_ramp_figure(const std::filesystem::path& folder,
                                         const std::string& name, const std::string& title,
                                         const std::vector<NamedCurve>& curves);

}  // namespace lamina::papers
