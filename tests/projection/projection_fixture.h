// SPDX-License-Identifier: Apache-2.0
// Draws a mesh by projection, with OpenGL or the cpu engine, and by the reference tracer, for
// comparison.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "gl/gl_fixture.h"
#include "image/difference.h"
#include "plan/plan.h"
#include "projection/cpu_project_renderer.h"
#include "projection/gl_project_renderer.h"
#include "reference/tracer.h"
#include "support/transfer_functions.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {

enum class Engine { opengl, tiles };

inline std::string engine_name(const testing::TestParamInfo<Engine>& info) {
    return info.param == Engine::opengl ? "opengl" : "tiles";
}

inline const auto both_engines = testing::Values(Engine::opengl, Engine::tiles);

// Runs each test with OpenGL and with the cpu engine, by INSTANTIATE_TEST_SUITE_P(...,
// both_engines, engine_name).
class ProjectionTest : public gl::ContextTest<testing::TestWithParam<Engine>> {
  protected:
    void SetUp() override {
        if (GetParam() == Engine::opengl) make_context(gl::ContextKind::osmesa);
    }
    Capabilities capabilities() const {
        return GetParam() == Engine::opengl ? ContextTest::capabilities() : cpu_capabilities();
    }
};

inline SceneMesh scene_mesh(MeshData data) {
    MeshScalar scalar = data.point_scalars.front();
    data.point_scalars.clear();
    return {TetMesh(std::move(data), "mesh"), std::move(scalar), false, {}};
}

// Return fields over the unit box with values in 0 .. 1.
inline double ripples(const glm::dvec3& p) {
    return .5 + .5 * std::sin(5 * p.x + 3 * p.y) * std::cos(4 * p.z);
}
inline double waves(const glm::dvec3& p) {
    return .5 + .5 * std::sin(5 * p.x + 3 * p.y * p.z);
}

using test::knot;

inline Scene projection_scene(const TransferFunction& transfer_function, int width, int height) {
    Scene scene;
    scene.method = Method::project;
    scene.transfer_function = transfer_function;
    scene.width = width;
    scene.height = height;
    return scene;
}

inline Plan plan_of(const SceneMesh& mesh, const Scene& scene, const Capabilities& capabilities,
                    const OmissionSwitch& omissions = {}) {
    return make_plan(scene, measure(scene, mesh), capabilities, omissions);
}

// Makes a renderer of the engine whose capabilities these are. The mesh must outlive it.
inline std::unique_ptr<ProjectRenderer> make_renderer(const SceneMesh& mesh, const Scene& scene,
                                                      const Capabilities& capabilities,
                                                      const OmissionSwitch& omissions = {}) {
    const Plan plan = plan_of(mesh, scene, capabilities, omissions);
    if (capabilities.cpu) {
        return std::make_unique<CpuProjectRenderer>(mesh, *scene.transfer_function, plan.project,
                                                    scene.width, scene.height);
    }
    return std::make_unique<GlProjectRenderer>(mesh, *scene.transfer_function, plan.project,
                                               capabilities, scene.width, scene.height);
}

inline Image project(const SceneMesh& mesh, const Scene& scene, const Capabilities& capabilities,
                     const OmissionSwitch& omissions = {}) {
    const auto renderer = make_renderer(mesh, scene, capabilities, omissions);
    renderer->draw(View(*scene.camera, scene.width, scene.height));
    return renderer->read();
}

inline Image trace(const SceneMesh& mesh, const Scene& scene) {
    const FaceTree tree(mesh.mesh, mesh.mesh.open_faces());
    return to_float(trace_mesh(mesh.mesh, tree, mesh.scalar.values, *scene.transfer_function,
                               View(*scene.camera, scene.width, scene.height),
                               {.lighting = scene.lighting, .clip = half_spaces(scene.clip)})
                        .image);
}

// Returns a random unit vector.
inline glm::dvec3 direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const glm::dvec3 v(normal(random), normal(random), normal(random));
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace lamina
