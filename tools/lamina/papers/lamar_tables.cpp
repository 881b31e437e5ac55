// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, Tables 1, 2 and 3.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

// Table 1 ------------------------------------------------------------------

constexpr int table1_samples = 64;

struct Table1Row {
    double unit_opacity;   // (a)
    const char* opacity;   // (b), of a sample
    const char* binary;    // (c)
    const char* computed;  // (d)
};
constexpr Table1Row table1_printed[] = {
    {0.000, "0.000000", ".00000000 00000000", "0.0000000"},
    {0.125, "0.002084", ".00000000 10001000", "0.0000000"},
    {0.250, "0.004485", ".00000001 00100101", "0.2215804"},
    {0.375, "0.007317", ".00000001 11011111", "0.2215804"},
    {0.500, "0.010772", ".00000010 11000001", "0.3946590"},
    {0.625, "0.015209", ".00000011 11100100", "0.5297210"},
    {0.750, "0.021428", ".00000101 01111100", "0.7170170"},
    {0.875, "0.031969", ".00001000 00101111", "0.8689160"},
    {1.000, "1.000000", ".11111111 11111111", "1.0000000"},
};

struct Table1Values {
    std::string opacity, binary, computed;
    std::uint32_t buffer = 0;  // code in an 8-bit buffer after 64 times OVER
};

// Computes a row as the printed digits imply: hardware keeps the upper byte k of a 16-bit opacity,
// and column (d) is 1 - (1 - k / 256)^64 in real arithmetic, where k = 255 counts as opacity 1.
Table1Values table1_values(double unit_opacity) {
    const double alpha = opacity_over(unit_opacity, 1.0 / table1_samples);
    const auto sixteen = static_cast<unsigned>(std::min(std::floor(alpha * 65536), 65535.0));
    const unsigned byte = sixteen >> 8;
    const double kept = byte == 255 ? 0.0 : std::pow(1 - byte / 256.0, table1_samples);
    const std::vector<RaySample> ray(table1_samples, RaySample{1, byte / 255.0});
    return {fmt::format("{:.6f}", alpha), fmt::format(".{:08b} {:08b}", byte, sixteen & 255u),
            fmt::format("{:.7f}", 1 - kept), composite_straight(ray, Emulation{}).alpha};
}

// Tables 2 and 3 -------------------------------------------------------------

constexpr std::uint32_t four_bits = 15;

std::uint32_t over4(std::uint32_t fragment, std::uint32_t below) {
    return over(OverRounding::separate, four_bits, fragment, below, four_bits);
}

std::vector<std::uint32_t> table2_row(std::uint32_t below) {
    std::vector<std::uint32_t> row;
    for (std::uint32_t f = 0; f <= four_bits; ++f) row.push_back(over4(f, below));
    return row;
}

// Removes repeated entries: Table 2 prints equal neighbours as one wide cell.
template <typename Values>
Values without_repeats(Values row) {
    row.erase(std::unique(row.begin(), row.end()), row.end());
    return row;
}

struct Table3Row {
    std::uint32_t fragment;
    std::vector<std::uint32_t> printed;  // up to the entry that repeats
};
const std::vector<Table3Row>& table3_printed() {
    static const std::vector<Table3Row> rows{{1, {1, 2, 3, 4, 5, 6, 7, 8}},
                                             {2, {2, 4, 5, 6, 7, 8, 9, 10, 11, 12}},
                                             {3, {3, 5, 7, 9, 10, 11, 12, 13}},
                                             {4, {4, 7, 9, 10, 11, 12, 13, 14}},
                                             {8, {8, 12, 14, 15}},
                                             {10, {10, 13, 14, 15}},
                                             {15, {15}}};
    return rows;
}

// Composites the fragment over 0, then over the result, and so on, until nothing changes.
std::vector<std::uint32_t> repeated(std::uint32_t fragment) {
    std::vector<std::uint32_t> row{over4(fragment, 0)};
    for (std::uint32_t next; (next = over4(fragment, row.back())) != row.back();) {
        row.push_back(next);
    }
    return row;
}

// Returns the first entry in which a printed row differs from the operator, or null. After it the
// printed row is shifted.
Json table3_misprint(const Table3Row& row, const std::vector<std::uint32_t>& right) {
    const auto [printed, correct] =
        std::mismatch(row.printed.begin(), row.printed.end(), right.begin(), right.end());
    if (printed == row.printed.end() && correct == right.end()) return nullptr;
    return {{"f", row.fragment},
            {"iteration", printed - row.printed.begin() + 1},
            {"printed", *printed},
            {"correct", *correct}};
}

}  // namespace

Json reproduce_table1(const std::filesystem::path& folder) {
    Json rows = Json::array(), printed = Json::array();
    study::CsvTable csv({"a_unit_opacity", "b_opacity", "c_binary", "d_computed", "buffer_code"});
    bool same = true, caption = true;
    for (const Table1Row& row : table1_printed) {
        const Table1Values values = table1_values(row.unit_opacity);
        rows.push_back({{"a", row.unit_opacity},
                        {"b", values.opacity},
                        {"c", values.binary},
                        {"d", values.computed},
                        {"buffer", values.buffer},
                        {"buffer_opacity", values.buffer / 255.0}});
        printed.push_back(
            {{"a", row.unit_opacity}, {"b", row.opacity}, {"c", row.binary}, {"d", row.computed}});
        csv.add_row({fmt::format("{:.3f}", row.unit_opacity), values.opacity, values.binary,
                     values.computed, std::to_string(values.buffer)});
        same = same && values.opacity == row.opacity && values.binary == row.binary &&
               values.computed == row.computed;
        caption = caption && std::abs(values.buffer / 255.0 - std::stod(row.computed)) < 0.5 / 255;
    }
    study::write_text(folder / "table1.csv", csv.text());
    Findings findings;
    findings.add(
        "A comparison of desired per-unit-distance opacity (\"PUDo\", column a) vs. computed "
        "opacity (\"Co\", column d) for a sample depth of 64. The per-voxel opacity (\"PVo\", "
        "columns b and c) is shown in base-10 and base-2.",
        same, "every printed digit of the columns (b), (c) and (d) of all nine rows follows");
    findings.add(
        "Column (d) shows the value (in decimal) in the buffer after all compositing is completed.",
        caption,
        "it is 1 - (1 - k/256)^64 in real arithmetic, k the upper byte and 255 counting as 1; a "
        "buffer of 8 bits holds the codes under `buffer`, because OVER rounds, too");
    Json values{{"samples", table1_samples}, {"files", {"table1.csv"}}, {"rows", rows}};
    return findings.result(values, printed);
}

Json reproduce_table2(const std::filesystem::path& folder) {
    Json rows = Json::array(), printed = Json::array();
    std::vector<std::string> header{"b"};
    for (std::uint32_t f = 0; f <= four_bits; ++f) header.push_back(fmt::format("f{}", f));
    study::CsvTable csv(header);
    int same = 0;
    for (std::uint32_t b = 0; b <= four_bits; ++b) {
        const std::vector<std::uint32_t> row = table2_row(b);
        std::vector<std::string> cells{std::to_string(b)};
        for (const std::uint32_t value : row) cells.push_back(std::to_string(value));
        csv.add_row(cells);
        std::vector<std::uint32_t> as_printed;  // every row: b, b + 1, ... 15
        for (std::uint32_t value = b; value <= four_bits; ++value) as_printed.push_back(value);
        same += without_repeats(row) == as_printed ? 1 : 0;
        rows.push_back({{"b", b}});
        for (std::size_t f = 0; f < row.size(); ++f) rows.back()[header[f + 1]] = row[f];
        printed.push_back(as_printed);
    }
    study::write_text(folder / "table2.csv", csv.text());
    Findings findings;
    findings.add(
        "OVER(f, b) is found in the above matrix at [b, f]. [...] Wide cells indicate that the "
        "same value appears in consecutive cells.",
        same == 16,
        fmt::format("{} of 16 rows hold the printed values in the printed order", same));
    bool halves = true;
    for (std::uint32_t f = 0; f <= four_bits; ++f) halves = halves && over4(f, 14) == 14 + f / 8;
    findings.add(
        "Given a background value of 14, foreground values of 0 to 7 produce a value of "
        "14, while foreground fragment values of 8 to 15 produce a value of 15",
        halves, fmt::format("row 14 is {}", fmt::join(table2_row(14), " ")));
    return findings.result({{"files", {"table2.csv"}}, {"rows", rows}}, printed,
                           "The text does not keep how wide the printed cells are.");
}

Json reproduce_table3(const std::filesystem::path& folder) {
    Json rows = Json::array(), printed = Json::array(), misprints = Json::array();
    study::CsvTable csv({"f", "iteration", "correct"});
    for (const Table3Row& row : table3_printed()) {
        const std::vector<std::uint32_t> right = repeated(row.fragment);
        rows.push_back({{"f", row.fragment}, {"b", right}});
        printed.push_back({{"f", row.fragment}, {"b", row.printed}});
        for (std::size_t i = 0; i < right.size(); ++i) {
            csv.add_row(
                {std::to_string(row.fragment), std::to_string(i + 1), std::to_string(right[i])});
        }
        const Json misprint = table3_misprint(row, right);
        if (!misprint.is_null()) misprints.push_back(misprint);
    }
    study::write_text(folder / "table3.csv", csv.text());
    Findings findings;
    findings.add("0, 1, 2, 3, 4, 5, 6, 7, 8, 8, ... (repeating 8's forever)",
                 repeated(1) == table3_printed()[0].printed,
                 fmt::format("f = 1 gives {}", fmt::join(repeated(1), " ")));
    findings.add(
        "Repeated compositions of the foreground values are show from left to right. Long cells "
        "with # ... show that repeated compositions no longer change its value.",
        misprints.empty(),
        fmt::format("{} of 7 rows are as printed; f = 4 is {}", 7 - misprints.size(),
                    fmt::join(repeated(4), " ")));
    return findings.result(
        {{"files", {"table3.csv"}}, {"rows", rows}, {"misprints", misprints}}, printed,
        "The printed 4th entry of row f = 4, 10, is a misprint: 4 over 9 is 4 + 9 * 11/15 = 10.6, "
        "rounded 11, by the operator that gives all other rows.");
}

}  // namespace lamina::papers
