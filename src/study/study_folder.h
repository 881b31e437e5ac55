// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.h"

namespace lamina::study {

// The folder of a study and the files in it.
struct StudyFolder {
    explicit StudyFolder(std::filesystem::path folder) : path(std::move(folder)) {}

    // The files that a study replaces, and the folders that it adds files to.
    static std::vector<std::string> results() {
        return {"results.csv", "results.json", "report.html"};
    }
    static std::vector<std::string> folders() { return {"references", "pictures"}; }
    static std::vector<std::string> names();  // both

    std::filesystem::path path;
    OwnFiles own() const { return OwnFiles(path, "study"); }
    std::filesystem::path run_list() const { return path / "runs.json"; }
    std::filesystem::path references() const { return path / "references"; }
    std::filesystem::path pictures() const { return path / "pictures"; }
    std::filesystem::path picture(const std::string& run) const {
        return pictures() / (run + ".exr");
    }
    std::filesystem::path journal(int shard, int shards) const;
    std::vector<std::filesystem::path> journals() const;  // those that exist, by name
    // All existing files that are not results: run list, journals, references, pictures.
    std::vector<std::filesystem::path> kept() const;
    void make() const;  // makes the folder and its subfolders; throws Error
};

}  // namespace lamina::study
