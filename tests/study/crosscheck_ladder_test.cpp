// SPDX-License-Identifier: Apache-2.0
// The meshes of a cross-check's ladder, and where it ends.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "study/crosscheck.h"
#include "support/transfer_functions.h"
#include "tiles/cpu_capabilities.h"

namespace lamina::study {
namespace {

class CrosscheckLadder : public testing::Test {
  protected:
    void SetUp() override {
        const std::filesystem::path program = LAMINA_TETRAHEDRALIZE_BINARY;
        if (program.empty()) GTEST_SKIP() << "built without TetGen";
        const std::string path = program.parent_path().string() + ":" + std::getenv("PATH");
        setenv("PATH", path.c_str(), 1);
        scene.volume = GeneratorRequest{"gaussians", std::array<std::int64_t, 3>{12, 12, 12},
                                        SampleType::float32};
        scene.transfer_function = test::smooth();
        scene.camera->eye = {1.7, -.9, 1.3};
        scene.camera->center = {.5, .5, .5};
        scene.width = 12;
        scene.height = 9;
        scene.max_error = 1e-6;  // never reached: the ladder ends by its tets
        settings.samples = {8};
        settings.ladder_tets = 2000;
        settings.say = [this](const std::string& text) { said += text; };
    }
    Crosscheck made() const { return crosscheck(scene, settings, cpu_capabilities()); }

    Scene scene;
    CrosscheckSettings settings;
    std::string said;
};

TEST_F(CrosscheckLadder, EndsWithTheFirstMeshOfTooManyTets) {
    const Crosscheck ladder = made();
    EXPECT_NE(said.find("meshes of up to 2000 tets"), std::string::npos) << said;
    ASSERT_GT(ladder.projections.size(), 1u);
    EXPECT_LT(ladder.projections.size(), 7u);
    for (const Crosscheck::Projection& each : ladder.projections) {
        EXPECT_LE(each.tets, 2000);
        EXPECT_EQ(each.stopped, &each == &ladder.projections.back());
    }
    // The scene states no mesh: its pictures are those of tolerance .02, or of the last mesh before
    // it.
    EXPECT_EQ(ladder.tolerance, std::max(.02, ladder.projections.back().tolerance));
    EXPECT_FALSE(ladder.pictures.projected.rgba.empty());
}

TEST_F(CrosscheckLadder, DrawsTheScenesOwnMeshInAnyCase) {
    scene.mesh = MeshSettings{.tolerance = .0005, .max_tets = 4000};
    const Crosscheck ladder = made();
    EXPECT_NE(said.find("meshes of up to 4000 tets"), std::string::npos) << said;
    ASSERT_GT(ladder.projections.size(), 2u);
    const Crosscheck::Projection &own = ladder.projections.back(),
                                 &last = ladder.projections[ladder.projections.size() - 2];
    EXPECT_EQ(own.tolerance, .0005);
    EXPECT_GT(own.tets, 2000);
    EXPECT_LE(own.tets, 4000);
    EXPECT_TRUE(last.stopped);
    EXPECT_LE(last.tets, 2000);
    EXPECT_EQ(ladder.tolerance, .0005);
}

TEST_F(CrosscheckLadder, DrawsAllThatWasAskedFor) {
    settings.ends_by_itself = false;
    settings.tolerances = {.1, .01};
    scene.mesh = MeshSettings{.tolerance = .05, .max_tets = 2000};
    const Crosscheck ladder = made();
    ASSERT_EQ(ladder.projections.size(), 3u);
    EXPECT_EQ(ladder.tolerance, .05);
    for (const Crosscheck::Projection& each : ladder.projections) EXPECT_LE(each.tets, 2000);
}

}  // namespace
}  // namespace lamina::study
