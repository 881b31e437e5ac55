// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "image/difference.h"
#include "study/reference_store.h"
#include "study/run_list.h"
#include "study/study_folder.h"

namespace lamina::study {

struct CostAndError {
    double cost = 0, error = 0;  // in any units, the same for all points
};

// Returns for each point whether no other point beats it. A point beats another if it is no larger
// in both numbers and smaller in one.
std::vector<bool> pareto_front(const std::vector<CostAndError>& points);

// The measurements of one run. Times in ms, errors in 1/255.
struct RunResult {
    std::size_t run = 0;  // index into the list of runs
    std::string failed;   // reason of a failure; then nothing else is set
    std::vector<double> frame_ms, still_ms;
    // Facts, choice, set-up and first frame, measured once. Journals of earlier versions lack it.
    std::optional<double> first_ms;
    // Frame time over the baseline's: the median of the rounds' ratios.
    std::optional<double> ratio;
    std::string reference;       // id of the reference
    double reference_error = 0;  // the reference's own estimate
    ErrorNorms all;
    std::map<std::string, ErrorNorms> channels;
    std::map<std::string, double> stages_ms;
    std::int64_t bytes_gpu = 0, bytes_host = 0;
    std::string renderer;
    bool pareto = false;  // on the Pareto front of its scene's runs, in median frame time and L2

    // Returns true if the error is below ten times the reference's own estimate. Then it says
    // little about the run.
    bool near_reference() const { return all.linf < 10 * reference_error; }
};

// The results in a folder's journals: one for every finished run, in the order of the list.
struct StudyResults {
    RunList list;
    std::vector<RunResult> runs;
    nlohmann::ordered_json environment;
};

// Reads the results. Throws Error if the folder holds no study, or one whose files were changed.
StudyResults read_results(const StudyFolder& folder);

// Returns the contents of results.csv: one row for each run.
std::string csv_of(const StudyResults& results);

}  // namespace lamina::study
