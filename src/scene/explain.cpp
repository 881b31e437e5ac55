// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "compositing/tree_shape.h"
#include "scene/plan.h"

namespace lamina {
namespace {

const char* text_of(VolumeSampling sampling) {
    switch (sampling) {
        case VolumeSampling::none:
            return "none";
        case VolumeSampling::fetch:
            return "8 fetches, float arithmetic";
        case VolumeSampling::filtered:
            return "linear filter of a float texture (measured exact)";
        default:
            return "hardware linear filter";
    }
}

std::string line(const char* what, const std::string& value) {
    return fmt::format("  {:<14} {}\n", what, value);
}

std::string left_out(const Plan& plan) {
    std::string text = "left out\n";
    for (const Omission& omission : plan.omitted)
        text += line(omission.name.c_str(), omission.reason);
    return plan.omitted.empty() ? text + "  nothing\n" : text;
}

template <typename Row>
void explain_compositing(const SlicePlan& slice, const Facts& facts, const Row& row) {
    const double length = (facts.far_depth - facts.near_depth) / slice.slabs;
    row("slab depth",
        fmt::format("{:.3g}, {:.3g}, {:.3g} at most in half, nine tenths, all of "
                    "the bricks",
                    length * facts.extinction_quantiles[0], length * facts.extinction_quantiles[1],
                    length * facts.extinction_quantiles[2]));
    if (slice.emulation) {
        const Emulation& emulation = *slice.emulation;
        row("codes",
            fmt::format("{} bits, alpha {}, over {}, by {}", emulation.bits,
                        name_of(emulation.alpha), name_of(emulation.over),
                        slice.blending == Blending::fetch ? "framebuffer fetch"
                                                          : "texture barriers between slabs"));
    }
    if (slice.dither) {
        row("dither", fmt::format("period {}, seed {}, increment {}{}", slice.dither->period,
                                  slice.dither->seed, slice.dither->increment,
                                  slice.dither->color ? ", colour too" : ""));
    }
    if (slice.tree) {
        const TreePlan& tree = *slice.tree;
        const TreeShape shape(tree.factors, slice.slabs);
        std::vector<int> factors;  // with the level that takes the rest
        for (int level = 0; level < shape.levels(); ++level) factors.push_back(shape.factor(level));
        std::string text = fmt::format("{}, nodes {}", to_text(factors), name_of(tree.nodes));
        if (tree.nodes == NodeArithmetic::shader) {
            text += fmt::format(", code {}", name_of(tree.code));
            if (slice.target == Target::fixed8)
                text += fmt::format(", alpha {} bits", tree.alpha_bits);
        }
        row("tree", text);
    }
    if (slice.error_bound) {
        row("error",
            fmt::format("at most {:.3g} / 255: {}", *slice.error_bound, slice.tree_reason));
    }
}

}  // namespace

std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities) {
    std::string text = "uses\n";
    const auto row = [&](const char* what, const std::string& value) { text += line(what, value); };
    row("method", name_of(plan.method));
    if (plan.method == Method::slice) {
        const SlicePlan& slice = plan.slice;
        row("context", capabilities.renderer);
        row("slabs",
            fmt::format("{} from depth {:.6g} to {:.6g}, {:.3g} voxels each", slice.slabs,
                        facts.near_depth, facts.far_depth, facts.voxels_along_view / slice.slabs));
        row("target", name_of(slice.target));
        row("classification", name_of(slice.classification));
        row("order", name_of(slice.order));
        row("rays", slice.precise_rays ? "double" : "float");
        row("scalar", text_of(slice.sampling));
        row("textures", fmt::format("{} of {}", slice.bricks.size(),
                                    slice.float_texture ? "float" : name_of(facts.type)));
        explain_compositing(slice, facts, row);
        if (slice.uses_table()) {
            row("table",
                fmt::format("{0} x {0} scalars, {1} lengths{2}", slice.table.scalar_nodes,
                            slice.table.length_layers, slice.table.colored ? ", coloured" : ""));
        }
    }
    return text + left_out(plan);
}

std::string explain(const Plan& plan, const MeshFacts& facts) {
    std::string text = "uses\n";
    text += line("method", fmt::format("{} of the mesh", name_of(plan.method)));
    text += line("mesh", fmt::format("{} tets, {} points", facts.tets, facts.points));
    text += line("scalar", fmt::format("\"{}\" from {:.6g} to {:.6g}", facts.scalar, facts.range.lo,
                                       facts.range.hi));
    return text + left_out(plan);
}

}  // namespace lamina
