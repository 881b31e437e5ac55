// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "lamina/point_probe.h"
#include "lamina/scene.h"
#include "mesh/face_tree.h"
#include "scene/scene_mesh.h"
#include "volume/volume_data.h"

namespace lamina {

// The members of one kind of data are set.
struct PointProbe::Parts {
    Scene scene;
    std::shared_ptr<const VolumeData> volume;
    std::shared_ptr<const SceneMesh> mesh;
    std::once_flag first;
    std::optional<FaceTree> open_faces;  // of the mesh, made when it is first needed
};

}  // namespace lamina
