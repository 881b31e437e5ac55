// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study_data.h"
#include "study/study_file.h"

namespace lamina::study {

// One configuration of one scene.
struct StudyRun {
    std::string id;    // of scene, settings, all else that the scene file says, and the reference
    std::string name;  // of the settings, for people
    std::size_t scene = 0;
    Settings settings;  // what is swept
};

// Settings as a name for people: "fixed8, 32x32".
std::string run_name(const Settings& settings);

// What a study runs.
struct RunList {
    struct Dropped {
        std::string because;
        std::uint64_t runs = 0;
    };

    // A volume, a mesh or a colour map that runs draw.
    struct Data {
        std::string name;     // its path, or its formula
        std::string content;  // names what it holds; empty: it could not be read
    };

    std::string title;
    std::vector<std::string> scenes;
    std::vector<std::string> swept;      // keys
    std::vector<StudyRun> runs;          // scene by scene
    std::vector<std::size_t> baselines;  // of each scene, into runs
    std::vector<Dropped> dropped;
    int rounds = 0, frames = 0;
    std::vector<Data> data;  // in the order of the runs

    // A hash of all that decides what is measured, but for what the data hold.
    std::string id() const;
};

constexpr std::uint64_t most_runs_unasked = 10000;

// How many runs the file's sweep has, before any is dropped.
std::uint64_t run_count(const StudyFile& file);

// Expands the sweep. Throws Error where nothing is left, a baseline is not one run of each scene,
// or there are more than most_runs.
RunList list_runs(const StudyFile& file);

nlohmann::json document_of(const StudyRun& run, const StudyFile& file);
// auto, osmesa, egl or cpu.
std::string context_of(const StudyRun& run, const StudyFile& file);

// The scene of a run. Throws KeyError for what no run can measure: method "trace", a reference that
// the scene does not have.
Scene scene_of(const StudyRun& run, const StudyFile& file);
TraceOf reference_of(const Scene& scene, const StudyFile& file);

// Reads every run's scene, looks for its files, and throws Error where one is missing, a key is
// unknown, or no run of a scene can be drawn. Whatever is wrong with single runs is found when
// these are run. Returns what the runs draw, each once.
std::vector<StudyData> check_runs(const RunList& list, const StudyFile& file);

// Where two lists of one study both know what data hold, it must be the same, else Error; what only
// one of them knows `list` knows then. `list_of`, `other_of`: where they come from, for the
// message.
void match_data(RunList& list, const std::string& list_of, const RunList& other,
                const std::string& other_of);

nlohmann::ordered_json to_json(const RunList& list);
RunList run_list_from(const nlohmann::json& document, const std::filesystem::path& file);

}  // namespace lamina::study
