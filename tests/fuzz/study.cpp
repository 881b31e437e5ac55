// SPDX-License-Identifier: Apache-2.0
#include "input_parts.h"
#include "json_paths.h"
#include "runs.h"
#include "scene_files/scene_reader.h"
#include "study/run_list.h"
#include "violation.h"

namespace lamina::fuzz {
namespace {

// Largest number of runs of a study that is listed, and of its runs that are read: reading a run
// takes as long as reading a scene file.
constexpr std::uint64_t most_listed = 500;
constexpr std::size_t most_read = 16;

}  // namespace

void run_study(std::string_view input) {
    const InputParts parts = parts_of(input);
    const auto file = scratch_file("study.json", parts.first);
    scratch_file("scene.json", parts.second);
    may_fail([&] {
        if (!paths_stay_in_folder(load_json(file))) return;
        const study::StudyFile study = study::load_study(file);
        if (study::run_count(study) > most_listed) return;
        const study::RunList list = study::list_runs(study);
        require(list.baselines.size() == study.scenes.size(), "a scene has no baseline");
        for (std::size_t i = 0; i < std::min(list.runs.size(), most_read); ++i) {
            const nlohmann::json document = study::document_of(list.runs[i], study);
            if (!paths_stay_in_folder(document)) continue;
            may_fail([&] { read_scene(document, study.scenes[list.runs[i].scene].file); });
        }
    });
}

}  // namespace lamina::fuzz
