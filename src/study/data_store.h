// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

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
    };
    const StoredVolume& volume(const Scene& scene);
    const StoredMesh& mesh(const Scene& scene);
    void clear();

  private:
    std::map<std::string, std::unique_ptr<StoredVolume>> volumes_;
    std::map<std::string, std::unique_ptr<StoredMesh>> meshes_;
};

}  // namespace lamina::study
