// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/run_list.h"
#include "study/study_folder.h"

namespace lamina::study {

struct StudySummary {
    std::size_t runs = 0, wanted = 0;  // runs that are finished, and runs of the whole study
    std::vector<std::string> findings, failures;
};

// Writes runs.json.
void write_run_list(const StudyFolder& folder, const RunList& list);

// Writes results.csv, results.json and report.html from the folder's journals. Throws Error.
StudySummary write_study_output(const StudyFolder& folder);

}  // namespace lamina::study
