// SPDX-License-Identifier: Apache-2.0
#include "lamina/camera_choice.h"

#include <utility>

#include "render/pipeline.h"
#include "scene/given_transfer.h"

namespace lamina {
namespace {

Camera fitted(Scene scene, SceneData data, Method method, const ViewTurn& turn) {
    scene.method = method;
    scene.camera = automatic;
    PipelineOptions options;
    options.wishes.turn = turn;
    Pipeline pipeline(std::move(scene), std::move(data), std::move(options));
    return *pipeline.scene().camera;
}

}  // namespace

Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth, double elevation) {
    return fitted(scene, SceneData(volume), Method::slice, {azimuth, elevation});
}

Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth, double elevation) {
    return fitted(scene, SceneData(scene, mesh), Method::project, {azimuth, elevation});
}

TransferFunction chosen_transfer_function(const Scene& scene, const Volume& volume) {
    if (scene.transfer_function.is_given()) return *scene.transfer_function;
    Scene drawn = scene;
    drawn.method = Method::slice;
    // Any camera will do here; without one, one would be fitted.
    if (has_open_colormap(drawn)) drawn.camera = drawn.camera.value_or(Camera{});
    Pipeline pipeline(std::move(drawn), SceneData(volume));
    return *pipeline.scene().transfer_function;
}

}  // namespace lamina
