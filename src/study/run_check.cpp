// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/enum_words.h"
#include "base/error.h"
#include "render/context_choice.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_reader.h"
#include "study/run_list.h"

namespace lamina::study {
namespace {

void check_file(const std::filesystem::path& path, const StudyFile::SceneEntry& scene) {
    if (!std::filesystem::exists(path))
        fail("scene \"{}\": {}: no such file", scene.name, path.string());
}

void check_context(const std::string& word, const StudyFile& study) {
    if (!is_context(word)) {
        fail("{}: context: found \"{}\", expected {}", study.file.string(), word, context_words());
    }
}

}  // namespace

TraceOf reference_of(const Scene& scene, const StudyFile& file) {
    if (file.reference) return *file.reference;
    return scene.method == Method::project ? TraceOf::mesh : TraceOf::volume;
}

Scene scene_of(const StudyRun& run, const StudyFile& file) {
    Scene scene = read_scene(document_of(run, file), file.scenes[run.scene].file);
    const std::string name = scene.file.string();
    if (scene.method == Method::trace) {
        throw KeyError("render.method",
                       fmt::format("{}: render.method: found \"trace\", expected \"slice\" or "
                                   "\"project\": the tracer is what runs are measured against",
                                   name));
    }
    const char* const automatic = chooses_transfer_function(scene) ? "transfer_function"
                                  : scene.camera.is_automatic()    ? "camera"
                                                                   : nullptr;
    if (automatic != nullptr) {
        throw KeyError(automatic,
                       fmt::format("{0}: {1}: is \"auto\" or missing, expected an object {{...}}: "
                                   "the runs of a study share one ('lamina scene {0} -o NEW.json' "
                                   "writes what would be chosen)",
                                   name, automatic));
    }
    const TraceOf reference = reference_of(scene, file);
    if (reference == TraceOf::volume && !scene.has_volume())
        throw KeyError("volume", fmt::format("{}: the reference is a volume's, and the scene has "
                                             "none",
                                             name));
    if (reference == TraceOf::mesh && !scene.has_mesh())
        throw KeyError("mesh",
                       fmt::format("{}: the reference is a mesh's, and the scene has none", name));
    return scene;
}

std::vector<StudyData> check_runs(const RunList& list, const StudyFile& study) {
    struct Outcome {
        std::size_t runs = 0, failed = 0;
        std::string message;
    };
    std::vector<Outcome> outcomes(list.scenes.size());
    std::vector<StudyData> data;
    for (const StudyRun& run : list.runs) {
        const StudyFile::SceneEntry& entry = study.scenes[run.scene];
        Outcome& outcome = outcomes[run.scene];
        ++outcome.runs;
        check_context(context_of(run, study), study);
        try {
            const Scene scene = scene_of(run, study);
            if (const VolumeFile* const file = scene.volume_file()) check_file(file->path, entry);
            if (const MeshFile* const file = scene.mesh_file()) check_file(file->path, entry);
            add_data(run.scene, scene, reference_of(scene, study), data);
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
    return data;
}

}  // namespace lamina::study
