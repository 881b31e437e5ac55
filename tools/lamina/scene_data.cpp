// SPDX-License-Identifier: Apache-2.0
#include "scene_data.h"

#include <nlohmann/json.hpp>

#include "base/stage.h"
#include "choice/mesh_field.h"
#include "choice/volume_field.h"
#include "scene/scene_volume.h"
#include "scene_files/scene_json.h"

namespace lamina {
namespace {

bool leaves_nothing_open(const Scene& scene, const Wishes& wishes) {
    return !leaves_something_open(scene) && !wishes.transfer_function() && !wishes.camera();
}

std::shared_ptr<const VolumeData> load_volume_data(const Scene& scene, RenderStats& stats) {
    Stage loading("load");
    Volume volume = open_volume(scene);
    stats.stages_ms["load"] = loading.end();
    Stage measuring("measure");
    Stage measuring_bricks("bricks");
    auto data = std::make_shared<const VolumeData>(std::move(volume));
    measuring_bricks.end();
    stats.stages_ms["measure"] = measuring.end();
    return data;
}

std::shared_ptr<const SceneMesh> load_mesh_data(const Scene& scene, RenderStats& stats) {
    Stage loading("load");
    auto mesh = std::make_shared<const SceneMesh>(load_mesh(scene));
    stats.stages_ms["load"] = loading.end();
    return mesh;
}

void choose(Scene& scene, const Field& field, const Wishes& wishes, RenderStats& stats) {
    if (leaves_nothing_open(scene, wishes)) return;
    Stage choosing("choose");
    scene = choose(scene, field, wishes);
    stats.stages_ms["choose"] = choosing.end();
}

}  // namespace

std::unique_ptr<Field> SceneData::field() const {
    if (mesh) return std::make_unique<MeshField>(*mesh);
    return std::make_unique<VolumeField>(*volume);
}

// A mesh that is made from a volume follows the transfer function, which the volume decides.
SceneData load_data(Scene& scene, const Wishes& wishes, RenderStats& stats) {
    SceneData data;
    if (!scene.draws_mesh()) {
        data.volume = load_volume_data(scene, stats);
        choose(scene, *data.field(), wishes, stats);
        return data;
    }
    if (scene.mesh_file.empty() && !leaves_nothing_open(scene, wishes)) {
        const auto volume = load_volume_data(scene, stats);
        choose(scene, VolumeField(*volume), wishes, stats);
        Stage loading("load");
        data.mesh = std::make_shared<const SceneMesh>(scene_mesh(scene, volume->volume));
        stats.stages_ms["load"] += loading.end();
        return data;
    }
    data.mesh = load_mesh_data(scene, stats);
    choose(scene, *data.field(), wishes, stats);
    return data;
}

void choose_for_volume(Scene& scene) {
    if (leaves_nothing_open(scene, {})) return;
    RenderStats ignored;
    const auto volume = load_volume_data(scene, ignored);
    choose(scene, VolumeField(*volume), {}, ignored);
}

nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document) {
    nlohmann::ordered_json result = scene_json(scene);
    result["render"] = document.value("render", nlohmann::json::object());
    result["render"]["method"] = name_of(scene.method);
    return result;
}

}  // namespace lamina
