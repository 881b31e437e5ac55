// SPDX-License-Identifier: Apache-2.0
#include "study/data_store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "base/content_hash.h"
#include "base/json_text.h"
#include "base/profile.h"
#include "choice/choose.h"
#include "scene/given_transfer.h"
#include "scene_files/data_keys.h"
#include "study/picture_key.h"
#include "volume/generate.h"

namespace lamina::study {

std::string volume_name(const Scene& scene) {
    if (const VolumeFile* const file = scene.volume_file()) {
        const std::string path = file->path.string();
        if (file->selection == VolumeRequest{}) return path;
        return json_text(volume_selection_json(path, file->selection));
    }
    const auto& request = std::get<GeneratorRequest>(scene.volume);
    const auto size = generated_grid(request).size;
    return fmt::format("{} {} {}", request.name, fmt::join(size, "x"), name_of(request.type));
}

// The name includes the transfer function: a mesh made from a volume stays coarse where that shows
// nothing.
std::string mesh_name(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) {
        std::string name = file->path.string();
        if (file->time != 0) name += fmt::format(" {}", file->time);
        return scene.scalar.empty() ? name : name + " " + scene.scalar;
    }
    const MeshSettings settings = mesh_settings(scene);
    return fmt::format("{} {} {} {} {}", volume_name(scene), settings.tolerance, settings.max_tets,
                       settings.kuhn, transfer_function_key(*scene.transfer_function));
}

const DataStore::StoredVolume& DataStore::volume(const Scene& scene) {
    std::unique_ptr<StoredVolume>& stored = volumes_[volume_name(scene)];
    if (!stored) {
        std::shared_ptr<const VolumeData> data = SceneData().volume(scene);
        std::string content = content_of(data->volume);
        stored = std::make_unique<StoredVolume>(StoredVolume{std::move(data), std::move(content)});
    }
    return *stored;
}

DataStore::StoredMesh& DataStore::mesh(const Scene& scene) {
    std::unique_ptr<StoredMesh>& stored = meshes_[mesh_name(scene)];
    if (!stored) {
        MadeMesh made = read_or_make(scene);
        TracedMesh data(std::move(made.data));
        std::string content = content_of(data.mesh());
        stored =
            std::make_unique<StoredMesh>(StoredMesh{std::move(data), std::move(content), made.ms});
    }
    return *stored;
}

MadeMesh DataStore::read_or_make(const Scene& scene) {
    const auto make = [&] {
        const bool makes = scene.mesh_file() == nullptr;
        SceneData data = makes ? SceneData(volume(scene).data, nullptr) : SceneData();
        const Stopwatch watch;
        data.mesh(scene);
        return MadeMesh{std::move(data), watch.milliseconds()};
    };
    if (!kept_ || scene.mesh_file() != nullptr) return make();
    // Data of the volume's name may change between two processes.
    ContentHash id;
    id.add(volume(scene).content);
    id.add(mesh_name(scene));
    if (std::optional<MadeMesh> found = kept_->find(id.hex(), scene)) return std::move(*found);
    MadeMesh made = make();
    kept_->keep(id.hex(), made);
    return made;
}

// If the scene leaves something open, the volume decides on it even if a mesh is made from it.
SceneData DataStore::data_of(const Scene& scene) {
    if (!scene.draws_mesh()) return SceneData(volume(scene).data);
    const SceneData& data = mesh(scene).data.data();
    if (scene.mesh_file() != nullptr || !leaves_something_open(scene)) return data;
    return SceneData(volume(scene).data, SceneData(data).mesh(scene));
}

Scene DataStore::closed(Scene scene) {
    if (!has_open_colormap(scene)) return scene;
    SceneData data = scene.has_volume() ? SceneData(volume(scene).data) : mesh(scene).data.data();
    close_colormap(scene, data.range(scene));
    return scene;
}

void DataStore::clear() {
    volumes_.clear();
    meshes_.clear();
}

}  // namespace lamina::study
