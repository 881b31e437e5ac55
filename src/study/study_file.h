// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lamina/scene.h"
#include "scene_files/keys.h"

namespace lamina::study {

// Keys of a scene with the values that a run gives them. The value null removes the key.
using Settings = std::vector<std::pair<std::string, nlohmann::json>>;

const nlohmann::json* find_setting(const Settings& settings, const std::string& key);

constexpr std::uint64_t most_runs = 100000;  // runs of a study

// A key with the values that it takes.
struct SweepAxis {
    std::string key;
    std::vector<nlohmann::json> values;  // at least one
};

// All combinations of the values of several axes.
struct SweepGrid {
    std::vector<SweepAxis> axes;  // at least one

    std::uint64_t count() const;               // saturates at 2^63 - 1
    Settings settings(std::uint64_t n) const;  // the n-th; the last axis changes first
};

// Reads `sweep` of a study file: a grid {key: values, ...} or a list of grids. Values are a list,
// one value, or {"factorizations": N, "levels": k}. Throws KeyError, also if there are more than
// most_runs factorizations.
std::vector<SweepGrid> read_sweep(JsonReader& study);

// Returns all ordered lists of at most `levels` factors >= 2 with the product `of` >= 2, short
// lists first. If there are more than most_runs, it stops soon after that number.
std::vector<std::vector<int>> factorizations(int of, int levels);

// Returns a value for a name or a cell of a table: a list of whole numbers as "32x32", words
// without quotes, everything else as JSON.
std::string setting_text(const nlohmann::json& value);

// The contents of a study file (docs/study.md). The sweep is not expanded.
struct StudyFile {
    struct SceneEntry {
        std::string name;
        std::filesystem::path file;
        nlohmann::json document;  // the scene file with `base` and the entry's own `set` applied
        Settings own;             // `set`
    };
    // A rule that leaves out the runs for which each axis has one of these values.
    struct Drop {
        std::vector<SweepAxis> where;  // "scene" or a swept key, each with the values that match
        std::string because;
    };

    // A scene that is not drawn, because it names ${LAMINA_DATA}, which is not set.
    struct Skipped {
        std::string name;
        std::string because;
    };

    std::filesystem::path file;
    std::string title;
    std::vector<SceneEntry> scenes;
    std::vector<Skipped> skipped;
    Settings base;                 // keys that all runs have, as the file gives them
    std::string context = "auto";  // --context of runs whose settings do not say one
    std::vector<SweepGrid> sweep;
    std::vector<Drop> drops;
    std::optional<Settings> baseline;  // settings of one run of each scene; none: its first run
    std::optional<TraceOf> reference;  // traced data; none: those that a run draws
    int rounds = 3, frames = 3;        // frames: in each round turned, and as many not turned
};

// Loads a study file. Throws Error, which names the key.
StudyFile load_study(const std::filesystem::path& file);

// Sets keys to their values; null removes a key.
void apply_settings(const Settings& settings, nlohmann::json& document);

}  // namespace lamina::study
