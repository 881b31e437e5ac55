// SPDX-License-Identifier: Apache-2.0
#include "papers/figure_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papers/lamar.h"
#include "study/report_files.h"
#include "support/temporary_folder.h"

namespace lamina::papers {
namespace {

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++found;
    }
    return found;
}

TEST(RampFigure, ShowsTheCurvesThreeTimes) {
    const TemporaryFolder folder;
    Curve high = exact_ramp(1);
    high[7] += 2;
    const auto values =
        write_ramp_figure(folder.path(), "f", "title", {{"exact", exact_ramp(1)}, {"high", high}});
    EXPECT_EQ(values["errors"]["high"]["linf"], 2.0);
    EXPECT_EQ(values["curves"]["high"][7], 9.0);
    const std::string csv = read_bytes_of(folder / "f.csv");
    EXPECT_EQ(csv.substr(0, 13), "x,exact,high\n");
    EXPECT_NE(csv.find("\n7,7,9\n"), std::string::npos);
    EXPECT_EQ(count_of(csv, "\n"), 257u);
    ASSERT_EQ(values["panels"].size(), 2u);
    EXPECT_EQ(values["panels"][1]["title"], "high");
    CodedImage strip(256, 32, 3, 8);
    for (std::size_t i = 0; i < strip.codes.size(); ++i)
        strip.codes[i] = static_cast<std::uint16_t>(i / 3 % 256 == 7 ? 9 : i / 3 % 256);
    EXPECT_EQ(values["panels"][1]["image"], study::data_uri(strip));
    EXPECT_EQ(count_of(read_bytes_of(folder / "f.svg"), "<polyline"), 2u);
}

TEST(CsvOfRows, QuotesCommasAndLeavesNullEmpty) {
    const nlohmann::ordered_json rows{{{"name", "a, b"}, {"x", 0.5}, {"n", nullptr}},
                                      {{"name", "c"}, {"x", 2}, {"n", 7}}};
    EXPECT_EQ(csv_of_rows(rows), "name,x,n\n\"a, b\",0.5,\nc,2,7\n");
}

TEST(LinePlot, EscapesNamesAndKeepsLinesInside) {
    LinePlot plot{"a < b", {"x", 0, 1}, {"y", 1, 16, true}};
    plot.add("R&D", {0, 0.5, 1}, {1, 4, 0});  // 0 has no logarithm, so it is clamped to 1
    const std::string svg = plot.svg();
    EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
    EXPECT_NE(svg.find("R&amp;D"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    // On the logarithmic axis 4 is halfway between 1 and 16; both ends of the line are at 1.
    const std::size_t at = svg.find("points=\"") + 8;
    double x[3], y[3];
    ASSERT_EQ(
        std::sscanf(svg.c_str() + at, "%lf,%lf %lf,%lf %lf,%lf", x, y, x + 1, y + 1, x + 2, y + 2),
        6);
    EXPECT_DOUBLE_EQ(y[0], y[2]);
    EXPECT_LT(y[1], y[0]);
    EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.011);  // printed with two decimals
}

}  // namespace
}  // namespace lamina::papers
