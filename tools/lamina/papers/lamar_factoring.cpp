// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, Figure 10: exponent-factoring of two liquids that mix.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/progress.h"
#include "compositing/tree_shape.h"
#include "papers/findings.h"
#include "papers/lamar.h"
#include "papers/lamar_stage.h"
#include "papers/mixing_scene.h"
#include "papers/panels.h"
#include "study/text_file.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

struct Tree {
    const char* name;  // factors, or no tree
    bool shown;        // in the picture, which is the paper's
};
// The trees of the paper: "1 group of 1024 slices", "4 groups of 256", "8 groups of 8 groups of
// 16", height 10. Others of two, four and five levels test what the text says of factors.
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
            {"linf", e.linf},   {"l1", e.l1},     {"l2", e.l2}};
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
    // The volume is another one: within a factor of two counts as equal.
    findings.add_untestable(
        "a tree with bifurcation factors of 2 (and height=10) has L∞ = 2 and L2 = 0.81.",
        t.linf < 2 * 2 && t.l2 < 2 * 0.81,
        fmt::format(
            "Linf is {:.2f} and L2 {:.2f} if alpha is truncated, {:.2f} and {:.2f} if it is "
            "rounded to nearest",
            t.linf, t.l2, n.linf, n.l2));
}

// This goes beyond the paper: nodes are computed in a shader, and carry colour.
ErrorNorms shader_tree_error(LamarStage& stage, const Scene& exact_scene, const Image& exact,
                             Image& image) {
    Scene scene = exact_scene;
    scene.target = Target::fixed8;
    scene.slice.tree = TreeSettings{.factors = {32, 32}};
    image = stage.draw_mixing(scene);
    return image_error(image, exact).all;
}

}  // namespace

Json draw_figure10(const std::filesystem::path& folder, LamarStage& stage) {
    const Scene white = white_mixing_scene(stage.pixels()), colored = mixing_scene(stage.pixels());
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
            const ErrorNorms e = channel_error(image, exact, 3);
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
    study::write_text(folder / "figure10.csv", study::csv_of_rows(rows));
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
