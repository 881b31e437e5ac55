// SPDX-License-Identifier: Apache-2.0
#include "lamina/camera_choice.h"

#include "choice/choose.h"
#include "choice/mesh_field.h"
#include "choice/volume_field.h"
#include "scene/scene_mesh.h"

namespace lamina {
namespace {

Camera fitted(Scene scene, const Field& field, double azimuth, double elevation) {
    scene.automatic_camera = true;
    Wishes wishes;
    wishes.turn = {azimuth, elevation};
    return choose(std::move(scene), field, wishes).camera;
}

}  // namespace

Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth, double elevation) {
    return fitted(scene, VolumeField(volume, measure_bricks(volume)), azimuth, elevation);
}

Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth, double elevation) {
    const SceneMesh drawn = scene_mesh(scene, mesh);
    return fitted(scene, MeshField(drawn), azimuth, elevation);
}

}  // namespace lamina
