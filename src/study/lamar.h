// SPDX-License-Identifier: Apache-2.0
// Tables and figures of LaMar, "On Issues of Precision for Hardware Texture-based Volume
// Visualization", 2004, made again.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina {

// One table or figure. `reproduce` writes its CSV and pictures into `folder`, which exists, and
// returns {values, paper, agrees, note, ...} (see Findings::result). Errors in units of 1/255.
struct LamarItem {
    std::string name;
    nlohmann::ordered_json (*reproduce)(const std::filesystem::path& folder);
};

// In the order of the paper; behind them `order` and `dithering`, which answer questions that it
// leaves open.
const std::vector<LamarItem>& lamar_items();

nlohmann::ordered_json reproduce_table1(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure4(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure5(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure9(const std::filesystem::path& folder);

// Front to back against back to front (section 4.2): random rays, faint to dense, and equal
// fragments.
nlohmann::ordered_json reproduce_order(const std::filesystem::path& folder);

// Section 5: period against the smallest opacity, increments, colour, thin structures, boundaries.
nlohmann::ordered_json reproduce_dithering(const std::filesystem::path& folder);

}  // namespace lamina
