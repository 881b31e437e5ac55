// SPDX-License-Identifier: Apache-2.0
// lamina info: values and positions. (Faulty meshes: mesh_files_test.cpp.)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "cli/lamina_run.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class Info : public testing::Test {
  protected:
    // Writes 3 x 2 x 2 samples, 0, 10, ..., 110, with spacings 2, 0.5 and 4.
    void SetUp() override {
        write_bytes_to(folder / "a.nrrd",
                       "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: ascii\n"
                       "space dimension: 3\nspace directions: (2,0,0) (0,0.5,0) (0,0,4)\n"
                       "space origin: (10,20,30)\n\n0 10 20 30 40 50 60 70 80 90 100 110\n");
    }
    json info(const std::string& file) {
        const ProgramResult result = lamina_run({"info", folder / file, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out);
    }
    std::string text(const std::string& file) { return lamina_run({"info", folder / file}).out; }

    TemporaryFolder folder;
};

TEST_F(Info, SaysWhereSamplesLieAndHowValuesAreSpread) {
    const json found = info("a.nrrd");
    EXPECT_EQ(found["spacing"], json({2, 0.5, 4}));
    EXPECT_EQ(found["origin"], json({10, 20, 30}));
    // One of the twelve values is 8 %, three are 25 %, six are 50 %, and so on.
    EXPECT_EQ(found["percentiles"],
              json::parse(R"({"0.1": 0, "1": 0, "5": 0, "25": 20, "50": 50, "75": 80, "95": 110,
                              "99": 110, "99.9": 110})"));
    const auto counts = found["histogram"]["counts"].get<std::vector<int>>();
    ASSERT_EQ(counts.size(), 111u);  // 0 .. 110
    EXPECT_EQ(found["histogram"]["edges"].size(), 112u);
    for (std::size_t value = 0; value < counts.size(); ++value)
        EXPECT_EQ(counts[value], value % 10 == 0 ? 1 : 0) << value;
    for (const char* key : {"kind", "size", "type", "centers", "bounds", "range", "nan_count"})
        EXPECT_TRUE(found.contains(key)) << key;
}

TEST_F(Info, TextHasPercentilesAndAHistogram) {
    const std::string shown = text("a.nrrd");
    EXPECT_NE(shown.find("spacing           [2.0,0.5,4.0]\n"), std::string::npos) << shown;
    EXPECT_NE(shown.find("0.1 %: 0, 1 %: 0, 5 %: 0, 25 %: 20, 50 %: 50, 75 %: 80"),
              std::string::npos)
        << shown;
    // The text has 9 percentiles and 16 rows of the histogram.
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '%'), 9 + 16) << shown;
}

// 40 samples of each label, and a name for one of them.
TEST_F(Info, ListsLabelsByTheNumbersOfTheFile) {
    std::string values;
    for (const char* const label : {" 0", " 9", " 5000000000"})
        for (int i = 0; i < 40; ++i) values += label;
    write_bytes_to(folder / "l.nrrd",
                   "NRRD0005\ntype: int64\ndimension: 3\nsizes: 120 1 1\nencoding: ascii\n"
                   "Segment0_ID:=s\nSegment0_LabelValue:=9\nSegment0_Name:=liver\n\n" +
                       values + "\n");
    const json found = info("l.nrrd");
    EXPECT_EQ(found["lookup"], "nearest");
    EXPECT_EQ(found["range"], json({0, 2}));
    ASSERT_EQ(found["labels"].size(), 3u);
    EXPECT_EQ(found["labels"][1]["number"], 9);
    EXPECT_EQ(found["labels"][1]["name"], "liver");
    EXPECT_DOUBLE_EQ(found["labels"][1]["share"].get<double>(), 1 / 3.);
    EXPECT_EQ(found["labels"][2]["number"], 5000000000);
    const std::string shown = text("l.nrrd");
    EXPECT_NE(shown.find("0 (33.3 %), 9 liver (33.3 %), 5000000000 (33.3 %)"), std::string::npos)
        << shown;
    EXPECT_EQ(info("a.nrrd")["lookup"], "linear");
    EXPECT_EQ(info("a.nrrd")["labels"], json::array());
}

// The values differ only beyond their sixth digit.
TEST_F(Info, TextHasTheDigitsThatTellValuesApart) {
    std::string values;
    for (int i = 0; i < 64; ++i) values += fmt::format(" {}", 1000000 + .0625 * i);
    write_bytes_to(
        folder / "far.nrrd",
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nencoding: ascii\n\n" + values + "\n");
    const std::string shown = text("far.nrrd");
    // The 32nd of 64 samples is 1000000 + 31 / 16. Text is exact to a thousandth of the range,
    // 3.94.
    EXPECT_NE(shown.find("50 %: 1000001.94,"), std::string::npos) << shown;
    std::set<std::string> begins;
    std::size_t rows = 0;
    for (std::size_t at = shown.find(" .. "); at != std::string::npos;
         at = shown.find(" .. ", at + 1), ++rows)
        begins.insert(shown.substr(shown.rfind(' ', at - 1), at - shown.rfind(' ', at - 1)));
    EXPECT_EQ(rows, 16u) << shown;
    EXPECT_EQ(begins.size(), rows) << shown;
}

// 17 whole numbers make nine rows; each has two numbers, the last one has one.
TEST_F(Info, RowsOfTheHistogramAreEquallyWide) {
    std::string values;
    for (int i = 0; i < 17; ++i) values += fmt::format(" {}", i);
    write_bytes_to(
        folder / "w.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 17 1 1\nencoding: ascii\n\n" + values + "\n");
    const std::string shown = text("w.nrrd");
    EXPECT_NE(shown.find("14 .. 16        11.765 %"), std::string::npos) << shown;
    EXPECT_NE(shown.find("16 .. 17         5.882 %"), std::string::npos) << shown;
}

TEST_F(Info, DescribesTheFirstScalarOfAMeshPointByPoint) {
    write_bytes_to(folder / "m.node",
                   "5 3 2 0\n0 0 0 0 1 9\n1 1 0 0 2 9\n2 0 1 0 3 9\n3 0 0 1 4 9\n4 1 1 1 10 9\n");
    write_bytes_to(folder / "m.ele", "2 4 0\n0 0 1 2 3\n1 1 2 3 4\n");
    const json found = info("m.node");
    EXPECT_EQ(found["percentiles"]["0.1"], 1);
    EXPECT_EQ(found["percentiles"]["25"], 2);
    EXPECT_EQ(found["percentiles"]["50"], 3);
    EXPECT_EQ(found["percentiles"]["99.9"], 10);
    const auto counts = found["histogram"]["counts"].get<std::vector<int>>();
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 5);
    EXPECT_EQ(counts.front(), 1);
    EXPECT_EQ(counts.back(), 1);
    EXPECT_EQ(found["histogram"]["edges"].front(), 1);
    EXPECT_EQ(found["histogram"]["edges"].back(), 10);
    // A mesh without scalars has neither percentiles nor a histogram.
    write_bytes_to(folder / "n.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
    write_bytes_to(folder / "n.ele", "1 4 0\n0 0 1 2 3\n");
    EXPECT_TRUE(info("n.node")["percentiles"].is_null());
    EXPECT_TRUE(info("n.node")["histogram"].is_null());
    EXPECT_NE(text("n.node").find("percentiles       null\n"), std::string::npos);
    EXPECT_EQ(lamina_run({"info", folder / "n.node", "--png", folder / "n.png"}).exit_code, 0);
}

TEST_F(Info, NaNIsNotCounted) {
    write_bytes_to(folder / "f.nrrd",
                   "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n"
                   "nan 1 nan inf 3 1 2 -inf\n");
    const json found = info("f.nrrd");
    EXPECT_EQ(found["nan_count"], 4);
    EXPECT_EQ(found["percentiles"]["50"], 1);
    EXPECT_EQ(found["percentiles"]["75"], 2);
    EXPECT_EQ(found["percentiles"]["95"], 3);
    const auto counts = found["histogram"]["counts"].get<std::vector<int>>();
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 4);
    EXPECT_EQ(found["spacing"], json({1, 1, 1}));
    write_bytes_to(
        folder / "g.nrrd",
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 2\nencoding: ascii\n\nnan nan\n");
    EXPECT_TRUE(info("g.nrrd")["percentiles"].is_null());
    EXPECT_TRUE(info("g.nrrd")["range"].is_null());
    EXPECT_EQ(lamina_run({"info", folder / "g.nrrd", "--png", folder / "g.png"}).exit_code, 0);
}

TEST_F(Info, ListsWhatAFileHasAndShowsWhatIsChosen) {
    // Three channels at two times; the sample x of channel c and time t is 100 t + 10 c + x.
    write_bytes_to(
        folder / "c.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 5\nsizes: 3 2 1 1 2\nkinds: vector domain "
        "domain domain time\nencoding: ascii\n\n0 10 20 1 11 21 100 110 120 101 111 121\n");
    const json found = info("c.nrrd");
    EXPECT_EQ(found["channels"], json({"", "", ""}));
    EXPECT_EQ(found["times"], json({"", ""}));
    EXPECT_EQ(found["arrays"], json::array());
    EXPECT_EQ(found["levels"], json::array());
    EXPECT_EQ(found["colour"], false);
    EXPECT_EQ(found["range"], json({0, 1}));
    const std::string shown = text("c.nrrd");
    EXPECT_NE(shown.find("channels          0, 1, 2 (choose by --set volume.channel=NUMBER)\n"),
              std::string::npos)
        << shown;
    EXPECT_NE(shown.find("times             0, 1 (choose by --set volume.time=NUMBER)\n"),
              std::string::npos)
        << shown;
    for (const char* none : {"arrays", "levels", "colour"})
        EXPECT_EQ(shown.find(none), std::string::npos) << shown;
    const ProgramResult chosen = lamina_run({"info", folder / "c.nrrd", "--json", "--set",
                                             "volume.channel=2", "--set", "volume.time=1"});
    ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
    EXPECT_EQ(json::parse(chosen.out)["range"], json({120, 121}));
    EXPECT_EQ(json::parse(chosen.out)["channels"].size(), 3u);
    EXPECT_EQ(chosen.err, "");
    // One part is no choice.
    EXPECT_EQ(text("a.nrrd").find("channels"), std::string::npos);
}

TEST_F(Info, RefusesSettingsThatChooseNoPart) {
    const auto exit_code = [&](const char* setting) {
        return lamina_run({"info", folder / "a.nrrd", "--set", setting}).exit_code;
    };
    for (const char* setting : {"image.width=3", "volume.path=b.nrrd", "volume", "volume.chanel=1",
                                "mesh.time=1", "volume.channel=x"})
        EXPECT_EQ(exit_code(setting), 2) << setting;
    EXPECT_EQ(exit_code("volume.channel=1"), 1);  // the file has none
}

TEST_F(Info, SaysThatAFolderIsOne) {
    write_bytes_to(folder / "letter.txt", "text");
    const ProgramResult result = lamina_run({"info", folder.path()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("found a folder with unknown kinds (letter.txt), NRRD (a.nrrd), "
                              "expected the name of one of these\n"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(lamina_run({"render", folder.path(), "-o", folder / "p.png"}).err, result.err);
}

// The picture has slices and a histogram. z, the longest axis with a length of 8, has 256 pixels.
TEST_F(Info, PictureHasTheAspectOfTheWorld) {
    ASSERT_EQ(lamina_run({"info", folder / "a.nrrd", "--png", folder / "a.png"}).exit_code, 0);
    const CodedImage picture = read_png(folder / "a.png");
    EXPECT_GE(picture.width, 480);
    EXPECT_GT(picture.height, 256 + 160);
    // In the xz slice a sample is 64 pixels wide and 128 high. The slice is to the right of the xy
    // slice, which is 192 wide.
    const int left = 8 + 192 + 8, bottom = 8 + 20 + 256 - 1;
    const auto grey = [&](int column, int row) {
        return picture.codes[static_cast<std::size_t>(3 * (row * picture.width + column))];
    };
    const auto code = [](int value) { return (255 * value + 55) / 110; };  // rounded
    EXPECT_EQ(grey(left + 63, bottom), code(30));  // x = 0, y = 1 (the middle), z = 0
    EXPECT_EQ(grey(left + 64, bottom), code(40));
    EXPECT_EQ(grey(left + 63, bottom - 127), code(30));
    EXPECT_EQ(grey(left + 63, bottom - 128), code(90));
}

}  // namespace
}  // namespace lamina
