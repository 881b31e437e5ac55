// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "study/sweep.h"

namespace lamina::study {

// A study as its file says (docs/study.md), nothing expanded yet.
struct StudyFile {
    struct SceneEntry {
        std::string name;
        std::filesystem::path file;
        nlohmann::json document;  // of the file, with `base` and the entry's own `set`
    };
    // Runs with all of these values are left out.
    struct Drop {
        std::vector<SweepAxis> where;  // "scene", or a swept key: any of the values
        std::string because;
    };

    std::filesystem::path file;
    std::string title;
    std::vector<SceneEntry> scenes;
    std::string context = "auto";  // where no axis says otherwise
    std::vector<SweepGrid> sweep;
    std::vector<Drop> drops;
    std::optional<Settings> baseline;  // of one run of each scene; none: its first run
    std::optional<TraceOf> reference;  // none: of what a run draws
    int rounds = 3, frames = 3;        // frames of a round: as many with a still camera
};

// Throws Error, naming the key.
StudyFile load_study(const std::filesystem::path& file);

// Gives the keys their values; null takes a key away.
void apply_settings(const Settings& settings, nlohmann::json& document);

}  // namespace lamina::study
