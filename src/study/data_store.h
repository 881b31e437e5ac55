// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "study/kept_meshes.h"
#include "study/traced_mesh.h"
#include "volume/volume_data.h"

namespace lamina::study {

// Names of data: paths, or the formulas of generated data.
std::string volume_name(const Scene& scene);
std::string mesh_name(const Scene& scene);

// Volumes and meshes of scenes. Each is loaded or made once, when it is first needed. Throws Error
// where that fails.
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
