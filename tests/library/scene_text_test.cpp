// SPDX-License-Identifier: Apache-2.0
#include "lamina/scene.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "lamina/mesh.h"
#include "lamina/session.h"
#include "lamina/volume.h"
#include "support/expect_error.h"
#include "support/split_box.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

Volume ramp(int size) {
    auto samples = std::make_shared<std::vector<std::uint8_t>>();
    for (int i = 0; i < size * size * size; ++i)
        samples->push_back(static_cast<std::uint8_t>(i % size));
    Grid grid;
    grid.size = {size, size, size};
    grid.centering = {Centering::node, Centering::node, Centering::node};
    const std::uint8_t* const first = samples->data();
    return {grid, SampleType::uint8, {std::move(samples), first}};
}

TEST(SceneText, ComesBackUnchangedFromParsing) {
    const std::string text =
        R"({"version": 1, "volume": {"generate": "ramp"}, "image": {"width": 31},
            "transfer_function": {"points": [{"value": 0.1, "extinction": 3}]}})";
    const std::string full = scene_text(parse_scene(text, "scene"));
    EXPECT_NE(full.find("\"width\": 31"), std::string::npos);
    EXPECT_EQ(scene_text(parse_scene(full, "scene")), full);
}

TEST(SceneText, ErrorsNameTheFileAndPathsStartAtItsFolder) {
    expect_error([] { parse_scene(R"({"version": 1, "volmue": "a"})", "mine"); },
                 {"mine", "volume"});
    expect_error([] { parse_scene("{", "mine"); }, {"mine: parse error"});
    const Scene scene = parse_scene(R"({"version": 1, "volume": "a.nrrd"})", "/there/scene.json");
    EXPECT_EQ(scene.volume_file()->path, "/there/a.nrrd");
}

TEST(SceneText, NeedsNoFileNamesForDataInMemory) {
    const Volume volume = ramp(8);
    // The colour map is stretched over the volume's values, 0 to 7.
    const std::string text =
        R"({"version": 1, "transfer_function": {"colormap": "greys",
            "points": [{"value": 0, "extinction": 1}]}})";
    expect_error([&] { parse_scene(text, "scene"); }, {"volume"});
    const Scene scene = parse_scene(text, "scene", volume);
    EXPECT_EQ(scene.method, Method::slice);
    EXPECT_EQ(chosen_transfer_function(scene, volume).knots().back().value, 7);
    EXPECT_EQ(parse_scene(R"({"version": 1, "mesh": {"kuhn": true},
                              "render": {"method": "project"}})",
                          "scene", volume)
                  .method,
              Method::project);
    const MeshData mesh = test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return 5 * p.x; });
    const Scene of_mesh = parse_scene(text, "scene", mesh);
    EXPECT_EQ(of_mesh.method, Method::project);
    EXPECT_EQ(of_mesh.trace_of, TraceOf::mesh);
    expect_error(
        [&] { parse_scene(R"({"version": 1, "render": {"method": "slice"}})", "scene", mesh); },
        {"render.method"});
}

TEST(CameraChoice, IsTheAutomaticCamera) {
    const Volume volume = ramp(8);
    Scene scene;
    scene.transfer_function = automatic;
    scene.camera = automatic;
    const Camera camera = fitted_camera(scene, volume);
    EXPECT_EQ(camera.eye, Session(scene, volume).chosen_scene().camera->eye);
    EXPECT_NE(fitted_camera(scene, volume, 40, 10).eye, camera.eye);
}

TEST(DataFiles, ComeBackBitForBit) {
    const TemporaryFolder folder;
    const Volume volume = ramp(5);
    save_volume(volume, folder.path() / "a.nrrd");
    EXPECT_EQ(kind_of_file(folder.path() / "a.nrrd"), FileKind::volume);
    const Volume again = load_volume(folder.path() / "a.nrrd");
    ASSERT_EQ(again.byte_count(), volume.byte_count());
    EXPECT_EQ(std::memcmp(again.data(), volume.data(), volume.byte_count()), 0);
    const MadeMesh made = make_mesh(volume, {.kuhn = true});
    EXPECT_EQ(made.report.tets, 6 * 4 * 4 * 4);
    save_mesh(made.mesh, folder.path() / "a.vtu");
    EXPECT_EQ(kind_of_file(folder.path() / "a.vtu"), FileKind::mesh);
    EXPECT_EQ(load_mesh_data(folder.path() / "a.vtu").points, made.mesh.points);
    expect_error([&] { save_volume(volume, folder.path() / "a.vti"); }, {"a.vti", ".nrrd"});
    expect_error([&] { save_mesh(made.mesh, folder.path() / "a.stl"); }, {"a.stl", ".vtu"});
}

TEST(DataFiles, AreToldFromScenesByTheirBeginning) {
    const TemporaryFolder folder;
    for (const char* const name : {"scene.data", "s.nrrd", "s.vtu", "s.tif"}) {
        std::ofstream(folder.path() / name) << " {\"version\": 1}";
        EXPECT_EQ(kind_of_file(folder.path() / name), FileKind::scene);
    }
    for (const char* const samples : {"samples", "{{{{ samples", "{\x01\"samples", "{"}) {
        std::ofstream(folder.path() / "samples.data") << samples;
        expect_error([&] { kind_of_file(folder.path() / "samples.data"); },
                     {"samples.data", "found samples without a header", "--raw"});
    }
}

TEST(MeshMaking, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(make_mesh(ramp(40), {.kuhn = true}, nullptr, stop.get_token()), Interrupted);
}

}  // namespace
}  // namespace lamina
