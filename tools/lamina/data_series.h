// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "volume_files/numbered_files.h"

namespace lamina {

// The steps that --time names: first, first + step, ... up to last.
struct TimeRange {
    std::int64_t first = 0, last = 0, step = 1;

    std::vector<std::int64_t> steps() const;
};

// Reads "FIRST:LAST" or "FIRST:LAST:STEP": whole numbers from 0, LAST not below FIRST, STEP from 1,
// at most 100000 steps. Throws UsageError.
TimeRange time_range(const std::string& text);

// Data of a scene that change with time: files whose names differ in a number, as in
// "head_%04d.nrrd"; the steps of a .pvd; or the time axis of a volume's file.
class DataSeries {
  public:
    // `file`: scene, data file, or pattern of data files on the command line. Throws UsageError if
    // it has a '%' but is no pattern.
    DataSeries(std::string file, const TimeRange& range);

    // Returns the file that the scene of the first step is read from; if `file` is a pattern, the
    // pattern's first file.
    const std::string& first_file() const { return first_file_; }
    // Replaces the patterns in a scene's document by the first step's files, or sets its time.
    void begin(nlohmann::json& document);

    const std::vector<std::int64_t>& steps() const { return steps_; }
    // Returns the scene with the data of another step.
    Scene at(Scene scene, std::int64_t step) const;
    // Returns the files that only this step reads.
    std::vector<std::filesystem::path> files_of_step(const Scene& scene, std::int64_t step) const;
    // Throws Error if a step of the scene is missing, UsageError if its data have no steps.
    void check(const Scene& scene) const;

  private:
    std::optional<FilePattern> take(std::string& path, const std::string& what) const;

    std::vector<std::int64_t> steps_;
    std::string first_file_;
    // Patterns of the command line's file and of the scene's "volume" and "mesh"; none if fixed.
    std::optional<FilePattern> file_, volume_, mesh_;
};

}  // namespace lamina
