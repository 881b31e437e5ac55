// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "study/reference_store.h"
#include "study/run_list.h"
#include "study/study_folder.h"

namespace lamina::study {

// What was measured of one run. Times in ms, errors in 1/255.
struct RunResult {
    std::size_t run = 0;  // into the list
    std::string failed;   // why; then nothing else is known
    std::vector<double> frame_ms, still_ms;
    std::optional<double> ratio;  // of frame times to the baseline's: median of the rounds' ratios
    std::string reference;        // its id
    double reference_error = 0;   // its own estimate
    ErrorNorms all;
    std::map<std::string, ErrorNorms> channels;
    std::map<std::string, double> stages_ms;
    std::int64_t bytes_gpu = 0, bytes_host = 0;
    std::string renderer;
    bool pareto = false;  // of its scene's runs, in median frame time and L2

    // An error below ten times what the reference knows of its own says little of the run.
    bool near_reference() const { return all.linf < 10 * reference_error; }
};

// What the journals of a folder hold of its study: of every finished run one result, in the list's
// order.
struct StudyResults {
    RunList list;
    std::vector<RunResult> runs;
    nlohmann::ordered_json environment;
};

// Throws Error where the folder holds no study, or one that was tampered with.
StudyResults read_results(const StudyFolder& folder);

// results.csv: a row a run.
std::string csv_of(const StudyResults& results);

}  // namespace lamina::study
