// SPDX-License-Identifier: Apache-2.0
// Tests lit rays through random cells and tets against make_lit_cases.py, a program with 30 digits
// that shares nothing with the tracer.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "fixtures.h"
#include "mesh/face_tree.h"
#include "reference/tracer.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

using nlohmann::json;
using namespace reference_test;

constexpr double case_tolerance = 1e-11;

json cases(const char* kind) {
    return load_json(LAMINA_SOURCE_DIR "/tests/reference/lit_cases.json")[kind];
}

glm::dvec3 vector_of(const json& numbers) {
    return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

// Returns a scene with the case's transfer function, its lighting and a camera of one ray.
Scene scene_of(const json& one) {
    const json camera{{"projection", "orthographic"},
                      {"eye", one["eye"]},
                      {"center", one["center"]},
                      {"up", {.31, .17, .9}},
                      {"height", 1}};
    return read_scene({{"version", 1},
                       {"volume", {{"generate", "constant"}}},
                       {"transfer_function", {{"points", one["points"]}}},
                       {"camera", camera},
                       {"image", {{"width", 1}, {"height", 1}}},
                       {"lighting", one["lighting"]}},
                      "case");
}

// Error by the rounding of the ray, 1e-15 of its length of 12. Extinction changes by at most 30 *
// 16 per unit of the scalar; light by its power of 400 times the change of the gradient, relative
// to its length. Both make some 1e-11 of the rounding at worst.
constexpr double rounding = 1e-11;

void expect_rgba(const PreciseImage& image, double estimate, const json& one, std::size_t number) {
    EXPECT_LE(estimate, 2 * case_tolerance) << number;
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_NEAR(image.rgba[c], one["rgba"][c].get<double>(), estimate + rounding)
            << number << ", channel " << c;
    }
}

TEST(LitCases, VolumesMatchTheHighPrecisionResults) {
    const json all = cases("volumes");
    ASSERT_GE(all.size(), 30u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Scene scene = scene_of(all[i]);
        const Centering centering =
            all[i]["centering"] == "cell" ? Centering::cell : Centering::node;
        Grid grid;
        grid.size = all[i]["size"];
        grid.centering = {centering, centering, centering};
        for (std::size_t axis = 0; axis < 3; ++axis)
            grid.step[axis] = vector_of(all[i]["step"][axis]);
        const TraceResult result = trace_volume(make_volume<float>(grid, all[i]["samples"]),
                                                *scene.transfer_function, View(*scene.camera, 1, 1),
                                                {case_tolerance, copied_lighting(scene.lighting)});
        expect_rgba(result.image, result.error_estimate, all[i], i);
    }
}

TEST(LitCases, MeshesMatchTheHighPrecisionResults) {
    const json all = cases("meshes");
    ASSERT_GE(all.size(), 20u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Scene scene = scene_of(all[i]);
        MeshData data;
        for (const json& point : all[i]["points_at"]) data.points.push_back(vector_of(point));
        data.tets = all[i]["tets"].get<std::vector<Tet>>();
        data.point_scalars = {{"s", all[i]["scalar"]}};
        const TetMesh mesh(data, "case");
        const FaceTree tree(mesh, mesh.open_faces());
        const TraceResult result = trace_mesh(mesh, tree, mesh.point_scalars()[0].values,
                                              *scene.transfer_function, View(*scene.camera, 1, 1),
                                              {case_tolerance, copied_lighting(scene.lighting)});
        expect_rgba(result.image, result.error_estimate, all[i], i);
    }
}

}  // namespace
}  // namespace lamina
