// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study_folder.h"
#include "study/study_results.h"

namespace lamina::study {

// Returns the results of a study as sentences. Every number in them was measured.
std::vector<std::string> study_findings(const StudyResults& results);

// Returns the contents of results.json (docs/study.md): all that the page of a study shows, except
// for its pictures.
nlohmann::ordered_json report_of(const StudyResults& results);

// Adds pictures of runs, references and differences, as data URIs.
void add_pictures(const StudyFolder& folder, nlohmann::ordered_json& report);

}  // namespace lamina::study
