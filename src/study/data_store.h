// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "lamina/scene.h"
#include "lamina/volume.h"
#include "optics/colormap.h"
#include "render/scene_data.h"
#include "render/traced_picture.h"
#include "scene/scene_mesh.h"
#include "volume/volume_data.h"

namespace lamina::study {

// Returns a text of all that an exact picture depends on beside its data: transfer function,
// camera, size, clip and lighting.
std::string picture_key(const Scene& scene);

std::string transfer_function_key(const TransferFunction& transfer_function);

// Returns a hash of the contents of data, wherever they came from.
std::string content_of(const Volume& volume);
std::string content_of(const SceneMesh& mesh);
std::string content_of(const Colormap& colormap);

// A tetrahedral mesh that is drawn, and the tracer's pictures of it. The mesh that a scene names is
// ignored.
class TracedMesh {
  public:
    explicit TracedMesh(SceneMesh mesh);
    explicit TracedMesh(SceneData data);  // which has a mesh

    const SceneMesh& mesh() const { return *mesh_; }
    const TetMesh& tets() const { return mesh_->mesh; }
    const SceneData& data() const { return data_; }

    TracedPicture trace(const Scene& scene);
    // The tracer's picture, made once for each transfer function, camera and size.
    const PreciseImage& exact(const Scene& scene);

  private:
    SceneData data_;
    std::shared_ptr<const SceneMesh> mesh_;       // that of data_
    std::map<std::string, PreciseImage> traced_;  // by picture_key()
};

// A mesh that was made from a volume, and the time that it took.
struct MadeMesh {
    SceneData data;
    double ms = 0;
};

// Meshes made from volumes, kept in a folder as ID.vtu and ID.json. `id` identifies all that a mesh
// depends on. Later processes find there the same numbers, bit for bit.
class KeptMeshes {
  public:
    explicit KeptMeshes(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Returns nothing if the folder has no such mesh, or if its files are damaged.
    std::optional<MadeMesh> find(const std::string& id, const Scene& scene) const;
    // Throws Error if the files cannot be written.
    void keep(const std::string& id, MadeMesh& made) const;

  private:
    std::filesystem::path file(const std::string& id, const char* extension) const {
        return folder_ / (id + extension);
    }

    std::filesystem::path folder_;
};

// Return names of data: paths, or the formulas of generated data.
std::string volume_name(const Scene& scene);
std::string mesh_name(const Scene& scene);

// Volumes and meshes of scenes. Each is loaded or made once, when it is first needed. Throws Error
// if that fails.
class DataStore {
  public:
    struct StoredVolume {
        std::shared_ptr<const VolumeData> data;
        std::string content;  // content_of()
    };
    struct StoredMesh {
        TracedMesh data;
        std::string content;
        double ms = 0;  // time to read or make it
    };
    const StoredVolume& volume(const Scene& scene);
    StoredMesh& mesh(const Scene& scene);
    // The data that the scene draws.
    SceneData data_of(const Scene& scene);
    // The scene with its colour map stretched over its data, if that is open.
    Scene closed(Scene scene);
    void clear();

    // Keeps meshes that are made from volumes in this folder from now on, and finds them there.
    void keep_meshes(const std::filesystem::path& folder) { kept_.emplace(folder); }

  private:
    MadeMesh read_or_make(const Scene& scene);

    std::optional<KeptMeshes> kept_;
    std::map<std::string, std::unique_ptr<StoredVolume>> volumes_;
    std::map<std::string, std::unique_ptr<StoredMesh>> meshes_;
};

}  // namespace lamina::study
