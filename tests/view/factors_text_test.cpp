// SPDX-License-Identifier: Apache-2.0
#include "model/factors_text.h"

#include <gtest/gtest.h>

#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

Scene scene_of(const std::string& render) {
    return parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians"}, "mesh": {"kuhn": true},
                           "render": )" +
            render + "}",
        "scene.json");
}

TEST(FactorsText, IsReadAsInSceneFiles) {
    const Scene scene = scene_of(R"({"target": "fixed8", "slice": {"samples": 512}})");
    EXPECT_EQ(factors_text(scene), "none");
    for (const char* const text : {"[16, 8, 4]", " [16,8,4] ", "16x8x4"})
        EXPECT_EQ(factors_text(with_factors(scene, text)), "[16, 8, 4]") << text;
    EXPECT_EQ(factors_text(with_factors(scene, "4^3")), "[4, 4, 4]");
    EXPECT_EQ(factors_text(with_factors(scene, "1024")), "[1024]");
    const Scene chosen = with_factors(scene, "auto");
    EXPECT_EQ(factors_text(chosen), "auto");
    EXPECT_EQ(factors_text(with_factors(chosen, "[2, 2]")), "[2, 2]");
    for (const char* const text : {"", "none", "  "})
        EXPECT_EQ(factors_text(with_factors(chosen, text)), "none") << text;
}

TEST(FactorsText, LeavesTheRestOfTheTree) {
    const Scene scene = scene_of(
        R"({"target": "fixed8", "slice": {"tree": {"factors": [8, 8], "code": "phi",
            "alpha_bits": 16}}})");
    const Scene changed = with_factors(scene, "[4, 4]");
    EXPECT_EQ((*changed.slice.tree)->code, NodeCode::phi);
    EXPECT_EQ((*changed.slice.tree)->alpha_bits, 16);
    EXPECT_EQ((*changed.slice.tree)->factors, (std::vector<int>{4, 4}));
}

TEST(FactorsText, GivesTreesOfTetsFixedNodes) {
    Scene scene = scene_of(R"({"method": "project", "target": "fixed8"})");
    scene = with_factors(scene, "[64]");
    ASSERT_TRUE(scene.project.tree);
    EXPECT_EQ((*scene.project.tree)->nodes, NodeArithmetic::fixed);
    EXPECT_FALSE(scene.slice.tree);
    EXPECT_EQ(factors_text(scene), "[64]");
}

TEST(FactorsText, NamesInvalidFactors) {
    const Scene scene = scene_of(R"({"target": "fixed8"})");
    for (const char* const text : {"[16, 8", "[]", "[0]", "[1.5]", "[70000]", "[\"a\"]", "16y8",
                                   "16x", "-4", "[2,2,2,2,2,2,2,2,2,2,2,2,2,2,2,2,2]", "{}"}) {
        try {
            with_factors(scene, text);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find("factors"), std::string::npos) << text << ": " << message;
            EXPECT_NE(message.find("expected"), std::string::npos) << text << ": " << message;
        }
    }
    EXPECT_THROW(with_factors(scene_of(R"({"method": "trace"})"), "[2, 2]"), Error);
}

}  // namespace
}  // namespace lamina::view
