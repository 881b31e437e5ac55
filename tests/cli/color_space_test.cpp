// SPDX-License-Identifier: Apache-2.0
// Pictures in linear light and in display values, made and compared on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/coded_image.h"
#include "image/exr.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

class ColorSpaceFiles : public testing::Test {
  protected:
    void SetUp() override {
        nlohmann::json scene = gaussians_scene(16, 30, 20, 40);
        scene["transfer_function"]["points"][0]["color"] = "#2040c0";
        scene["transfer_function"]["points"][1]["color"] = {{"srgb", {1, .5, 0}}};
        scene["image"]["background"] = "rebeccapurple";
        scene["mesh"] = {{"kuhn", true}};
        write_bytes_to(folder / "scene.json", scene.dump());
    }

    void render(const std::string& name, const std::string& method, const std::string& space) {
        const ProgramResult result =
            lamina_run({"render", folder / "scene.json", "-o", folder / name, "--method", method,
                        "--context", "cpu", "--quiet", "--set", "image.color_space=" + space});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }

    TemporaryFolder folder;
};

// The PNG is the picture of the EXR over the background, encoded by sRGB if it is in linear light:
// the program writes both files from one picture.
TEST_F(ColorSpaceFiles, PngShowsWhatExrHolds) {
    const glm::dvec3 purple(0x66 / 255., 0x33 / 255., 0x99 / 255.);
    for (const char* const method : {"slice", "project", "trace"}) {
        for (const auto space : {ImageColorSpace::linear, ImageColorSpace::display}) {
            render("a.exr", method, name_of(space));
            render("a.png", method, name_of(space));
            EXPECT_EQ(color_space_of_exr(folder / "a.exr"), space);
            const Image exr = read_exr(folder / "a.exr");
            const CodedImage png = read_png(folder / "a.png");
            int shown = 0;
            for (std::size_t i = 0; i < png.codes.size(); ++i) {
                const std::size_t pixel = i / 3, channel = i % 3;
                const float* const rgba = &exr.rgba[4 * pixel];
                const double stored = purple[static_cast<int>(channel)];
                const double behind =
                    space == ImageColorSpace::display ? stored : linear_from_srgb(stored);
                const double value = rgba[channel] + (1. - rgba[3]) * behind;
                EXPECT_EQ(png.codes[i], display_code(value, space)) << method << " " << i;
                shown += rgba[3] > 0 ? 1 : 0;
            }
            EXPECT_GT(shown, 300);
        }
    }
}

// In display values, compositing averages display values. In linear light it averages light, and
// the encoded mean is at least as bright, because the curve of sRGB is concave.
TEST_F(ColorSpaceFiles, MeansOfLightAreBrighterThanMeansOfDisplayValues) {
    render("linear.png", "trace", "linear");
    render("display.png", "trace", "display");
    const auto linear = read_png(folder / "linear.png").codes;
    const auto display = read_png(folder / "display.png").codes;
    int brighter = 0;
    for (std::size_t i = 0; i < linear.size(); ++i) {
        // The tracer's error of 1e-5 becomes .03 of a code by the curve's slope of 12.92 at 0. So
        // where both pictures are nearly equal, they may round to neighbouring codes.
        EXPECT_GE(linear[i] + 1, display[i]);
        brighter += linear[i] > display[i] + 4 ? 1 : 0;
    }
    EXPECT_GT(brighter, 100);
}

TEST_F(ColorSpaceFiles, CompareRefusesToMixColorSpaces) {
    render("linear.exr", "slice", "linear");
    render("display.exr", "slice", "display");
    render("truth.exr", "trace", "display");
    EXPECT_EQ(
        lamina_run({"compare", folder / "display.exr", folder / "truth.exr", "--max-linf", "0.05"})
            .exit_code,
        0);
    const ProgramResult mixed =
        lamina_run({"compare", folder / "linear.exr", folder / "display.exr"});
    EXPECT_EQ(mixed.exit_code, 1);
    EXPECT_EQ(std::count(mixed.err.begin(), mixed.err.end(), '\n'), 1) << mixed.err;
    EXPECT_NE(mixed.err.find("display values"), std::string::npos) << mixed.err;
}

TEST_F(ColorSpaceFiles, AColormapIsFoundByItsName) {
    const auto named = [&](const std::string& name) {
        return lamina_run({"render", folder / "scene.json", "-o", folder / "map.png", "--context",
                           "cpu", "--quiet", "--set", "transfer_function.colormap=" + name, "--set",
                           R"(transfer_function.points=[{"value": 0, "opacity": 0},
                              {"value": 255, "opacity": 0.1}])"});
    };
    EXPECT_EQ(named("viridis").exit_code, 0) << named("viridis").err;
    const ProgramResult wrong = named("virdis");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("did you mean \"viridis\"?"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace lamina
