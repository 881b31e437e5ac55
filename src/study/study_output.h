// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/data_store.h"
#include "study/run_list.h"
#include "study/study_results.h"

namespace lamina::study {

// Returns the contents of results.json (docs/study.md): all that the page of a study shows but the
// pictures.
nlohmann::ordered_json report_of(const StudyResults& results);

// Copies the journals, references and pictures of the shards of one study into a folder. Throws
// Error if they belong to different studies or drew different data, if two are the same shard, or
// if the folder holds another study. `say`: called with messages about damaged references.
void merge_studies(const std::vector<std::filesystem::path>& from, const StudyFolder& into,
                   const ReferenceStore::Say& say);

struct StudySummary {
    std::size_t runs = 0, wanted = 0;  // finished runs, and runs of the study in all
    std::vector<std::string> findings, failures;
};

void write_run_list(const StudyFolder& folder, const RunList& list);

// Writes results.csv, results.json and report.html from the folder's journals. Throws Error.
StudySummary write_study_output(const StudyFolder& folder);

}  // namespace lamina::study
