// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "lamina/scene.h"
#include "render/pipeline.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

nlohmann::json parsed(const std::string& json, const std::filesystem::path& name) {
    try {
        return parse_json(json);
    } catch (const Error& error) {
        fail("{}: {}", name.string(), error.what());
    }
}

Camera fitted(Scene scene, SceneData data, Method method, const ViewTurn& turn) {
    scene.method = method;
    scene.camera = automatic;
    PipelineOptions options;
    options.adjustments.turn = turn;
    Pipeline pipeline(std::move(scene), std::move(data), std::move(options));
    return *pipeline.scene().camera;
}

}  // namespace

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name);
}

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const Volume& /*data*/, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name, GivenData::volume);
}

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const MeshData& /*data*/, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name, GivenData::mesh);
}

std::string scene_text(const Scene& scene) {
    return json_text(scene_json(scene), 1) + "\n";
}

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
    // The transfer function does not depend on the camera; this one saves fitting another.
    if (has_open_colormap(drawn)) drawn.camera = drawn.camera.value_or(Camera{});
    Pipeline pipeline(std::move(drawn), SceneData(volume));
    return *pipeline.scene().transfer_function;
}

}  // namespace lamina
