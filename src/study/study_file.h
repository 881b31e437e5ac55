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

// A study as its file says (docs/study.md). Nothing is expanded yet.
struct StudyFile {
    struct SceneEntry {
        std::string name;
        std::filesystem::path file;
        nlohmann::json document;  // the scene file with `base` and the entry's own `set` applied
        Settings own;             // `set`
    };
    // Runs are left out where all axes have one of these values.
    struct Drop {
        std::vector<SweepAxis> where;  // "scene" or a swept key, each with the values that match
        std::string because;
    };

    // A scene that is not drawn, because ${LAMINA_DATA}, which it names, is not set.
    struct Skipped {
        std::string name;
        std::string because;
    };

    std::filesystem::path file;
    std::string title;
    std::vector<SceneEntry> scenes;
    std::vector<Skipped> skipped;
    Settings base;                 // keys that all runs have, as the file gives them
    std::string context = "auto";  // used where no axis sets it
    std::vector<SweepGrid> sweep;
    std::vector<Drop> drops;
    std::optional<Settings> baseline;  // settings of one run of each scene; none: its first run
    std::optional<TraceOf> reference;  // none: the reference for what a run draws
    int rounds = 3, frames = 3;  // frames in a round; as many again are drawn with a still camera
};

// Loads a study. Throws Error, which names the key.
StudyFile load_study(const std::filesystem::path& file);

// Sets keys to their values; null removes a key.
void apply_settings(const Settings& settings, nlohmann::json& document);

}  // namespace lamina::study
