// SPDX-License-Identifier: Apache-2.0
#include "study/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/enum_words.h"
#include "base/error.h"
#include "render/context_choice.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_reader.h"

namespace lamina::study {
namespace {

using Kind = StudyData::Kind;

std::string content_of(const StudyData& data, DataStore& store) {
    try {
        if (data.kind == Kind::volume) return store.volume(data.drawn).content;
        if (data.kind == Kind::mesh) return store.mesh(data.drawn).content;
        return study::content_of(read_paraview_colormap(colormap_file_of(data.drawn)));
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace

void add_data(std::size_t number, const Scene& drawn, TraceOf reference,
              std::vector<StudyData>& data) {
    const auto add = [&](Kind kind, const std::string& name) {
        StudyData found{kind, name, number, drawn};
        if (std::find(data.begin(), data.end(), found) == data.end())
            data.push_back(std::move(found));
    };
    const bool needs_mesh = drawn.draws_mesh() || reference == TraceOf::mesh;
    const bool needs_volume = !drawn.draws_mesh() || reference == TraceOf::volume ||
                              (needs_mesh && drawn.made_mesh() != nullptr);
    if (needs_volume && drawn.has_volume()) add(Kind::volume, volume_name(drawn));
    if (needs_mesh && drawn.mesh_file() != nullptr) add(Kind::mesh, mesh_name(drawn));
    const std::filesystem::path colormap = colormap_file_of(drawn);
    if (!colormap.empty()) add(Kind::colormap, colormap.string());
}

std::vector<std::string> contents_of(const std::vector<StudyData>& data, DataStore& store) {
    std::map<std::pair<Kind, std::string>, std::string> known;
    std::vector<std::string> contents;
    for (const StudyData& each : data) {
        if (each.scene != data.front().scene) store.clear();  // memory is for one scene at a time
        const auto [found, added] = known.try_emplace({each.kind, each.name});
        if (added) found->second = content_of(each, store);
        contents.push_back(found->second);
    }
    if (!data.empty() && data.back().scene != data.front().scene) store.clear();
    return contents;
}

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

void list_data(const std::vector<StudyData>& data, DataStore& store, RunList& list) {
    const std::vector<std::string> contents = contents_of(data, store);
    for (std::size_t i = 0; i < data.size(); ++i) list.data.push_back({data[i].name, contents[i]});
}

}  // namespace lamina::study
