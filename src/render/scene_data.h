// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "choice/field.h"
#include "lamina/mesh.h"
#include "lamina/report.h"
#include "lamina/scene.h"
#include "mesh/face_tree.h"
#include "render/warnings.h"
#include "scene/scene.h"
#include "volume/volume_data.h"

namespace lamina {

// Loads and keeps the volume and the mesh that a scene draws. Each is read, generated or made from
// the volume when it is first asked for, and then serves all scenes, whatever files they name.
// Copies share what was loaded by then. Members throw Error if data cannot be read or made.
class SceneData {
  public:
    SceneData() = default;
    // Given data are drawn in place of those that scenes name.
    explicit SceneData(Volume volume);
    explicit SceneData(std::shared_ptr<const VolumeData> volume)
        : volume_(std::move(volume)), volume_given_(true) {}
    explicit SceneData(std::shared_ptr<const SceneMesh> mesh)
        : mesh_(std::move(mesh)), mesh_given_(true) {}
    // `report`: the accuracy of the mesh, if it was made from a volume before.
    SceneData(const Scene& scene, MeshData mesh, const std::optional<MeshReport>& report = {});
    // Takes a mesh that was made from the volume as the scene says; the volume may be null.
    SceneData(std::shared_ptr<const VolumeData> volume, std::shared_ptr<const SceneMesh> made)
        : volume_(std::move(volume)), mesh_(std::move(made)), volume_given_(volume_ != nullptr) {}

    const std::shared_ptr<const VolumeData>& volume(const Scene& scene);
    const std::shared_ptr<const SceneMesh>& mesh(const Scene& scene);
    // Returns the tree of the mesh's open faces, for the reference tracer.
    const FaceTree& open_faces(const Scene& scene);
    // Returns a view of the scene's data for choices and warnings. The data must outlive it.
    std::unique_ptr<Field> field(const Scene& scene);

    // Returns the range of finite values over which a colour map is stretched: that of the volume
    // if there is one, so that pictures of the volume and of its mesh have the same colours.
    const ValueRange& range(const Scene& scene);

    // Makes a given transfer function one of the data that the scene draws: stretches an open
    // colour map over them, and takes the codes of labels for their numbers (over_codes()).
    void close_transfer_function(Scene& scene);
    // Says so if values are codes of labels in place of the file's numbers (VolumeLabels).
    TransferFunction marked(const Scene& scene, const TransferFunction& drawn);

    // Keeps the volume that a mesh is made from, so that more meshes can be made. Otherwise the
    // volume is dropped after the first.
    void keep_volume() { keeps_volume_ = true; }

    // Tells whether the mesh that the scene draws is made from its volume, and so follows its
    // transfer function.
    bool makes_mesh(const Scene& scene) const {
        return !mesh_given_ && scene.mesh_file() == nullptr;
    }
    void forget_mesh();

    // Returns the warnings of reading, measuring or making the data that the scene draws.
    Warnings warnings(const Scene& scene) const;

    // Adds the times of loading and the counts of the data that the scene draws.
    void add_to(const Scene& scene, FrameStatistics& statistics);

  private:
    using Stages = std::map<std::string, double>;  // milliseconds

    std::shared_ptr<const VolumeData> volume_;
    std::shared_ptr<const SceneMesh> mesh_;
    bool volume_given_ = false, mesh_given_ = false, keeps_volume_ = false;
    std::optional<ValueRange> range_;
    std::shared_ptr<const FaceTree> open_faces_;
    Stages volume_ms_, mesh_ms_;
    Warnings volume_warnings_, mesh_warnings_;
    std::optional<std::map<std::string, std::int64_t>> mesh_counts_;
};

}  // namespace lamina
