// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "gl/gl_fixture.h"
#include "papers/lamar.h"
#include "papers/lamar_stage.h"
#include "papers/palette_slices.h"
#include "support/temporary_folder.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

class LamarDrawn : public gl::GlTest {};

TEST_F(LamarDrawn, Figure10OnASmallPicture) {
    const TemporaryFolder folder;
    LamarStage stage(capabilities(), 32);
    const Json figure = draw_figure10(folder.path(), stage);
    std::vector<std::string> labels;
    for (const Json& panel : figure["values"]["panels"]) {
        labels.push_back(panel["title"]);
        EXPECT_TRUE(panel["image"].get<std::string>().starts_with("data:image/png;base64,"));
    }
    EXPECT_EQ(labels,
              (std::vector<std::string>{"software", "straight", "4x256", "8x8x16", "2^10",
                                        "coloured software", "coloured 32x32 of shader nodes"}));
    std::map<std::string, double> linf;
    for (const Json& row : figure["values"]["rows"]) {
        const std::string name =
            row["nodes"].get<std::string>() + " " + row["tree"].get<std::string>() + " " +
            row["alpha"].get<std::string>() + " " + row["colors"].get<std::string>();
        linf[name] = row["linf"];
    }
    EXPECT_EQ(linf.size(), 20u);
    // Every opacity is below one code, .0014 of full scale at most: nothing is drawn, and the error
    // is the largest opacity, .765 or less (mixing_scene.h).
    const double nothing = linf.at("fixed straight truncate white");
    EXPECT_GT(nothing, 150);
    EXPECT_LT(nothing, 195.1);
    EXPECT_LT(linf.at("fixed 2^10 nearest white"), 0.2 * nothing);
    // The bound of 32x32 at N = 1024 in tests/slicing/tree_test.cpp.
    EXPECT_LE(linf.at("shader 32x32 minimax white"), 2.2);
    EXPECT_LE(linf.at("shader 32x32 minimax green to red"), 2.2);
}

TEST_F(LamarDrawn, BothWaysOfPalettesGiveOnePicture) {
    const Image lookup = PaletteSlices(PaletteSlices::Way::lookup, 32, 40, 16).draw();
    const Image upload = PaletteSlices(PaletteSlices::Way::upload, 32, 40, 16).draw();
    EXPECT_EQ(lookup.rgba, upload.rgba);
    EXPECT_GT(lookup.rgba[0], 0);
}

}  // namespace
}  // namespace lamina::papers
