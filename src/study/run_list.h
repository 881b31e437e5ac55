// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study_file.h"

namespace lamina::study {

// One setting of the swept keys for one scene.
struct StudyRun {
    // Hash of the scene, the settings, the other keys of the scene file, and the reference.
    std::string id;
    std::string name;  // the settings, for people
    std::size_t scene = 0;
    Settings settings;  // values of the swept keys
};

// Returns settings as a name for people: "fixed8, 32x32".
std::string run_name(const Settings& settings);

// The runs of a study, with all that is known of them before they are drawn.
struct RunList {
    struct Dropped {
        std::string because;
        std::uint64_t runs = 0;
    };

    // A volume, a mesh or a colour map that the runs draw.
    struct Data {
        std::string name;     // path or formula
        std::string content;  // hash of its contents; empty if it could not be read
    };

    std::string title;
    std::vector<std::string> scenes;
    Settings base;                       // keys that the study sets for all runs
    std::vector<Settings> own;           // keys that it sets for one scene's runs, scene by scene
    std::vector<std::string> swept;      // keys
    std::vector<StudyRun> runs;          // scene by scene
    std::vector<std::size_t> baselines;  // for each scene an index into runs
    std::vector<Dropped> dropped;
    int rounds = 0, frames = 0;
    std::vector<Data> data;  // in the order of the runs

    // Returns a hash of everything that decides what is measured, except for the contents of the
    // data.
    std::string id() const;
};

constexpr std::uint64_t most_runs_unasked = 10000;

// Returns the number of runs of the file's sweep, before any is dropped.
std::uint64_t run_count(const StudyFile& file);

// Expands the sweep. Throws Error if no run is left, if the baseline does not name one run of each
// scene, or if there are more than most_runs.
RunList list_runs(const StudyFile& file);

// Returns the scene file of a run, with its settings applied.
nlohmann::json document_of(const StudyRun& run, const StudyFile& file);
// Returns the context of a run: auto, osmesa, egl or cpu.
std::string context_of(const StudyRun& run, const StudyFile& file);

// Compares the data of two lists of one study. Throws Error if both lists know the contents of a
// data set and these differ. Contents that only `other` knows are added to `list`. `list_of`,
// `other_of`: where the lists come from, for the message.
void match_data(RunList& list, const std::string& list_of, const RunList& other,
                const std::string& other_of);

// Returns {key: value, ...} in the order of the settings.
nlohmann::ordered_json settings_json(const Settings& settings);

nlohmann::ordered_json to_json(const RunList& list);
RunList run_list_from(const nlohmann::json& document, const std::filesystem::path& file);

}  // namespace lamina::study
