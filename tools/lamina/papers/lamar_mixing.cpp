// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, with two liquids that mix: dithering along depth (Table 4, Figure 6), both
// compositing orders (section 4.2) and exponent-factoring (Figure 10).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "papers/figure_files.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* data_note =
    "The paper's Richtmyer-Meshkov data are not to be had: `mixing` is another volume, and only "
    "the pattern is compared. Colour is dithered beside opacity.";

struct PaperRow {
    int period;
    ErrorNorms red, green;  // {linf, mean, l2} in 1/255
};
constexpr PaperRow paper_rows[] = {
    {1, {195, -78.22, 112.64}, {47, -20.01, 23.21}}, {4, {67, -20.29, 35.45}, {47, -20.01, 23.21}},
    {16, {68, -17.76, 35.03}, {42, 12.54, 22.33}},   {64, {68, -16.31, 35.49}, {49, 13.43, 22.80}},
    {256, {68, -16.00, 35.05}, {52, 12.66, 18.90}},
};

float largest(const Image& image, std::size_t channel) {
    float found = 0;
    for (std::size_t i = channel; i < image.rgba.size(); i += 4)
        found = std::max(found, image.rgba[i]);
    return 255 * found;
}

// Returns the mean over the leftmost tenth of the columns, the light liquid, in 1/255.
double mean_on_the_left(const Image& image, std::size_t channel) {
    double sum = 0;
    const int columns = std::max(1, image.width / 10);
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < columns; ++column) {
            sum += image.pixel(column, row)[channel];
        }
    }
    return 255 * sum / (columns * image.height);
}

Json row_of(int period, const ErrorNorms& red, const ErrorNorms& green) {
    return {{"period", period},    {"red_linf", red.linf},     {"red_l1", red.mean},
            {"red_l2", red.l2},    {"green_linf", green.linf}, {"green_l1", green.mean},
            {"green_l2", green.l2}};
}

struct MeasuredRow {
    ErrorNorms red, green;
};

std::vector<MeasuredRow> measured_rows(const DitheredMixing& mixing) {
    std::vector<MeasuredRow> rows;
    for (const Image& image : mixing.dithered) {
        const ImageError error = image_error(image, mixing.exact);
        rows.push_back({error.of_channel[0], error.of_channel[1]});
    }
    return rows;
}

void judge_table4(Findings& findings, const DitheredMixing& mixing,
                  const std::vector<MeasuredRow>& rows) {
    const double red = largest(mixing.exact, 0), green = largest(mixing.exact, 1);
    findings.add_untestable(
        "DP 1: Red L∞ 195, Green L∞ 47",
        std::abs(rows[0].red.linf - red) < 1e-3 && std::abs(rows[0].green.linf - green) < 1e-3,
        fmt::format("without dithering the largest error is all that there is to see, {:.1f} in "
                    "red and {:.1f} in green",
                    rows[0].red.linf, rows[0].green.linf));
    findings.add_untestable(
        "Red L2, DP 1: 112.64, DP 4: 35.45", rows[1].red.l2 < 0.5 * rows[0].red.l2,
        fmt::format("period 4 takes more than half of the red error, L2 from {:.2f} to {:.2f}, "
                    "Linf from {:.1f} to {:.1f}",
                    rows[0].red.l2, rows[1].red.l2, rows[0].red.linf, rows[1].red.linf));
    findings.add_untestable("Green L2, DP 1: 23.21, DP 4: 23.21",
                            std::abs(rows[1].green.l2 - rows[0].green.l2) < 0.05 * rows[0].green.l2,
                            fmt::format("period 4 leaves green as it was, L2 {:.2f}, then {:.2f}",
                                        rows[0].green.l2, rows[1].green.l2));
    const auto [low, high] =
        std::minmax({rows[1].red.l2, rows[2].red.l2, rows[3].red.l2, rows[4].red.l2});
    findings.add_untestable(
        "Red L2, DP 4: 35.45, DP 16: 35.03, DP 64: 35.49, DP 256: 35.05", high < 1.25 * low,
        fmt::format("longer periods change the red error little, L2 {:.2f}, {:.2f}, {:.2f}, {:.2f}",
                    rows[1].red.l2, rows[2].red.l2, rows[3].red.l2, rows[4].red.l2));
    findings.add_untestable(
        "DP 256: Red L1 -16.00, Green L1 12.66", rows[4].red.mean < 0 && rows[4].green.mean > 0,
        fmt::format("red stays too dark, green becomes too bright: L1 is {:.2f} "
                    "in red and {:.2f} in green",
                    rows[4].red.mean, rows[4].green.mean));
}

void judge_figure6(Findings& findings, const DitheredMixing& mixing) {
    const std::vector<Image>& images = mixing.dithered;
    findings.add_untestable(
        "no image is generated as all of the per-voxel values are too small to be represented and "
        "are simply truncated.",
        largest(images[0], 0) == 0 && largest(images[0], 1) == 0,
        fmt::format("period 1: the largest codes are {} and {}", largest(images[0], 0),
                    largest(images[0], 1)));
    findings.add_untestable(
        "A dithering period of 4 shows the essential outline of the high-density fluid in red",
        largest(images[1], 0) > 0.5f * largest(mixing.exact, 0) && largest(images[1], 1) == 0,
        fmt::format("period 4: the largest codes are {:.0f} in red and {:.0f} in green",
                    largest(images[1], 0), largest(images[1], 1)));
    findings.add_untestable(
        "Orange appears in the right regions with a dithering period of 16.",
        largest(images[2], 1) > 0,
        fmt::format("period 16: the largest green is {:.0f}", largest(images[2], 1)));
    const double exact = mean_on_the_left(mixing.exact, 1);
    std::string left;
    for (std::size_t i = 0; i < images.size(); ++i) {
        left += fmt::format("{}{:.2f} at {}", i == 0 ? "" : ", ", mean_on_the_left(images[i], 1),
                            mixing.periods[i]);
    }
    findings.add_untestable(
        "At a dithering period of 256, we find the less dense liquid on the left finally "
        "appearing. While extremely faint, the value in the dithered image is the same as in the "
        "software image, 4 (on a scale of 0 to 255).",
        mean_on_the_left(images[3], 1) < 0.5 &&
            std::abs(mean_on_the_left(images[4], 1) - exact) < 1,
        fmt::format("the mean green of the left tenth is {:.2f}; with the periods it is {}", exact,
                    left));
}

struct Tree {
    const char* name;  // factors, or "straight" for no tree
    bool shown;        // in the picture of Figure 10, because the paper shows it
};
// Trees of the paper: "1 group of 1024 slices", "4 groups of 256", "8 groups of 8 groups of 16",
// height 10. The others, of two and five levels, test what its text says of factors.
constexpr Tree trees[] = {{"straight", true}, {"4x256", true},  {"256x4", false},
                          {"16x64", false},   {"64x16", false}, {"32x32", false},
                          {"8x8x16", true},   {"4^5", false},   {"2^10", true}};

Scene fixed_tree(const Scene& white, const std::string& name, AlphaRounding rounding) {
    Scene scene = with_paper_hardware(white);
    scene.emulate.alpha = rounding;
    if (name == "straight") return scene;
    scene.slice.tree = TreeSettings{.factors = parse_factors(name), .nodes = NodeArithmetic::fixed};
    return scene;
}

Json row_of(const std::string& colors, const std::string& nodes, const std::string& tree,
            const char* alpha, const ErrorNorms& e) {
    return {{"colors", colors}, {"nodes", nodes}, {"tree", tree}, {"alpha", alpha},
            {"linf", e.linf},   {"l1", e.mean},   {"l2", e.l2}};
}

using Errors = std::map<std::string, ErrorNorms>;  // by tree

void judge(Findings& findings, const Errors& truncated, const Errors& nearest) {
    const auto l2 = [&](const char* tree) { return truncated.at(tree).l2; };
    findings.add_untestable(
        "The error for the RM dataset also considerably improved.",
        l2("4x256") < 0.8 * l2("straight") && l2("2^10") < 0.2 * l2("straight"),
        fmt::format("L2 is {:.1f} straight, {:.1f} with 4x256, {:.2f} with 2^10", l2("straight"),
                    l2("4x256"), l2("2^10")));
    findings.add(
        "For the hierarchies of height 2 the error decreases as the difference between the "
        "bifurcation factors in minimized.",
        l2("32x32") < l2("16x64") && l2("16x64") < l2("4x256") && l2("32x32") < l2("64x16") &&
            l2("64x16") < l2("256x4"),
        fmt::format("L2 is {:.2f} with 4x256, {:.2f} with 16x64, {:.2f} with 32x32, {:.2f} with "
                    "64x16, {:.2f} with 256x4",
                    l2("4x256"), l2("16x64"), l2("32x32"), l2("64x16"), l2("256x4")));
    findings.add("The error also decreases as the tree height is increased",
                 l2("8x8x16") < l2("32x32") && l2("4^5") < l2("8x8x16") && l2("2^10") < l2("4^5"),
                 fmt::format("L2 is {:.2f} with 32x32, {:.2f} with 8x8x16, {:.2f} with 4^5, "
                             "{:.2f} with 2^10",
                             l2("32x32"), l2("8x8x16"), l2("4^5"), l2("2^10")));
    const ErrorNorms &t = truncated.at("2^10"), &n = nearest.at("2^10");
    // The volume is not the paper's, so a factor of two counts as equal.
    findings.add_untestable(
        "a tree with bifurcation factors of 2 (and height=10) has L∞ = 2 and L2 = 0.81.",
        t.linf < 2 * 2 && t.l2 < 2 * 0.81,
        fmt::format(
            "Linf is {:.2f} and L2 {:.2f} if alpha is truncated, {:.2f} and {:.2f} if it is "
            "rounded to nearest",
            t.linf, t.l2, n.linf, n.l2));
}

// Returns the error of a tree whose nodes are computed in a shader and carry colour, which goes
// beyond the paper.
ErrorNorms shader_tree_error(LamarStage& stage, const Scene& exact_scene, const Image& exact,
                             Image& image) {
    Scene scene = exact_scene;
    scene.target = Target::fixed8;
    scene.slice.tree = TreeSettings{.factors = {32, 32}};
    image = stage.draw_mixing(scene);
    return image_error(image, exact).all;
}

}  // namespace

Image LamarStage::draw_mixing(const Scene& scene) {
    if (!mixing_) mixing_ = std::make_shared<const VolumeData>(mixing_volume());
    return plain_picture(scene, SceneData(mixing_), capabilities_, tables_);
}

const DitheredMixing& LamarStage::dithered_mixing() {
    if (dithered_mixing_) return *dithered_mixing_;
    const Scene exact = mixing_scene(pixels_);
    DitheredMixing made{{}, {1, 4, 16, 64, 256}, {}};
    Progress progress("mixing liquids", 1 + static_cast<std::int64_t>(made.periods.size()));
    made.exact = draw_mixing(exact);
    progress.advance();
    for (const int period : made.periods) {
        Scene scene = with_paper_hardware(exact);
        if (period > 1) scene.slice.dither = DitherSettings{.period = period, .color = true};
        made.dithered.push_back(draw_mixing(scene));
        progress.advance();
    }
    dithered_mixing_ = std::move(made);
    return *dithered_mixing_;
}

Json draw_table4(const std::filesystem::path& folder, LamarStage& stage) {
    const DitheredMixing& mixing = stage.dithered_mixing();
    const std::vector<MeasuredRow> measured = measured_rows(mixing);
    Json rows = Json::array(), printed = Json::array();
    for (std::size_t i = 0; i < measured.size(); ++i)
        rows.push_back(row_of(mixing.periods[i], measured[i].red, measured[i].green));
    for (const PaperRow& row : paper_rows)
        printed.push_back(row_of(row.period, row.red, row.green));
    study::write_text(folder / "table4.csv", csv_of_rows(rows));
    Findings findings;
    judge_table4(findings, mixing, measured);
    return findings.result({{"files", {"table4.csv"}}, {"pixels", stage.pixels()}, {"rows", rows}},
                           printed, data_note);
}

Json draw_figure6(const std::filesystem::path& /*folder*/, LamarStage& stage) {
    const DitheredMixing& mixing = stage.dithered_mixing();
    Panels panels;
    panels.add("", "software", mixing.exact);
    for (std::size_t i = 0; i < mixing.periods.size(); ++i)
        panels.add("", fmt::format("dithered, period {}", mixing.periods[i]), mixing.dithered[i]);
    Findings findings;
    judge_figure6(findings, mixing);
    Json values{{"files", Json::array()},
                {"pixels", stage.pixels()},
                {"panels", panels.json()},
                {"caption",
                 "1024 slabs of the mixing liquids, which stand in for the paper's data: exact "
                 "(software), and in 8 bits, dithered along depth with these periods. Period 1 is "
                 "no dithering."}};
    values["largest_exact"] = {{"red", largest(mixing.exact, 0)},
                               {"green", largest(mixing.exact, 1)}};
    return findings.result(values, nullptr, data_note);
}

// Compares the orders on small pictures: only their norms are needed.
Json draw_order_mixing(const std::filesystem::path& folder, LamarStage& stage) {
    const int pixels = std::min(96, stage.pixels());
    Progress progress("order: mixing liquids", 2 * 2 * 3 * 2 * 2);
    Json rows = Json::array();
    int front_better = 0, back_better = 0;
    for (const bool white : {false, true}) {
        Scene scene = mixing_scene(pixels, white);
        for (const int samples : {64, 256, 1024}) {
            scene.slice.samples = samples;
            const Image exact = stage.draw_mixing(scene);
            for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
                ErrorNorms errors[2];
                for (const Order order : {Order::front_to_back, Order::back_to_front}) {
                    Scene fixed = with_paper_hardware(scene);
                    fixed.emulate.over = over;
                    fixed.slice.order = order;
                    fixed.slice.dither = DitherSettings{.period = samples, .color = true};
                    const Image image = stage.draw_mixing(fixed);
                    errors[order == Order::back_to_front] = image_error(image, exact).all;
                    progress.advance();
                }
                front_better += errors[0].l2 < 0.95 * errors[1].l2;
                back_better += errors[1].l2 < 0.95 * errors[0].l2;
                rows.push_back({{"colors", white ? "white" : "green to red"},
                                {"samples", samples},
                                {"period", samples},
                                {"over", name_of(over)},
                                {"ftb_linf", errors[0].linf},
                                {"ftb_l1", errors[0].mean},
                                {"ftb_l2", errors[0].l2},
                                {"btf_linf", errors[1].linf},
                                {"btf_l1", errors[1].mean},
                                {"btf_l2", errors[1].l2}});
            }
        }
    }
    study::write_text(folder / "order_mixing.csv", csv_of_rows(rows));
    const auto count = static_cast<int>(rows.size());
    Findings findings;
    findings.add(
        "It is \"common knowledge\" in the visualization community that front-to-back compositing "
        "produces higher quality imagery than back-to-front.",
        front_better == count,
        fmt::format("by L2 of R, G, B and A, dithered with period N, front to back is better in {} "
                    "of {} cases, back to front in {}; the others are within 5 %",
                    front_better, count, back_better));
    return findings.result({{"files", {"order_mixing.csv"}}, {"pixels", pixels}, {"rows", rows}});
}

Json draw_figure10(const std::filesystem::path& folder, LamarStage& stage) {
    const Scene white = mixing_scene(stage.pixels(), true), colored = mixing_scene(stage.pixels());
    Progress progress("figure 10", 2 * static_cast<std::int64_t>(std::size(trees)) + 4);
    const auto draw = [&](const Scene& scene) {
        progress.advance();
        return stage.draw_mixing(scene);
    };
    const Image exact = draw(white), colored_exact = draw(colored);
    Panels panels;
    panels.add("", "software", exact);
    Json rows = Json::array();
    Errors truncated, nearest;
    for (const Tree& tree : trees) {
        for (const AlphaRounding rounding : {AlphaRounding::truncate, AlphaRounding::nearest}) {
            const Image image = draw(fixed_tree(white, tree.name, rounding));
            const bool paper = rounding == AlphaRounding::truncate;
            const ErrorNorms e = image_error(image, exact).of_channel[3];
            (paper ? truncated : nearest)[tree.name] = e;
            rows.push_back(row_of("white", "fixed", tree.name, name_of(rounding), e));
            if (paper && tree.shown) panels.add("", tree.name, image);
        }
    }
    Image ours;
    rows.push_back(row_of("white", "shader", "32x32", "minimax",
                          shader_tree_error(stage, white, exact, ours)));
    panels.add("", "coloured software", colored_exact);
    rows.push_back(row_of("green to red", "shader", "32x32", "minimax",
                          shader_tree_error(stage, colored, colored_exact, ours)));
    panels.add("", "coloured 32x32 of shader nodes", ours);
    study::write_text(folder / "figure10.csv", csv_of_rows(rows));
    Findings findings;
    judge(findings, truncated, nearest);
    Json values{
        {"files", {"figure10.csv"}},
        {"pixels", stage.pixels()},
        {"rows", rows},
        {"panels", panels.json()},
        {"caption",
         "1024 slabs of the mixing liquids, which stand in for the paper's data: exact "
         "(software), in 8 bits without a tree (straight), and in trees with these factors. "
         "The coloured pair is ours: the paper's trees carry one colour only."}};
    return findings.result(values, {{"tree", "2^10"}, {"linf", 2}, {"l2", 0.81}},
                           "`mixing` is another volume than the paper's.");
}

}  // namespace lamina::papers
