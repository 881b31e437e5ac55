// SPDX-License-Identifier: Apache-2.0
#include "lamina/camera_choice.h"

#include <utility>

#include "render/pipeline.h"
#include "scene/given_transfer.h"

namespace lamina {
namespace {

Camera fitted(Scene scene, SceneData data, Method method, const ViewTurn& turn) {
    scene.method = method;
    scene.automatic_camera = true;
    PipelineOptions options;
    options.wishes.turn = turn;
    return Pipeline(std::move(scene), std::move(data), std::move(options)).scene().camera;
}

}  // namespace

Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth, double elevation) {
    return fitted(scene, SceneData(volume), Method::slice, {azimuth, elevation});
}

Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth, double elevation) {
    return fitted(scene, SceneData(scene, mesh), Method::project, {azimuth, elevation});
}

TransferFunction chosen_transfer_function(const Scene& scene, const Volume& volume) {
    if (!scene.automatic_transfer_function) return scene.transfer_function;
    Scene drawn = scene;
    drawn.method = Method::slice;
    if (has_open_colormap(drawn)) drawn.automatic_camera = false;  // it would be fitted
    return Pipeline(std::move(drawn), SceneData(volume)).scene().transfer_function;
}

}  // namespace lamina
