// SPDX-License-Identifier: Apache-2.0
#include "lamina/image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/png.h"
#include "lamina/session.h"
#include "lamina/study.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

TEST(PictureComparison, HasNormsByChannelAndTheWorstPixel) {
    PreciseImage a(2, 1), b(2, 1);
    a.pixel(1, 0)[2] = 3.0 / 255;
    a.pixel(0, 0)[2] = 1.0 / 255;
    b.pixel(1, 0)[3] = 2.0 / 255;
    const PictureComparison found = compare(a, b);
    EXPECT_EQ(found.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(found.all.linf, 3);
    EXPECT_EQ(found.of_channel[2].mean, 2);
    EXPECT_EQ(found.of_channel[3].mean, -1);
    EXPECT_EQ(found.column, 1);
    EXPECT_EQ(found.channel, 2u);
    EXPECT_EQ(difference_png(a, b, 3).substr(1, 3), "PNG");
    for (const double range : {0., -1., HUGE_VAL, static_cast<double>(NAN)}) {
        expect_error([&] { difference_png(a, b, range); }, {"range", "finite number above 0"});
        expect_error([&] { difference_codes(std::vector<float>{1}, range); }, {"range", "finite"});
    }
    expect_error([&] { compare(a, PreciseImage(1, 2)); }, {"2 x 1", "1 x 2"});
}

// The first and last colours and the middle one are those that the colour map is defined by. A
// picture of one pixel, above its colour bar, shows that difference_png() uses the same colours.
TEST(DifferenceCodes, AreThoseOfTheDifferencePicture) {
    const std::vector<float> differences = {-9, -2, 0, 1, 2};
    const std::vector<std::uint8_t> codes = difference_codes(differences, 2);
    ASSERT_EQ(codes.size(), 15u);
    const auto of = [&](std::size_t i) {
        return std::vector<int>(codes.begin() + 3 * static_cast<std::ptrdiff_t>(i),
                                codes.begin() + 3 * static_cast<std::ptrdiff_t>(i + 1));
    };
    EXPECT_EQ(of(0), (std::vector<int>{5, 48, 97}));
    EXPECT_EQ(of(1), of(0));
    EXPECT_EQ(of(2), (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(of(4), (std::vector<int>{103, 0, 31}));
    const TemporaryFolder folder;
    PreciseImage a(1, 1);
    a.pixel(0, 0)[1] = 1.0 / 255;
    write_bytes_to(folder.path() / "d.png", difference_png(a, PreciseImage(1, 1), 2));
    const CodedImage picture = read_png(folder.path() / "d.png");
    EXPECT_EQ((std::vector<int>(picture.codes.begin(), picture.codes.begin() + 3)), of(3));
    expect_error([&] { difference_codes(differences, 0); }, {"range"});
    expect_error([&] { difference_codes(std::vector<float>{0, NAN}, 1); }, {"1", "nan"});
}

TEST(PictureFiles, KeepPrecisionAndColorSpace) {
    const TemporaryFolder folder;
    PreciseImage precise(3, 2);
    precise.pixel(2, 1)[0] = 1.0 / 3;
    precise.pixel(2, 1)[3] = 0.5;
    const Image picture = to_float(precise);
    save_picture(precise, folder.path() / "a.npy");
    EXPECT_EQ(load_picture(folder.path() / "a.npy").image.rgba, precise.rgba);
    precise.space = ImageColorSpace::display;
    save_picture(precise, folder.path() / "a.exr", {}, {{"note", "x"}});
    const LoadedPicture exr = load_picture(folder.path() / "a.exr");
    EXPECT_EQ(exr.space, ImageColorSpace::display);
    EXPECT_EQ(exr.image.space, ImageColorSpace::display);
    expect_error([&] { compare(exr.image, to_double(picture)); }, {"display", "linear"});
    expect_error([&] { error_of(picture, exr.image); }, {"display", "linear"});
    EXPECT_EQ(to_float(exr.image).rgba, picture.rgba);
    save_picture(picture, folder.path() / "a.png", glm::dvec3(0, 0, 1));
    EXPECT_EQ(compare_files(folder.path() / "a.npy", folder.path() / "a.npy").all.linf, 0);
    EXPECT_EQ(compare_files(folder.path() / "a.png", folder.path() / "a.png").channels.size(), 3u);
    expect_error([&] { load_picture(folder.path() / "a.png"); }, {"a.png", ".exr"});
    EXPECT_EQ(picture_png(picture, glm::dvec3(0, 0, 1)).substr(1, 3), "PNG");
}

// Half a code of 16 bits is 8e-6; the curve's largest slope is 2.3.
TEST(PictureFiles, PngFilesWithAlphaAreAssociatedLinearLightAgain) {
    const TemporaryFolder folder;
    PreciseImage precise(2, 1);
    precise.rgba = {.1, .2, 0, .4, .9, 1e-4, .5, 1};
    save_picture(precise, folder.path() / "a.png", {{}, true, 16});
    const LoadedPicture back = load_picture(folder.path() / "a.png");
    EXPECT_EQ(back.image.space, ImageColorSpace::linear);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(back.image.rgba[i], precise.rgba[i], 3e-5);
    expect_error([&] { save_picture(precise, folder.path() / "a.JPEG"); },
                 {"a.JPEG", "JPEG would add errors", ".png, .exr or .npy"});
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.JPEG"));
}

constexpr const char* small_scene =
    R"({"version": 1, "volume": {"generate": "gaussians", "size": [12, 12, 12]},
        "transfer_function": {"points": [{"value": 0, "color": "red", "extinction": 0},
                                         {"value": 255, "color": "blue", "extinction": 4}]},
        "camera": {"eye": [2, 1, 2], "center": [0.5, 0.5, 0.5]},
        "image": {"width": 16, "height": 12}})";

TEST(Session, DrawsIntoTheCallersPicture) {
    const TemporaryFolder folder;
    write_bytes_to(folder.path() / "scene.json", small_scene);
    Session session(load_scene(folder.path() / "scene.json"), {ContextChoice::cpu, 0});
    Image own;
    session.draw(own);
    const float* const memory = own.rgba.data();
    EXPECT_EQ(own.rgba, session.draw().rgba);
    session.draw(own);
    EXPECT_EQ(own.rgba.data(), memory);
    session.trace();
    EXPECT_GT(session.trace_statistics().trace_error, 0);
    EXPECT_LT(session.trace_statistics().trace_error, 255e-5);
    EXPECT_EQ(session.trace_statistics().drawn_by, "reference tracer");
    EXPECT_EQ(session.statistics().trace_error, 0);  // statistics() are those of the drawn picture
}

TEST(Study, WritesOnlyToAnEmptyFolderUnlessResumed) {
    const TemporaryFolder folder;
    write_bytes_to(folder.path() / "scene.json", small_scene);
    write_bytes_to(folder.path() / "study.json",
                   R"({"version": 1, "scenes": ["scene.json"], "rounds": 1, "frames": 1,
                       "base": {"context": "cpu", "render.slice.classification": "post"},
                       "sweep": {"render.slice.samples": [4, 8]}})");
    const std::filesystem::path study = folder.path() / "study.json", out = folder.path() / "out";
    EXPECT_EQ(run_study(study, out).runs, 2u);
    EXPECT_TRUE(std::filesystem::exists(out / "results.csv"));
    expect_error([&] { run_study(study, out); }, {"out", "holds this study", "resume"});
    EXPECT_TRUE(run_study(study, out, true).failures.empty());
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(run_study(study, folder.path() / "other", false, stop.get_token()), Interrupted);
}

}  // namespace
}  // namespace lamina
