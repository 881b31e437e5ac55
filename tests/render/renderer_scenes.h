// SPDX-License-Identifier: Apache-2.0
// Data, cameras and scenes that the tests in tests/render draw.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "render/scene_renderer.h"
#include "support/split_box.h"
#include "support/transfer_functions.h"
#include "volume/generate.h"

namespace lamina {

inline std::shared_ptr<const VolumeData> blobs() {
    return std::make_shared<const VolumeData>(
        generate({"gaussians", std::array<std::int64_t, 3>{24, 20, 28}, SampleType::uint8}));
}

inline TransferFunction smooth(double extinction) {
    return TransferFunction::linear(
        {test::knot(0, {.1, .2, .6}, 0), test::knot(60, {.2, .7, .5}, .2 * extinction),
         test::knot(130, {.8, .7, .2}, .5 * extinction), test::knot(255, {1, .2, .1}, extinction)});
}

inline Camera orbit(double degrees, double distance = 2.2) {
    const double angle = degrees * std::numbers::pi / 180;
    Camera camera;
    camera.center = glm::dvec3(.5);
    camera.eye = camera.center + distance * glm::dvec3(std::sin(angle), .4, std::cos(angle));
    return camera;
}

inline Scene volume_scene() {
    Scene scene;
    scene.transfer_function = smooth(6);
    scene.camera = orbit(20);
    scene.width = 40;
    scene.height = 30;
    scene.slice.classification = Classification::preintegrated;
    return scene;
}

inline Scene mesh_scene() {
    Scene scene;
    scene.method = Method::project;
    scene.transfer_function =
        TransferFunction::linear({test::knot(0, {1, .2, 0}, .1), test::knot(.4, {1, 1, 0}, 3),
                                  test::knot(1, {0, .3, 1}, 6)});
    scene.camera = orbit(20);
    scene.width = 40;
    scene.height = 30;
    return scene;
}

inline std::shared_ptr<const SceneMesh> split_box() {
    MeshData data = test::kuhn_box({3, 2, 4}, [](const glm::dvec3& place) {
        return .5 + .5 * std::sin(9 * place.x + 5 * place.y * place.z);
    });
    MeshScalar scalar = data.point_scalars.front();
    data.point_scalars.clear();
    return std::make_shared<const SceneMesh>(
        SceneMesh{TetMesh(std::move(data), "mesh"), std::move(scalar), false, {}});
}

}  // namespace lamina
