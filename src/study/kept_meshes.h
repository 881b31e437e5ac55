// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "lamina/scene.h"
#include "render/scene_data.h"

namespace lamina::study {

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

}  // namespace lamina::study
