// SPDX-License-Identifier: Apache-2.0
// Reproduces tables and figures of LaMar, "On Issues of Precision for Hardware Texture-based Volume
// Visualization", 2004.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "papers/paper_item.h"

namespace lamina::papers {

class LamarStage;

using LamarItem = PaperItem<LamarStage>;

// The items in the order of the paper, followed by items on questions that it leaves open.
const std::vector<LamarItem>& lamar_items();

nlohmann::ordered_json reproduce_table1(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure4(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure5(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure9(const std::filesystem::path& folder);

// Compares front to back with back to front (section 4.2): random rays of small to large optical
// depth, and equal fragments.
nlohmann::ordered_json reproduce_order(const std::filesystem::path& folder);

// Section 5: the period and the smallest opacity, increments, colour, thin structures, boundaries.
nlohmann::ordered_json reproduce_dithering(const std::filesystem::path& folder);

// The paper's pictures. Figure 1 needs the bonsai of LAMINA_DATA; without it nothing can be tested.
// The Richtmyer-Meshkov data are not available, so mixing_scene.h replaces them.
nlohmann::ordered_json draw_figure1(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_table4(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure6(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure10(const std::filesystem::path& folder, LamarStage& stage);

// Both compositing orders on the mixing liquids.
nlohmann::ordered_json draw_order_mixing(const std::filesystem::path& folder, LamarStage& stage);

// Run times, which the paper does not give.
nlohmann::ordered_json draw_times(const std::filesystem::path& folder, LamarStage& stage);

}  // namespace lamina::papers
