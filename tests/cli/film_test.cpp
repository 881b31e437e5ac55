// SPDX-License-Identifier: Apache-2.0
// Films of lamina render, decoded by other programs and held against the pictures that the same
// options write.
#include "cli/film_test_case.h"

#include <array>
#include <cmath>
#include <set>

namespace lamina {
namespace {

using nlohmann::json;
using Names = std::vector<std::string>;

constexpr std::size_t pixels = 48 * 36;

class Film : public FilmTest {
  protected:
    void SetUp() override {
        FilmTest::SetUp();
        if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    }
    // Writes the four views of a turntable. Returns their codes.
    std::string write_views(const std::vector<std::string>& more = {}) {
        Names options{"--turntable", "4"};
        options.insert(options.end(), more.begin(), more.end());
        render_well("v_%d.png", options);
        return codes_of({"v_0.png", "v_1.png", "v_2.png", "v_3.png"});
    }
    // Returns what ffprobe says of a film: "key=value" lines.
    std::string probed(const std::string& film) const {
        return run_program({"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                            "stream=codec_name,pix_fmt,color_range,color_space,color_transfer,"
                            "color_primaries,nb_read_frames,r_frame_rate:stream_tags=alpha_mode",
                            "-of", "default=nw=1", folder / film})
            .out;
    }
    void expect_probed(const std::string& film, const Names& lines) const {
        const std::string said = probed(film);
        for (const std::string& line : lines)
            EXPECT_NE(("\n" + said).find("\n" + line + "\n"), std::string::npos) << line << said;
    }
};

// Numbers of a frame's luma of BT.709 in limited range.
std::vector<double> luma_of(const std::string& rgb, std::size_t frame) {
    std::vector<double> luma;
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto code = [&](std::size_t c) {
            return static_cast<unsigned char>(rgb[3 * (frame * pixels + i) + c]) / 255.0;
        };
        luma.push_back(16 + 219 * (.2126 * code(0) + .7152 * code(1) + .0722 * code(2)));
    }
    return luma;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// Expects four frames whose luma differs from the views' by at most `most` (root mean square), and
// by less from its own view's than from any other's. `planes`: bytes of a decoded frame, luma
// first.
void expect_views(const std::string& film, std::size_t planes, const std::string& views,
                  double most) {
    ASSERT_EQ(film.size(), 4 * planes);
    for (std::size_t frame = 0; frame < 4; ++frame) {
        std::vector<double> luma;
        for (std::size_t i = 0; i < pixels; ++i)
            luma.push_back(static_cast<unsigned char>(film[frame * planes + i]));
        const double own = rms(luma, luma_of(views, frame));
        EXPECT_LE(own, most) << frame;
        for (std::size_t other = 0; other < 4; ++other) {
            if (other != frame) {
                EXPECT_LT(own, rms(luma, luma_of(views, other))) << frame << " " << other;
            }
        }
    }
}

TEST_F(Film, ApngIsThePicturesBitForBit) {
    EXPECT_NE(render_well("film.apng", {"--turntable", "4", "--fps", "10"})
                  .find("film.apng, 4 frames, 10 a second"),
              std::string::npos);
    EXPECT_EQ(decoded("film.apng", "rgb24"), write_views());
    expect_probed("film.apng", {"codec_name=apng", "nb_read_frames=4", "r_frame_rate=10/1"});
    render_well("clear.apng", {"--turntable", "4", "--transparent"});
    EXPECT_EQ(decoded("clear.apng", "rgba"), write_views({"--transparent"}));
    // No film replaces what others wrote beside it, and the folder has only what was asked for.
    EXPECT_FALSE(std::filesystem::exists(folder / "film.apng.frames"));
}

// Another decoder: PIL also says how long frames are shown, and that the film goes on for ever.
TEST_F(Film, PillowReadsApngAndGif) {
    const std::string read = R"(
import sys
from PIL import Image
film = Image.open(sys.argv[1])
for i in range(film.n_frames):
    film.seek(i)
    print(film.n_frames, film.info["duration"], film.info.get("loop"), film.info.get("bbox"))
    sys.stdout.flush()
    open(f"{sys.argv[1]}.{i}", "wb").write(film.convert("RGBA").tobytes()))";
    if (run_program({"/usr/bin/python3", "-c", "import PIL"}).exit_code != 0) GTEST_SKIP();
    render_well("film.apng", {"--turntable", "4", "--transparent", "--fps", "8"});
    const std::string views = write_views({"--transparent"});
    const auto found = run_program({"/usr/bin/python3", "-c", read, folder / "film.apng"});
    EXPECT_EQ(found.out.substr(0, 10), "4 125.0 0 ") << found.out << found.err;
    std::string film;
    for (const char* end : {".0", ".1", ".2", ".3"})
        film += read_bytes_of(folder / (std::string("film.apng") + end));
    EXPECT_EQ(film, views);
    render_well("film.gif", {"--turntable", "4", "--fps", "10"});
    const auto gif = run_program({"/usr/bin/python3", "-c", read, folder / "film.gif"});
    EXPECT_EQ(gif.out.substr(0, 8), "4 100 0 ") << gif.out << gif.err;
}

// CRF 18 quantises with steps of about 9 codes at most (QP 23); the error of a coefficient is at
// most 2/3 of a step with x264's dead zones, and the transform is orthonormal.
TEST_F(Film, Mp4IsH264In709) {
    render_well("film.mp4", {"--turntable", "4"});
    const std::string views = write_views();
    expect_probed("film.mp4", {"codec_name=h264", "pix_fmt=yuv420p", "color_range=tv",
                               "color_space=bt709", "color_transfer=bt709", "color_primaries=bt709",
                               "nb_read_frames=4", "r_frame_rate=25/1"});
    expect_views(decoded("film.mp4", "yuv420p"), pixels * 3 / 2, views, 6);
}

// Flat patches: luma and chroma of BT.709, within 2 codes for rounding and coding. BT.601 would
// give a luma of 81, 145 and 41 in place of 63, 173 and 32.
TEST_F(Film, PatchesHaveTheMatrixOf709) {
    struct Patch {
        const char* color;
        std::array<double, 3> code;
    };
    for (const auto& [color, code] :
         {Patch{"#ff0000", {62.6, 102.3, 240}}, Patch{"#00ff00", {172.6, 41.7, 26.3}},
          Patch{"#0000ff", {31.8, 240, 117.7}}}) {
        json scene = gaussians_scene(8, 48, 36, 4);
        scene["transfer_function"]["points"][1]["extinction"] = 0;
        scene["image"]["background"] = color;
        write_scene(scene);
        for (const std::string film : {"patch.mp4", "patch.webm"}) {
            render_well(film, {"--turntable", "2"});
            const std::string planes = decoded(film, "yuv420p");
            ASSERT_EQ(planes.size(), 2 * pixels * 3 / 2) << film;
            const std::array<std::size_t, 3> middle{pixels / 2 + 24, pixels + pixels / 8 + 12,
                                                    pixels * 5 / 4 + pixels / 8 + 12};
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(static_cast<unsigned char>(planes[middle[i]]), code[i], 2)
                    << film << color << i;
        }
    }
}

TEST_F(Film, WebmIsVp9WithAlphaIfTransparent) {
    render_well("film.webm", {"--turntable", "4"});
    const std::string views = write_views();
    expect_probed("film.webm", {"codec_name=vp9", "pix_fmt=yuv420p", "color_range=tv",
                                "color_space=bt709", "nb_read_frames=4"});
    expect_views(decoded("film.webm", "yuv420p"), pixels * 3 / 2, views, 6);
    render_well("clear.webm", {"--turntable", "4", "--transparent"});
    expect_probed("clear.webm", {"TAG:alpha_mode=1", "nb_read_frames=4"});
    const std::string film = decoded("clear.webm", "yuva420p", "libvpx-vp9");
    const std::string clear = write_views({"--transparent"});
    ASSERT_EQ(film.size(), 4 * pixels * 5 / 2);
    for (std::size_t frame = 0; frame < 4; ++frame) {
        std::vector<double> alpha, expected;
        for (std::size_t i = 0; i < pixels; ++i) {
            alpha.push_back(
                static_cast<unsigned char>(film[frame * pixels * 5 / 2 + pixels * 3 / 2 + i]));
            expected.push_back(static_cast<unsigned char>(clear[4 * (frame * pixels + i) + 3]));
        }
        EXPECT_LE(rms(alpha, expected), 6) << frame;
        // Views are not opaque everywhere, nor clear.
        EXPECT_GT(*std::ranges::max_element(expected), 200);
        EXPECT_LT(*std::ranges::min_element(expected), 50);
    }
}

TEST_F(Film, GifHasOnePalette) {
    render_well("film.gif", {"--turntable", "4", "--fps", "10"});
    const std::string views = write_views(), film = decoded("film.gif", "rgb24");
    ASSERT_EQ(film.size(), views.size());
    std::set<std::string> colors;
    for (std::size_t i = 0; i < film.size(); i += 3) colors.insert(film.substr(i, 3));
    EXPECT_LE(colors.size(), 256u);
    EXPECT_GT(colors.size(), 50u);
    for (std::size_t frame = 0; frame < 4; ++frame) {
        const auto luma = luma_of(film, frame);
        for (std::size_t other = 0; other < 4; ++other) {
            if (other != frame) {
                EXPECT_LT(rms(luma, luma_of(views, frame)), rms(luma, luma_of(views, other)));
            }
        }
    }
}

// Six frames of a path: those at keyframes are the pictures of the scene with these cameras.
TEST_F(Film, APathShowsItsKeyframes) {
    json path;
    const std::array<json, 3> eyes{json{1.7, -0.9, 1.3}, json{1.9, 1.5, .2}, json{-1, 1.5, .9}};
    for (std::size_t i = 0; i < 3; ++i) {
        path["keyframes"].push_back(
            {{"time", .5 * static_cast<double>(i)},
             {"camera", {{"eye", eyes[i]}, {"center", {.5, .5, .5}}, {"up", {0, 0, 1}}}}});
    }
    write_bytes_to(folder / "path.json", path.dump());
    render_well("film.apng", {"--path", folder / "path.json", "--fps", "5"});
    render_well("p_%d.png", {"--path", folder / "path.json", "--fps", "5"});
    const std::string film = decoded("film.apng", "rgb24");
    EXPECT_EQ(film, codes_of({"p_0.png", "p_1.png", "p_2.png", "p_3.png", "p_4.png", "p_5.png"}));
    render_well("film2.apng", {"--path", folder / "path.json", "--fps", "4"});
    for (std::size_t i = 0; i < 3; ++i) {
        render_well("key.png", {"--set", "camera.eye=" + eyes[i].dump()});
        EXPECT_EQ(decoded("film2.apng", "rgb24").substr(2 * i * 3 * pixels, 3 * pixels),
                  codes_of({"key.png"}));
    }
    path["keyframes"][1]["time"] = 0;
    write_bytes_to(folder / "path.json", path.dump());
    expect_refusal(1, "bad.apng", {"--path", folder / "path.json"},
                   {"path.json: keyframes.1.time: found 0"});
}

TEST_F(Film, StepsOfTimeAreFrames) {
    for (int step = 0; step < 3; ++step) {
        const std::string name = "g" + std::to_string(step) + ".nrrd";
        ASSERT_EQ(lamina_run({"generate", step == 1 ? "mixing" : "gaussians", "-o", folder / name,
                              "--size", "8,8,8"})
                      .exit_code,
                  0);
    }
    json scene = gaussians_scene(16, 48, 36, 40);
    scene["volume"] = "g%d.nrrd";
    write_scene(scene);
    render_well("film.apng", {"--time", "0:2"});
    render_well("t_%d.png", {"--time", "0:2"});
    EXPECT_EQ(decoded("film.apng", "rgb24"), codes_of({"t_0.png", "t_1.png", "t_2.png"}));
}

}  // namespace
}  // namespace lamina
