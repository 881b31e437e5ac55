// SPDX-License-Identifier: Apache-2.0
// Tables and figures of LaMar, "On Issues of Precision for Hardware Texture-based Volume
// Visualization", 2004, made again.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "papers/paper_item.h"

namespace lamina::papers {

class LamarStage;

using LamarItem = PaperItem<LamarStage>;

// In the order of the paper; behind them what answers questions that it leaves open.
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

// What the paper draws. Figure 1 needs the bonsai of LAMINA_DATA; without, its `agrees` is null.
// The Richtmyer-Meshkov data are not to be had: mixing_scene.h stands in.
nlohmann::ordered_json draw_figure1(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_table4(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure6(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure10(const std::filesystem::path& folder, LamarStage& stage);

// Both orders on the mixing liquids.
nlohmann::ordered_json draw_order_mixing(const std::filesystem::path& folder, LamarStage& stage);

// Run times, which the paper does not give.
nlohmann::ordered_json draw_times(const std::filesystem::path& folder, LamarStage& stage);

}  // namespace lamina::papers
