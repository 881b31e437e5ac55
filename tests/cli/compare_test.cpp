// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "base/output_file.h"
#include "cli/run_program.h"
#include "image/exr.h"
#include "image/npy.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Expects one line with all of `parts`.
void expect_one_line(const std::string& text, const std::vector<std::string>& parts) {
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
}

class Compare : public testing::Test {
  protected:
    // Writes picture a, all .5; b, which differs from a in pixel (2, 1): G + .25, B - .125; and a
    // small picture.
    void SetUp() override {
        PreciseImage image(4, 3);
        for (double& value : image.rgba) value = 0.5;
        write_all("a", image);
        image.pixel(2, 1)[1] += 0.25;
        image.pixel(2, 1)[2] -= 0.125;
        write_all("b", image);
        write_all("small", PreciseImage(2, 2));
    }

    void write_all(const std::string& stem, const PreciseImage& image) {
        AtomicFile exr(folder / (stem + ".exr")), npy(folder / (stem + ".npy")),
            png(folder / (stem + ".png"));
        write_exr(exr, to_float(image), {});
        write_npy(npy, image);
        write_png(png, to_float(image), glm::dvec3(0));
        exr.commit();
        npy.commit();
        png.commit();
    }

    ProgramResult compare(const std::string& a, const std::string& b,
                          const std::vector<std::string>& options = {}) {
        std::vector<std::string> arguments = {LAMINA_BINARY, "compare", folder / a, folder / b};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_program(arguments);
    }

    TemporaryFolder folder;
};

TEST_F(Compare, JsonHasTheNormsOfEveryChannel) {
    const ProgramResult result = compare("a.exr", "b.npy", {"--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    // One of 12 pixels has an error, -255/4 in G and 255/8 in B. These are exact binary fractions,
    // so only the division by 12 and the root round.
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.size(), 2u);
    EXPECT_EQ(json["channels"].size(), 4u);
    EXPECT_EQ(json["channels"]["R"]["linf"], 0);
    EXPECT_EQ(json["channels"]["G"]["linf"], 63.75);
    EXPECT_DOUBLE_EQ(json["channels"]["G"]["l1"], -63.75 / 12);
    EXPECT_DOUBLE_EQ(json["channels"]["G"]["l2"], 63.75 / std::sqrt(12.0));
    EXPECT_DOUBLE_EQ(json["channels"]["B"]["l1"], 31.875 / 12);
    EXPECT_EQ(json["channels"]["A"]["l2"], 0);
    EXPECT_EQ(json["all"]["linf"], 63.75);
    EXPECT_DOUBLE_EQ(json["all"]["l1"], (31.875 - 63.75) / 48);
    EXPECT_DOUBLE_EQ(json["all"]["l2"], 31.875 * std::sqrt(5.0 / 48));
}

TEST_F(Compare, TableNamesTheWorstPixel) {
    const ProgramResult result = compare("a.npy", "b.exr");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("pixel (2, 1), channel G: -63.75"), std::string::npos) << result.out;
    EXPECT_NE(compare("a.exr", "a.exr").out.find("equal"), std::string::npos);
}

TEST_F(Compare, PngsAreComparedAsStoredCodes) {
    const auto json = nlohmann::json::parse(compare("a.png", "b.png", {"--json"}).out);
    EXPECT_EQ(json["channels"].size(), 3u);
    EXPECT_EQ(json["channels"]["G"]["linf"], 225 - 188);  // sRGB of .75 and .5: 224.6, 187.5
}

TEST_F(Compare, ExitsWith3OnlyWhenOverTheLimit) {
    const ProgramResult over = compare("a.exr", "b.exr", {"--max-linf", "63.7", "--json"});
    EXPECT_EQ(over.exit_code, 3);
    EXPECT_EQ(nlohmann::json::parse(over.out)["all"]["linf"], 63.75);
    expect_one_line(over.err, {"63.75", "--max-linf 63.7"});
    EXPECT_EQ(compare("a.exr", "b.exr", {"--max-linf", "63.75"}).exit_code, 0);
    EXPECT_EQ(compare("a.exr", "a.exr", {"--max-linf", "0"}).exit_code, 0);
}

TEST_F(Compare, DiffShowsSignAndPlace) {
    const ProgramResult result = compare("a.exr", "b.exr", {"--diff", folder / "d.png"});
    EXPECT_EQ(result.exit_code, 0);
    expect_one_line(result.err, {"d.png", "63.75"});
    const CodedImage picture = read_png(folder / "d.png");
    ASSERT_GT(picture.width, 4);  // at least as wide as the colour bar below it
    ASSERT_GT(picture.height, 3 + 10);
    for (std::size_t pixel = 0; pixel < 12; ++pixel) {
        const std::size_t place = pixel / 4 * static_cast<std::size_t>(picture.width) + pixel % 4;
        const std::uint16_t* const rgb = &picture.codes[3 * place];
        if (pixel == 1 * 4 + 2) {
            EXPECT_LT(rgb[0], rgb[2]);  // A < B: blue
        } else {
            EXPECT_EQ(rgb[0] + rgb[1] + rgb[2], 3 * 255);
        }
    }
}

// With twice the range, colours are half as strong; with half the range, the message says that the
// error is beyond the scale.
TEST_F(Compare, RangeSetsTheColors) {
    const auto blue_of = [&](const std::string& range, const char* says) {
        const ProgramResult result =
            compare("a.exr", "b.exr", {"--diff", folder / "r.png", "--range", range});
        EXPECT_EQ(result.exit_code, 0);
        expect_one_line(result.err, {"-" + range, says});
        const CodedImage picture = read_png(folder / "r.png");
        return picture.codes[static_cast<std::size_t>(3 * (1 * picture.width + 2))];
    };
    EXPECT_EQ(blue_of("63.75", "(dark blue) over"), 5);
    EXPECT_EQ(blue_of("31.875", "(dark blue) and beyond over"), 5);
    EXPECT_EQ(blue_of("127.5", "(dark blue) over"), (146 + 67 + 1) / 2);  // between steps 2 and 3
}

TEST_F(Compare, ReportsBadInputInOneLineAndWritesNothing) {
    const auto expect_failure = [&](const std::string& a, const std::string& b,
                                    const std::vector<std::string>& parts) {
        const ProgramResult result = compare(a, b, {"--diff", folder / "d.png"});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out, "");
        expect_one_line(result.err, parts);
    };
    write_bytes_to(folder / "text.exr", "no image");
    write_bytes_to(folder / "cut.exr", read_bytes_of(folder / "a.exr").substr(0, 300));
    std::string with_nan = read_bytes_of(folder / "a.npy");  // its last number is A of pixel (3, 2)
    with_nan.replace(with_nan.size() - 8, 8, std::string("\0\0\0\0\0\0\xF8\x7F", 8));
    write_bytes_to(folder / "nan.npy", with_nan);
    const auto files_before = std::distance(std::filesystem::directory_iterator(folder.path()), {});
    expect_failure("a.exr", "absent.exr", {"absent.exr", "No such file"});
    expect_failure("text.exr", "a.exr", {"text.exr", "OpenEXR"});
    expect_failure("cut.exr", "a.exr", {"cut.exr", "OpenEXR"});
    expect_failure("a.exr", "nan.npy", {"nan.npy", "(3, 2)", "channel A", "nan"});
    expect_failure("a.exr", "small.npy", {"a.exr", "4 x 3", "small.npy", "2 x 2"});
    expect_failure("a.exr", "a.png", {"sRGB codes"});
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), files_before);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--diff", folder / "absent" / "d.png"}).exit_code, 1);
}

TEST_F(Compare, ExitsWith2ForBadUsage) {
    EXPECT_EQ(run_program({LAMINA_BINARY, "compare"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--nonsense"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--max-linf", "much"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--max-linf", "-1"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--max-linf", "nan"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--diff", folder / "d.jpg"}).exit_code, 2);
    EXPECT_EQ(compare("a.exr", "b.exr", {"--range", "3"}).exit_code, 2);
    for (const char* range : {"0", "-1", "nan", "inf", "much"}) {
        EXPECT_EQ(
            compare("a.exr", "b.exr", {"--diff", folder / "d.png", "--range", range}).exit_code, 2);
    }
}

TEST_F(Compare, HelpGoesToStdout) {
    const ProgramResult result = run_program({LAMINA_BINARY, "compare", "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    for (const char* word : {"--json", "--diff", "--range", "--max-linf"}) {
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
    }
}

TEST(Program, HasAVersionAndRefusesUnknownVerbs) {
    const ProgramResult version = run_program({LAMINA_BINARY, "--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("lamina ")) << version.out;
    EXPECT_EQ(run_program({LAMINA_BINARY}).exit_code, 2);
    const ProgramResult unknown = run_program({LAMINA_BINARY, "nonsense"});
    EXPECT_EQ(unknown.exit_code, 2);
    expect_one_line(unknown.err, {"lamina: ", "--help"});
}

// An automatic camera fits what shows: two transfer functions may have two cameras.
TEST_F(Compare, WarnsOfDifferentCameras) {
    const auto write = [&](const std::string& name, const std::string& scene) {
        AtomicFile file(folder / name);
        write_exr(file, Image(2, 2), {{"scene", scene}});
        file.commit();
    };
    write("one.exr", R"({"version": 1, "camera": {"eye": [0, 0, 5]}})");
    write("same.exr", R"({"camera": {"eye": [0, 0, 5]}, "volume": "other.nrrd"})");
    write("other.exr", R"({"version": 1, "camera": {"eye": [0, 0, 6]}})");
    write("open.exr", R"({"version": 1})");
    write("damaged.exr", "{");
    const std::string deep(100'000, '[');  // more than the stack holds
    write("deep.exr", R"({"camera": {"eye": )" + deep + std::string(deep.size(), ']') + "}}");
    const std::string warning = "were drawn with different cameras";
    EXPECT_NE(compare("one.exr", "other.exr").err.find(warning), std::string::npos);
    for (const char* const fine :
         {"same.exr", "open.exr", "damaged.exr", "deep.exr", "small.exr"}) {
        const ProgramResult result = compare("one.exr", fine);
        EXPECT_EQ(result.exit_code, 0) << fine;
        EXPECT_EQ(result.err, "") << fine;
    }
}

}  // namespace
}  // namespace lamina
