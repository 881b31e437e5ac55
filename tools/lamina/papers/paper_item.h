// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::papers {

// One table or figure of a paper: `reproduce`, or `draw` if it needs OpenGL. Either writes its CSV
// and plots, some of `files`, into `folder`, which exists, and returns {values, paper, verdict,
// note,
// ...} (see Findings::result). If there are panels (papers/panels.h) or plots, `values` has them
// and a `caption`. Errors are in units of 1/255. A `Stage`, made from the capabilities of the
// current context, holds what the items that draw share.
template <typename Stage>
struct PaperItem {
    std::string name;
    std::vector<std::string> files;
    nlohmann::ordered_json (*reproduce)(const std::filesystem::path& folder) = nullptr;
    nlohmann::ordered_json (*draw)(const std::filesystem::path& folder, Stage& stage) = nullptr;
};

}  // namespace lamina::papers
