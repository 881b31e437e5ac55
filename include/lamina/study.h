// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Outcome of a finished study. Its results are in its folder (docs/study.md, "What it writes").
struct StudyOutcome {
    std::size_t runs = 0;  // finished runs, including failed ones
    std::vector<std::string> findings, failures;
    std::vector<std::string> messages;  // about repeated work, and how long the rest takes
};

// Draws and measures all runs of a study file (docs/study.md) and writes results.csv, results.json,
// report.html and pictures into `folder`, which must be empty or not exist yet; with `resume` it
// may hold results of this study. Throws Error, and Interrupted once a stop is requested; finished
// runs are kept.
LAMINA_API StudyOutcome run_study(const std::filesystem::path& study,
                                  const std::filesystem::path& folder, bool resume = false,
                                  std::stop_token stop = {}, const ProgressCallback& progress = {});

}  // namespace lamina
