// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene_reader.h"
#include "study/run_list.h"

namespace lamina {
namespace {

void check_file(const std::filesystem::path& path, const StudyFile::SceneEntry& scene) {
    if (!path.empty() && !std::filesystem::exists(path))
        fail("scene \"{}\": {}: no such file", scene.name, path.string());
}

void check_context(const std::string& word, const StudyFile& study) {
    static const std::set<std::string> words{"auto", "osmesa", "egl", "cpu"};
    if (!words.contains(word)) {
        fail("{}: context: found \"{}\", expected auto, osmesa, egl or cpu", study.file.string(),
             word);
    }
}

}  // namespace

void check_runs(const RunList& list, const StudyFile& study) {
    struct Outcome {
        std::size_t runs = 0, failed = 0;
        std::string message;
    };
    std::vector<Outcome> outcomes(list.scenes.size());
    for (const StudyRun& run : list.runs) {
        const StudyFile::SceneEntry& entry = study.scenes[run.scene];
        Outcome& outcome = outcomes[run.scene];
        ++outcome.runs;
        check_context(context_of(run, study), study);
        try {
            const Scene scene = read_scene(document_of(run, study), entry.file);
            check_file(scene.volume_file, entry);
            check_file(scene.mesh_file, entry);
        } catch (const UnknownKeyError& error) {
            fail("{}: {}", study.file.string(), error.what());
        } catch (const KeyError& error) {
            if (outcome.failed++ == 0) outcome.message = error.what();
        } catch (const Error& error) {  // a file that is missing
            fail("{}: {}", study.file.string(), error.what());
        }
    }
    for (const Outcome& outcome : outcomes) {
        if (outcome.failed == outcome.runs)
            fail("{}: no run can be drawn: {}", study.file.string(), outcome.message);
    }
}

}  // namespace lamina
