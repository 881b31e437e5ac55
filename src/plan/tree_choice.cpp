// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/enum_words.h"
#include "base/error.h"
#include "scene/scene.h"

namespace lamina {
namespace {

constexpr double full_scale = 255;

// Returns the largest error of storing one value in [0, 1]. llvmpipe truncates halves, by up to one
// unit in the last place just below 1.
double storage_error(const TreeQuestion& question) {
    switch (question.target) {
        case Target::float32:
            return 0x1p-24;
        case Target::float16:
            return 0x1p-11;
        case Target::fixed16:
            return 0.5 / 65535;
        case Target::fixed8:
            return 0.5 / 255;
        case Target::emulated:
            return 0.5 / largest_code(question.emulation.bits);
    }
    unreachable_enum();
}

// Returns the largest error of a slab's opacity, in storage errors: half a code if it is rounded to
// nearest, else up to a code.
double opacity_roundings(const TreeQuestion& question) {
    if (question.dither) return 2.0 * question.dither->increment;
    const bool whole_code =
        question.target == Target::emulated && question.emulation.alpha != AlphaRounding::nearest;
    return whole_code ? 2 : 1;
}

// Returns the rounding error of compositing a slab, in storage errors: one for its colour, one for
// the colour behind it, which it attenuates, and those of its opacity. Front to back, the opacity
// accumulated in front, which attenuates the slab, is rounded, too.
double roundings_per_slab(const TreeQuestion& question) {
    return 2 + opacity_roundings(question) + (question.order == Order::front_to_back ? 1 : 0);
}

// Returns the error of slabs' colours, in storage errors, before they are weighted by opacity. It
// counts once, because the sum of these weights is at most 1.
double color_roundings(const TreeQuestion& question) {
    if (question.dither && question.dither->color) return 2.0 * question.dither->increment;
    return question.target == Target::emulated ? 1 : 0;
}

// Rounding error per slab of a leaf's float32 registers: transmittance, colour, optical depth.
constexpr double leaf_roundings = 3 * 0x1p-24;

// Scales a bound for colours up to 1 to the question's colours, in 1/255. Fixed-point targets clamp
// colours to 1; the others round in proportion to the colour.
double scaled_for_color(const TreeQuestion& question, double bound) {
    const double largest = std::max(question.largest_color, 1.0);
    const double scaled = is_fixed_point(question.target) ? bound + (largest - 1) : bound * largest;
    return full_scale * std::min(scaled, largest);
}

// Returns the error that one level of inner nodes may add to colours up to 1 (docs/numerics.md,
// section 4): the bound on a channel if the code of each node is off by h, plus the rounding of the
// nodes' colours. `share`: the smallest share of a ray's slabs that a node of this level has.
double level_rounding(const TreeQuestion& question, const TreePlan& tree, double share) {
    const double storage = storage_error(question);
    const bool wide = question.target == Target::fixed8 && tree.alpha_bits == 16;
    const double h = wide ? 0.5 / 65535 : storage;
    const double y = 1 - std::log(share) / std::numbers::e;
    const double lost = std::numbers::e * h * y;
    return storage + (lost < 1 ? std::min(-std::log1p(-lost), 1.0) : 1.0);
}

// Returns the smaller bound of blending and of one float node, which emulated buffers do not have.
double best_error_bound(const TreeQuestion& question) {
    const double straight = straight_error_bound(question);
    if (question.target == Target::emulated) return straight;
    return std::min(straight, one_level_error_bound(question));
}

// Names the targets that would keep max_error; "" if none does.
std::string targets_that_keep(TreeQuestion question) {
    std::vector<const char*> names;
    for (const Target target :
         {Target::fixed8, Target::fixed16, Target::float16, Target::float32}) {
        question.target = target;
        if (best_error_bound(question) <= question.max_error) names.push_back(name_of(target));
    }
    return names.empty() ? "" : fmt::format("target {}", fmt::join(names, " or "));
}

[[noreturn]] void fail_for(const TreeQuestion& question) {
    std::vector<std::string> remedies;
    if (best_error_bound(question) <= full_scale) remedies.emplace_back("a larger max_error");
    const auto add_if_kept = [&](const char* remedy, const TreeQuestion& other) {
        if (best_error_bound(other) <= question.max_error) remedies.emplace_back(remedy);
    };
    const bool clamps = is_fixed_point(question.target) && question.largest_color > 1;
    TreeQuestion clamped = question, more_bits = question, one_slab = question;
    clamped.largest_color = 1;
    more_bits.emulation.bits = max_code_bits;
    one_slab.visible_slabs = 1;
    if (clamps) add_if_kept("colours up to 1", clamped);
    if (question.target == Target::emulated) add_if_kept("more bits", more_bits);
    add_if_kept("fewer slabs", one_slab);
    if (const std::string targets = targets_that_keep(question); !targets.empty())
        remedies.push_back(targets);
    if (remedies.empty()) remedies.emplace_back("colours up to 1 and a larger max_error");
    const std::string bits = question.target == Target::emulated
                                 ? fmt::format(" of {} bits", question.emulation.bits)
                                 : "";
    const std::string clamping =
        clamps ? fmt::format(", and clamps colours (up to {:.4g}) to 1", question.largest_color)
               : "";
    fail(
        "render.max_error: {:.4g} cannot be kept: over {} visible slabs the target {}{} is off by "
        "up to {:.4g} / 255 at best{}: take {}",
        question.max_error, question.visible_slabs, name_of(question.target), bits,
        best_error_bound(question), clamping, fmt::join(remedies, ", or "));
}

// Throws Error if a tree of fixed-point nodes cannot draw the scene. `otherwise`: what messages
// name as an alternative.
void check_fixed_nodes(const Scene& scene, bool single_color, const char* tree,
                       const char* otherwise) {
    if (!is_fixed_point(*scene.target)) {
        fail(
            "{}: {}.nodes: found \"fixed\" with target \"{}\", expected target fixed8, fixed16 or "
            "emulated",
            scene.file.string(), tree, name_of(scene.target));
    }
    if (scene.lighting) {
        fail(
            "{}: {}.nodes: found \"fixed\" with lighting, which gives one colour many values, "
            "expected no lighting: these nodes know opacity alone (LaMar 2004, section 6){}",
            scene.file.string(), tree, otherwise);
    }
    if (!single_color) {
        fail(
            "{}: {}.nodes: found \"fixed\" with a transfer function of several colours, expected "
            "one colour (LaMar 2004, section 6){}",
            scene.file.string(), tree, otherwise);
    }
}

}  // namespace

double straight_error_bound(const TreeQuestion& question) {
    const double roundings =
        question.visible_slabs * roundings_per_slab(question) + color_roundings(question);
    return scaled_for_color(question, roundings * storage_error(question));
}

double one_level_error_bound(const TreeQuestion& question) {
    return scaled_for_color(question,
                            storage_error(question) + question.visible_slabs * leaf_roundings);
}

std::optional<double> rounding_bound(const TreeQuestion& question,
                                     const std::optional<TreePlan>& tree) {
    if (!tree) return straight_error_bound(question);
    if (tree->nodes != NodeArithmetic::shader) return {};
    const TreeShape shape(tree->factors, question.slabs);
    if (shape.is_marched(0, shape.root())) return one_level_error_bound(question);
    if (tree->code != NodeCode::minimax) return {};
    double inner = 0;
    int smallest = question.slabs;
    for (int level = 1; level < shape.levels(); ++level) {
        smallest = std::max(smallest / shape.factor(level - 1), 1);
        inner += level_rounding(question, *tree, static_cast<double>(smallest) / question.slabs);
    }
    if (is_fixed_point(question.target)) inner *= std::max(question.largest_color, 1.0);
    return scaled_for_color(
        question, inner + storage_error(question) + question.visible_slabs * leaf_roundings);
}

TreeChoice choose_tree(const TreeQuestion& question) {
    const double straight = straight_error_bound(question);
    const double best = best_error_bound(question);
    // No target has more bits than float32, so a scene with this target is drawn even if max_error
    // is exceeded, as it is without a tree.
    if (best > question.max_error && question.target != Target::float32) fail_for(question);
    if (question.target == Target::emulated)
        return {{}, straight, "an emulated buffer has no nodes computed in a shader"};
    const double left =
        std::max(question.max_error - question.slab_error, question.max_error * target_share);
    // One node that marches all slabs reads and writes each pixel once; blending does so once a
    // slab, and is measured to be slower for every number of slabs but one (docs/precision.md).
    const double one_level = one_level_error_bound(question);
    if ((question.slabs > 1 && one_level <= left) || straight > left) {
        return {TreePlan{.factors = {question.slabs}}, one_level,
                fmt::format("one node of {} slabs, in float, takes less time than blending, whose "
                            "bound is {:.3g}",
                            question.slabs, straight)};
    }
    return {{}, straight, fmt::format("{} visible slabs round little", question.visible_slabs)};
}

void check_slice_tree(const Scene& scene, bool single_color) {
    if (given_tree(scene.slice.tree)->nodes == NodeArithmetic::fixed) {
        check_fixed_nodes(scene, single_color, "render.slice.tree", ", or \"nodes\": \"shader\"");
    } else if (scene.target == Target::emulated) {
        fail(
            "{}: render.slice.tree.nodes: found \"shader\" with target \"emulated\", expected "
            "\"fixed\": nodes computed in a shader write fixed8, fixed16, float16 or float32",
            scene.file.string());
    }
}

void check_project_tree(const Scene& scene, bool single_color) {
    const TreeSettings* const tree = given_tree(scene.project.tree);
    const ProjectSettings& project = scene.project;
    const std::string file = scene.file.string();
    if (tree == nullptr || tree->nodes == NodeArithmetic::shader) {
        fail(
            "{}: render.project.{}, expected an object with \"factors\" and \"nodes\": \"fixed\": "
            "nodes computed in a shader march slabs, and tets are drawn one by one",
            file, tree == nullptr ? "tree: found \"auto\"" : "tree.nodes: found \"shader\"");
    }
    check_fixed_nodes(scene, single_color, "render.project.tree", "");
    if (project.geometry == ProjectGeometry::triangles ||
        project.interpolation == Interpolation::linear || mixes_colors(project.coloring)) {
        fail(
            "{}: render.project.tree: found geometry \"{}\", interpolation \"{}\" and coloring "
            "\"{}\", expected silhouettes, perspective and preintegrated or analytic",
            file, name_of(project.geometry), name_of(project.interpolation),
            name_of(project.coloring));
    }
    if (project.table.is_given() && project.table->store == TableStore::opacity) {
        fail(
            "{}: render.project.table.store: found \"opacity\" with render.project.tree, expected "
            "\"mean_extinction\": leaves multiply optical depth",
            file);
    }
}

}  // namespace lamina
