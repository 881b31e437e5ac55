// SPDX-License-Identifier: Apache-2.0
#include "study/study_folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/output_file.h"

namespace lamina::study {

std::vector<std::string> StudyFolder::names() {
    std::vector<std::string> all = results();
    for (const std::string& folder : folders()) all.push_back(folder);
    return all;
}

std::filesystem::path StudyFolder::journal(int shard, int shards) const {
    return path / fmt::format("journal-{}-of-{}.jsonl", shard, shards);
}

std::vector<std::filesystem::path> StudyFolder::journals() const {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("journal-") && name.ends_with(".jsonl")) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::filesystem::path> StudyFolder::kept() const {
    std::vector<std::filesystem::path> found = journals();
    found.push_back(run_list());
    for (const std::string& folder : folders()) {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(path / folder, error))
            found.push_back(entry.path());
    }
    return found;
}

void StudyFolder::make() const {
    own().add(folders());
    for (const auto& folder : {path, references(), pictures()}) make_folder(folder);
}

}  // namespace lamina::study
