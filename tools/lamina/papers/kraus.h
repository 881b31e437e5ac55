// SPDX-License-Identifier: Apache-2.0
// Reproduces tables and figures of Kraus, Qiao, Ebert, "Projecting Tetrahedra without Rendering
// Artifacts", 2004.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "papers/paper_item.h"

namespace lamina::papers {

class KrausStage;
using KrausItem = PaperItem<KrausStage>;

// The items in the order of the paper, followed by items on questions that it leaves open. Data
// sets come from LAMINA_DATA. Without it generated meshes are used instead, and nothing that the
// paper says can be tested.
const std::vector<KrausItem>& kraus_items();

// Pairs of pictures with insets and signed differences, and their errors against the tracer.
nlohmann::ordered_json draw_kraus_figure7(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure8(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure9(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure10(const std::filesystem::path& folder, KrausStage& stage);

// Times of the enhancements, one after the other, and of several mesh sizes.
nlohmann::ordered_json draw_kraus_table1(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_table2(const std::filesystem::path& folder, KrausStage& stage);

// Every remedy switched off in turn, on all meshes.
nlohmann::ordered_json draw_kraus_artifacts(const std::filesystem::path& folder, KrausStage& stage);

// The paper's future work (section 6): compares numerical with analytic pre-integration, and shows
// wrong orders.
nlohmann::ordered_json draw_kraus_preintegration(const std::filesystem::path& folder,
                                                 KrausStage& stage);
nlohmann::ordered_json draw_kraus_orders(const std::filesystem::path& folder, KrausStage& stage);

}  // namespace lamina::papers
