// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "papers/findings.h"
#include "papers/kraus_subject.h"
#include "plan/capabilities.h"

namespace lamina::papers {

// Sizes of pictures and generated meshes; tests use smaller ones.
struct KrausSizes {
    int width = 640, height = 480;              // of pictures and of measurements in them
    int timed_width = 800, timed_height = 600;  // as in the paper
    std::int32_t graded_cells = 24, graded_layers = 40;
    std::int32_t box_cells = 31;  // along an edge of the box that replaces data sets: 178,746 tets
    // For Table 2: 20,250 tets, then as many as the paper's heat sink, cylinder and X38 have.
    std::vector<std::int32_t> timed_box_cells{15, 27, 47, 69};
    int rounds = 3;
};

// The context that is current, meshes with their traced pictures, and pre-integration tables, for
// all items of the paper.
class KrausStage {
  public:
    // Meshes of data sets are read from `data`, unless it is empty or lacks them.
    explicit KrausStage(const Capabilities& capabilities, KrausSizes sizes = {},
                        std::filesystem::path data = data_folder());

    const Capabilities& capabilities() const { return capabilities_; }
    const KrausSizes& sizes() const { return sizes_; }
    const std::shared_ptr<TableCache>& tables() const { return tables_; }

    bool has(const std::string& data_set) const;
    // A subject of kraus_view(), made when it is first needed. Where a data set is missing, "box"
    // replaces it. "graded" has a bump and "plate" has none; the edge ratio of both is 1e4.
    KrausSubject& subject(const std::string& name);
    // All subjects whose data exist, or "box" where no data set does.
    std::vector<KrausSubject*> subjects();

    static std::filesystem::path data_folder();  // LAMINA_DATA, or empty

  private:
    KrausSubject make(const std::string& name) const;
    Capabilities capabilities_;
    KrausSizes sizes_;
    std::filesystem::path data_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    std::map<std::string, std::unique_ptr<KrausSubject>> subjects_;
};

// Data sets that an item needs, and what replaces those that are missing, in words.
struct DataNeeds {
    std::vector<std::string> data_sets;
    std::string instead;
};

// Returns Findings::result(values, printed, more). If a data set is missing, the note says so
// first, and nothing that the paper says can be tested.
nlohmann::ordered_json result_with_data(Findings findings, nlohmann::ordered_json values,
                                        nlohmann::ordered_json printed, const std::string& more,
                                        const KrausStage& stage, const DataNeeds& needs);

}  // namespace lamina::papers
