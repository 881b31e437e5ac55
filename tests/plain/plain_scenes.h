// SPDX-License-Identifier: Apache-2.0
// Makes scenes for the tests of the plain tracer.
#pragma once

#include <vector>

#include "lamina/scene.h"
#include "reference/fixtures.h"
#include "scene/scene.h"

namespace lamina::plain_test {

using namespace reference_test;

inline Scene scene_of(const TransferFunction& function, const Camera& camera, int width = 24,
                      int height = 18) {
    Scene scene;
    scene.method = Method::trace;
    scene.transfer_function = function;
    scene.camera = camera;
    scene.width = width;
    scene.height = height;
    scene.trace_tolerance = 1e-9;
    return scene;
}

inline SceneMesh mesh_of(MeshData data) {
    MeshScalar scalar = data.point_scalars.front();
    return {TetMesh(std::move(data), "test"), std::move(scalar), false, {}};
}

// Returns views of the grid's box from outside, near it and inside, in both projections.
inline std::vector<Camera> views_of(const Grid& grid) {
    std::vector<Camera> views;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        for (const double distance : {1.4, .45, .1})
            views.push_back(camera_at(grid, projection, {1, .4, .7}, distance));
    }
    return views;
}

}  // namespace lamina::plain_test
