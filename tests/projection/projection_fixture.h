// SPDX-License-Identifier: Apache-2.0
// Draws a mesh by projection, with OpenGL or the cpu engine, and by the reference tracer, for
// comparison.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "base/enum_words.h"
#include "gl/gl_fixture.h"
#include "image/difference.h"
#include "plan/plan.h"
#include "projection/cpu_project_renderer.h"
#include "projection/gl_project_renderer.h"
#include "reference/tracer.h"
#include "support/transfer_functions.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {

// opengl: as planned, with compute shaders if the scene allows; rasterizer: OpenGL without them.
enum class Engine { opengl, rasterizer, tiles };

inline std::string engine_name(const testing::TestParamInfo<Engine>& info) {
    return word_of(info.param, {"opengl", "rasterizer", "tiles"});
}

inline const auto every_engine = testing::Values(Engine::opengl, Engine::rasterizer, Engine::tiles);

// Runs each test with OpenGL, both ways, and with the cpu engine, by INSTANTIATE_TEST_SUITE_P(...,
// every_engine, engine_name).
class ProjectionTest : public gl::ContextTest<testing::TestWithParam<Engine>> {
  protected:
    void SetUp() override {
        if (GetParam() != Engine::tiles) make_context(gl::ContextKind::osmesa);
    }
    Capabilities capabilities() const {
        if (GetParam() == Engine::tiles) return cpu_capabilities();
        Capabilities found = ContextTest::capabilities();
        found.software = false;  // lit meshes are drawn by compute shaders, too
        if (GetParam() == Engine::rasterizer) found.max_buffer_texels = 0;
        return found;
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
    return make_project_renderer(mesh, *scene.transfer_function,
                                 plan_of(mesh, scene, capabilities, omissions).project,
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
    return to_float(
        trace_mesh(mesh.mesh, tree, mesh.scalar.values, *scene.transfer_function,
                   View(*scene.camera, scene.width, scene.height),
                   {.lighting = copied_lighting(scene.lighting), .clip = half_spaces(scene.clip)})
            .image);
}

// Returns a random unit vector.
inline glm::dvec3 direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const glm::dvec3 v(normal(random), normal(random), normal(random));
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace lamina
