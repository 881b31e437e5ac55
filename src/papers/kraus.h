// SPDX-License-Identifier: Apache-2.0
// Tables and figures of Kraus, Qiao, Ebert, "Projecting Tetrahedra without Rendering Artifacts",
// 2004, made again.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "papers/paper_item.h"

namespace lamina::papers {

class KrausStage;
using KrausItem = PaperItem<KrausStage>;

// In the order of the paper; behind them what answers questions that it leaves open. Data sets come
// from LAMINA_DATA; without, generated meshes stand in, and `agrees` is null.
const std::vector<KrausItem>& kraus_items();

// Pairs of pictures with insets and signed differences, and their errors against the tracer.
nlohmann::ordered_json draw_kraus_figure7(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure8(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure9(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure10(const std::filesystem::path& folder, KrausStage& stage);

// Times: the enhancements one after the other, and mesh sizes.
nlohmann::ordered_json draw_kraus_table1(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_table2(const std::filesystem::path& folder, KrausStage& stage);

// Every remedy switched off, on all meshes.
nlohmann::ordered_json draw_kraus_artifacts(const std::filesystem::path& folder, KrausStage& stage);

// Section 6, future work: numerical against analytic pre-integration, and wrong orders.
nlohmann::ordered_json draw_kraus_preintegration(const std::filesystem::path& folder,
                                                 KrausStage& stage);
nlohmann::ordered_json draw_kraus_orders(const std::filesystem::path& folder, KrausStage& stage);

}  // namespace lamina::papers
