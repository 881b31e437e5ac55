// SPDX-License-Identifier: Apache-2.0
// A SceneRenderer whose scene changes, compared bit for bit with `lamina render` of the resolved
// scenes.
#include "render/scene_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "scene_files/scene_reader.h"
#include "support/temporary_folder.h"
#include "support/transfer_functions.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

using test::knot;

class SceneRendererAndProgram : public testing::Test {
  protected:
    void expect_the_programs(SceneRenderer& frames, const std::string& what) {
        const Image drawn = frames.draw_picture();
        save_scene(frames.resolved().scene(), folder / "resolved.json");
        const ProgramResult result = lamina_run(
            {"render", folder / "resolved.json", "-o", folder / "fresh.exr", "--context", "cpu"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const Image fresh = read_exr(folder / "fresh.exr");
        EXPECT_EQ(drawn.rgba, fresh.rgba) << what;
    }

    static void turn(SceneRenderer& frames, double degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        Camera camera = *frames.scene().camera;
        camera.eye = camera.center + glm::dvec3(2 * std::sin(angle), .7, 2 * std::cos(angle));
        frames.set_camera(camera);
    }

    Scene scene_of(nlohmann::json document) { return read_scene(document, folder / "scene.json"); }

    TemporaryFolder folder;
};

TEST_F(SceneRendererAndProgram, DrawTheSameSlabs) {
    nlohmann::json document = gaussians_scene(24, 40, 30, 60);
    document["render"]["slice"]["classification"] = "preintegrated";
    document["render"]["slice"]["samples"] = "auto";
    const Scene scene = scene_of(document);
    SceneRenderer frames(scene, std::make_shared<const VolumeData>(load_volume(scene)),
                         cpu_capabilities());
    expect_the_programs(frames, "the first picture");
    int changes = 0;
    for (int degrees = 18; degrees < 360; degrees += 18) {
        turn(frames, degrees);
        if (degrees % 54 == 0) {
            frames.set_transfer_function(TransferFunction::linear(
                {knot(20, {1, .2, 0}, 0), knot(90. + degrees / 5., {1, 1, 0}, degrees / 9.),
                 knot(255, {0, .3, 1}, 2)}));
        } else if (degrees % 72 == 0) {
            Scene other = frames.scene();
            other.target = Target::fixed16;
            if (changes++ % 2 == 0) other.target = automatic;
            other.max_error = 2;
            frames.set_scene(other);
        }
        expect_the_programs(frames, "turned by " + std::to_string(degrees));
    }
}

TEST_F(SceneRendererAndProgram, DrawTheSameTets) {
    nlohmann::json document = gaussians_scene(9, 40, 30, 60);
    document["mesh"] = {{"kuhn", true}};
    document["render"]["method"] = "project";
    document["render"]["target"] = "auto";
    const Scene scene = scene_of(document);
    SceneRenderer frames(scene, std::make_shared<const SceneMesh>(load_mesh(scene)),
                         cpu_capabilities());
    for (int degrees = 0; degrees < 360; degrees += 72) {
        turn(frames, degrees);
        expect_the_programs(frames, "turned by " + std::to_string(degrees));
    }
}

}  // namespace
}  // namespace lamina
