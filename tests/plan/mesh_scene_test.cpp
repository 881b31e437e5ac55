// SPDX-License-Identifier: Apache-2.0
// Scenes with meshes: they are read, their scalar is chosen, and contradictions are refused.
#include <cmath>
#include <fstream>

#include "facts/mesh_facts.h"
#include "plan/plan.h"
#include "scene/scene.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Writes a tet as .node/.ele, with two attributes of points and one of the tet, whose names are
// those of mesh_files/mesh_formats.h. Returns the path.
std::string write_tet(const TemporaryFolder& folder, const std::string& value) {
    std::ofstream(folder / "t.node")
        << "4 3 2 0\n1 0 0 0 5 1\n2 1 0 0 6 2\n3 0 1 0 7 3\n4 0 0 1 8 " << value << "\n";
    std::ofstream(folder / "t.ele") << "1 4 1\n1 1 2 3 4 2.5\n";
    return folder / "t.node";
}

nlohmann::json mesh_scene(const std::string& file) {
    nlohmann::json scene = with("/mesh", file);
    scene.erase("volume");
    scene["render"]["method"] = "trace";
    return scene;
}

TEST(MeshScene, ReadsFilesAndRequests) {
    const Scene from_file = read_scene(mesh_scene("some/mesh.vtu"), "dir/s.json");
    EXPECT_EQ(from_file.mesh_file()->path, "dir/some/mesh.vtu");
    EXPECT_TRUE(from_file.draws_mesh());
    EXPECT_FALSE(from_file.has_volume());
    nlohmann::json made = with("/mesh", {{"tolerance", .1}, {"max_tets", 1000}, {"kuhn", true}});
    const Scene request = read_scene(made, "s.json");
    EXPECT_EQ(request.made_mesh()->tolerance, .1);
    EXPECT_EQ(request.made_mesh()->max_tets, 1000);
    EXPECT_TRUE(request.made_mesh()->kuhn);
    EXPECT_FALSE(request.draws_mesh());
    made["render"] = {{"method", "trace"}, {"trace", {{"of", "mesh"}}}};
    EXPECT_TRUE(read_scene(made, "s.json").draws_mesh());
    made["render"] = {{"method", "trace"}};
    EXPECT_FALSE(read_scene(made, "s.json").draws_mesh());  // by default the volume is traced
}

TEST(MeshScene, RefusesImpossibleSettings) {
    const auto refused = [](const nlohmann::json& scene, std::initializer_list<std::string> parts) {
        expect_error([&] { read_scene(scene, "s.json"); }, parts);
    };
    nlohmann::json scene = mesh_scene("m.vtu");
    scene["render"]["method"] = "slice";
    refused(scene, {"render.method", "trace", "without a volume"});
    scene = mesh_scene("m.vtu");
    scene["render"]["trace"]["of"] = "volume";
    refused(scene, {"render.trace.of", "no volume"});
    scene = mesh_scene("m.vtu");
    scene["mesh"] = {{"tolerance", .1}};
    refused(scene, {"volume", "made from"});
    scene.erase("mesh");
    refused(scene, {"volume", "missing"});
    scene = with("/render/trace/of", "mesh");
    refused(scene, {"render.trace.of", "no mesh"});
    refused(with("/scalar", "density"), {"scalar", "mesh"});
    refused(with("/mesh/tolerance", 0), {"mesh.tolerance", "found 0"});
    refused(with("/mesh/max_tets", 5), {"mesh.max_tets", "found 5"});
    refused(with("/mesh/kuhn", 1), {"mesh.kuhn", "true or false"});
    refused(with("/mesh/tolerence", .1), {"mesh.tolerence", "\"tolerance\""});
}

TEST(MeshScene, ChoosesTheScalar) {
    const TemporaryFolder folder;
    nlohmann::json scene = mesh_scene(write_tet(folder, "4"));
    SceneMesh mesh = load_mesh(read_scene(scene, "s.json"));
    const std::string first = mesh.scalar.name;
    EXPECT_EQ(mesh.scalar.values, (std::vector<double>{5, 6, 7, 8}));
    EXPECT_FALSE(mesh.averaged);
    const std::string all = error_of([&] {
        scene["scalar"] = "pressure";
        load_mesh(read_scene(scene, "s.json"));
    });
    EXPECT_NE(all.find("scalar: found \"pressure\", expected one"), std::string::npos) << all;
    EXPECT_NE(all.find(first), std::string::npos) << all;
    // The last name of the list is the array of the tets.
    const std::size_t end = all.rfind('"'), start = all.rfind('"', end - 1);
    scene["scalar"] = all.substr(start + 1, end - start - 1);
    mesh = load_mesh(read_scene(scene, "s.json"));
    EXPECT_TRUE(mesh.averaged);
    EXPECT_EQ(mesh.scalar.values, (std::vector<double>{2.5, 2.5, 2.5, 2.5}));
}

TEST(MeshScene, MeasuresTheMeshAndExplainsThePlan) {
    const TemporaryFolder folder;
    Scene scene = read_scene(mesh_scene(write_tet(folder, "4")), "s.json");
    const MeshFacts facts = measure(scene, load_mesh(scene));
    EXPECT_EQ(facts.tets, 1);
    EXPECT_EQ(facts.range.lo, 5);
    EXPECT_EQ(facts.range.hi, 8);
    const std::string text = explain(make_plan(scene, facts, {}, {}), facts, {});
    EXPECT_NE(text.find("trace of the mesh"), std::string::npos);
    EXPECT_NE(text.find("1 tets, 4 points"), std::string::npos);
}

TEST(MeshScene, NanValuesAreAnErrorUnlessTransparent) {
    Scene scene;
    scene.mesh = MeshFile{"m.vtu"};
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    data.tets = {{0, 1, 2, 3}};
    SceneMesh mesh{TetMesh(data, "m.vtu"), {"s", {1, NAN, 2, 3}}, false, {}};
    expect_error([&] { measure(scene, mesh); }, {"m.vtu", "1 NaN", "\"s\"", "transparent"});
    scene.nan = NanPolicy::transparent;
    EXPECT_EQ(measure(scene, mesh).non_finite, 1);
    mesh.scalar.values = {NAN, NAN, INFINITY, NAN};
    expect_error([&] { measure(scene, mesh); }, {"all 4 values"});
}

TEST(MeshScene, MakesTheMeshFromTheVolume) {
    const Scene scene = read_scene(with("/mesh", {{"kuhn", true}}), "s.json");
    const SceneMesh mesh = load_mesh(scene);  // 16^3 samples
    EXPECT_EQ(mesh.mesh.tets().size(), 15u * 15 * 15 * 6);
    EXPECT_EQ(mesh.report->tets, 15 * 15 * 15 * 6);
}

}  // namespace
}  // namespace lamina
