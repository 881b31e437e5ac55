// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.h"
#include "image/difference.h"
#include "study/data_store.h"
#include "study/run_list.h"

namespace lamina::study {

// The folder of a study, with the paths of its files.
struct StudyFolder {
    explicit StudyFolder(std::filesystem::path folder) : path(std::move(folder)) {}

    // Names of the files that a study replaces, and of the folders that it adds files to.
    static std::vector<std::string> results() {
        return {"results.csv", "results.json", "report.html"};
    }
    static std::vector<std::string> folders() { return {"references", "pictures"}; }
    static std::vector<std::string> names();  // results() and folders()

    std::filesystem::path path;
    OwnFiles own() const { return OwnFiles(path, "study"); }
    std::filesystem::path run_list() const { return path / "runs.json"; }
    std::filesystem::path references() const { return path / "references"; }
    std::filesystem::path pictures() const { return path / "pictures"; }
    std::filesystem::path picture(const std::string& run) const {
        return pictures() / (run + ".exr");
    }
    std::filesystem::path journal(int shard, int shards) const;
    std::vector<std::filesystem::path> journals() const;  // existing ones, by name
    // Returns all existing files that are not results: run list, journals, references, pictures.
    std::vector<std::filesystem::path> kept() const;
    void make() const;  // makes the folder and its subfolders; throws Error
};

// Returns what is wrong with a record that lamina did not write. `error`: thrown when it was read.
std::string strange_record(const std::exception& error);

// The file with the records of a study, one line of JSON each. A record is on disk before append()
// returns, so that a crash loses at most the record being written.
class Journal {
  public:
    // Opens or makes the file, and removes an incomplete last line. Throws Error, also if another
    // process has the file open.
    explicit Journal(std::filesystem::path path);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    void append(const nlohmann::ordered_json& record);
    // Returns the records that the file had when it was opened.
    const std::vector<nlohmann::json>& found() const { return found_; }

    // Returns all complete records of a journal.
    static std::vector<nlohmann::json> read(const std::filesystem::path& path);

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::vector<nlohmann::json> found_;
};

struct CostAndError {
    double cost = 0, error = 0;  // in any units, the same for all points
};

// Returns for each point whether no other point beats it. A point beats another if it is no larger
// in both numbers and smaller in one.
std::vector<bool> pareto_front(const std::vector<CostAndError>& points);

// The measurements of one run. Times are in ms, errors in 1/255.
struct RunResult {
    std::size_t run = 0;  // index into the list of runs
    std::string failed;   // reason of a failure; the other members are then unset
    std::vector<double> frame_ms, still_ms;
    // Time of facts, choices, set-up and first frame, measured once. Journals of earlier versions
    // lack it.
    std::optional<double> first_ms;
    // Frame time divided by the baseline's: median over the rounds. None if not measured.
    std::optional<double> ratio;
    std::string reference;       // id of the reference
    double reference_error = 0;  // the tracer's estimate of the reference's own error
    ErrorNorms all;
    std::map<std::string, ErrorNorms> channels;
    std::map<std::string, double> stages_ms;
    std::int64_t bytes_gpu = 0, bytes_host = 0;
    std::string renderer;
    bool pareto = false;  // on the Pareto front of its scene's runs, in median frame time and L2

    // Returns true if the error is below ten times the reference's own estimate, so that it says
    // little about the run.
    bool near_reference() const { return all.linf < 10 * reference_error; }
};

// The results in a folder's journals: one for each finished run, in the order of the list.
struct StudyResults {
    RunList list;
    std::vector<RunResult> runs;
    nlohmann::ordered_json environment;
};

// Reads the results. Throws Error if the folder has no study, or if its files were changed.
StudyResults read_results(const StudyFolder& folder);

// Returns the contents of results.csv: one row for each run.
std::string csv_of(const StudyResults& results);

}  // namespace lamina::study
