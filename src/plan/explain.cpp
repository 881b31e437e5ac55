// SPDX-License-Identifier: Apache-2.0
#include "plan/plan.h"

#include <fmt/format.h>

#include <cmath>

#include "base/enum_words.h"
#include "base/error.h"
#include "compositing/tree_shape.h"

namespace lamina {
namespace {

const char* text_of(VolumeSampling sampling, const Capabilities& capabilities) {
    if (capabilities.cpu && sampling == VolumeSampling::fetch) return "8 samples, float arithmetic";
    if (capabilities.cpu && sampling == VolumeSampling::hardware)
        return "8 samples, weights of 8 bits as graphics hardware has them";
    return word_of(sampling,
                   {"none", "8 fetches, float arithmetic",
                    "linear filter of a float texture (measured exact)", "hardware linear filter"});
}

std::string line(const char* what, const std::string& value) {
    return fmt::format("  {:<14} {}\n", what, printable(value));
}

// Returns the error of a plan as text. If it is unknown only for rays along surfaces, it tells so.
std::string error_text(const Plan& plan) {
    const ErrorFigure& of_others = plan.project.error_of_others;
    if (plan.method == Method::project && of_others.kind != ErrorKind::unknown) {
        return fmt::format(
            "unknown of rays that run along the mesh's boundary, or along a surface at which the "
            "transfer function jumps or is very steep; of all others {}",
            text_of(of_others));
    }
    if (plan.method != Method::slice || !std::isinf(plan.slice.surface_error))
        return text_of(plan.error());
    SlicePlan others = plan.slice;
    others.surface_error = others.ramp_error = 0;
    const char* const surface = others.nearest
                                    ? "in a face between two voxels"
                                    : "along a surface at which the transfer function jumps or is "
                                      "very steep";
    return fmt::format("unknown of rays that run {}; of all others {}", surface,
                       text_of(others.error()));
}

// Returns the part of an error's text on rays along ramps, which may be empty.
std::string text_along_ramps(const ErrorFigure& error) {
    if (error.along_ramps == 0) return "";
    return fmt::format("; along ramps at most {:.3g} / 255", error.along_ramps);
}

std::string with_reason(const char* name, const std::string& reason) {
    return reason.empty() ? name : fmt::format("{}: {}", name, reason);
}

std::string work_and_left_out(const Plan& plan) {
    const std::string work = plan.work.amounts().empty()
                                 ? ""
                                 : line("work", to_text(plan.work) + " a frame, as predicted");
    if (plan.omitted.empty()) return work + "left out\n  nothing\n";
    std::string text = work + "left out         saves a frame, as predicted           because\n";
    for (const Omission& omission : plan.omitted)
        text += fmt::format("  {:<17} {:<36} {}\n", omission.name, to_text(omission.saves),
                            omission.reason);
    return text;
}

std::string text_of_codes(const CompositingPlan& plan) {
    const char* const unit =
        word_of(plan.blending, {"the blending unit", "registers", "the cpu engine"});
    return fmt::format("{} bits, alpha {}, over {}, by {}", plan.emulation->bits,
                       name_of(plan.emulation->alpha), name_of(plan.emulation->over), unit);
}

std::string text_of_light(const SlicePlan& slice) {
    const std::string text =
        fmt::format("{} lights, gradients of 8 bytes a sample; ", slice.lighting->lights.size());
    if (slice.integrates_cells())
        return text + fmt::format("off by up to {:.2g} / 255", slice.light_error);
    return text + (slice.preintegrates() ? "at both ends of a segment and linear between them"
                                         : "in the middle of a slab");
}

template <typename Row>
void explain_compositing(const SlicePlan& slice, const Facts& facts, const Row& row) {
    const double length = (facts.far_depth - facts.near_depth) / slice.slabs;
    const auto percent = [&](double extinction) { return -100 * std::expm1(-length * extinction); };
    row("slab opacity",
        fmt::format("at most {:.3g} % in half of the volume's bricks of {}^3 cells, {:.3g} % in "
                    "nine tenths of them, {:.3g} % in all, straight ahead",
                    percent(facts.extinction_quantiles[0]), MinMaxBricks::edge,
                    percent(facts.extinction_quantiles[1]),
                    percent(facts.extinction_quantiles[2])));
    if (slice.emulation) row("codes", text_of_codes(slice));
    if (slice.dither) {
        row("dither", fmt::format("period {}, seed {}, increment {}{}", slice.dither->period,
                                  slice.dither->seed, slice.dither->increment,
                                  slice.dither->color ? ", colour too" : ""));
    }
    if (slice.tree) {
        const TreePlan& tree = *slice.tree;
        const TreeShape shape(tree.factors, slice.slabs);
        std::vector<int> factors;  // including the level that takes the rest
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
        row("roundings",
            fmt::format("at most {:.3g} / 255: {}", *slice.error_bound, slice.tree_reason));
    }
}

std::string text_of_table(const ProjectPlan& project) {
    const TableRequest& table = project.table.request;
    if (table.kind == TableKind::knots) {
        return fmt::format(
            "nodes on the transfer function's points, some {0} x {0} scalars, {1} lengths",
            table.scalar_nodes, table.length_layers);
    }
    const std::string lengths =
        table.length_layers > 1
            ? fmt::format(", {} lengths ({})", table.length_layers, name_of(table.mapping))
            : std::string();
    return fmt::format("{0} x {0} scalars{1}, {2}, {3}", table.scalar_nodes, lengths,
                       name_of(table.store), name_of(table.format));
}

// Includes a clause on what would be omitted without light.
std::string text_of_light(const ProjectPlan& project, const MeshFacts& facts) {
    std::string text = fmt::format("{} lights, gradients at the points; off by up to {:.2g} / 255",
                                   project.lighting->lights.size(), project.light_error);
    if (facts.constant) {
        text += "; the gradient needs scalars and colour, though the transfer function is constant";
    } else if (facts.single_color) {
        text += "; it makes many colours of the one that the transfer function has";
    }
    return text;
}

template <typename Row>
void explain_projection(const ProjectPlan& project, const MeshFacts& facts, bool tiles,
                        const Row& row) {
    row("target", with_reason(name_of(project.target), project.target_reason));
    row("order", fmt::format("{}: the mesh is {}convex", name_of(project.visibility),
                             facts.convexity == Convexity::none ? "not " : ""));
    row("geometry", project.walk ? "rays walk from tet to tet"
                    : tiles && project.geometry == ProjectGeometry::silhouette
                        ? "where a ray enters and leaves a tet, pixel by pixel"
                        : name_of(project.geometry));
    row("interpolation", fmt::format("{}, thickness {}", name_of(project.interpolation),
                                     name_of(project.thickness)));
    row("edges", fmt::format("from {:.3g} to {:.3g}: optical depth of a tet at most {:.3g}",
                             facts.shortest_edge, facts.longest_edge,
                             facts.longest_edge * facts.max_extinction));
    row("segments", name_of(project.source));
    if (project.lighting) row("light", text_of_light(project, facts));
    if (project.source == SegmentSource::parts) {
        row("parts", fmt::format("{} visible tets cut at the transfer function's points into {}",
                                 facts.tets - facts.transparent_tets, facts.parts));
    }
    if (project.source == SegmentSource::table || project.source == SegmentSource::cut_table) {
        row("table", text_of_table(project));
    }
    if (project.emulation) row("codes", text_of_codes(project));
    if (project.dither != ProjectDither::none) row("dither", name_of(project.dither));
    if (!project.tree.empty()) {
        row("tree", fmt::format("{}, nodes fixed, leaves {}", to_text(project.tree),
                                project.scattered ? "scattered" : "in order"));
    }
}

}  // namespace

const char* name_of(ErrorKind kind) {
    return word_of(kind, {"unknown", "derived", "trials", "sampled", "estimated"});
}

std::string text_of(const ErrorFigure& error) {
    switch (error.kind) {
        case ErrorKind::unknown:
            return "unknown";
        case ErrorKind::derived:
            return fmt::format("at most {:.3g} / 255{}", error.value, text_along_ramps(error));
        case ErrorKind::trials:
            return fmt::format("{:.3g} / 255 by trials on {} rays", error.value, error.rays);
        case ErrorKind::sampled:
            return fmt::format("{:.3g} / 255, sampled on {} rays", error.value, error.rays);
        case ErrorKind::estimated:
            return fmt::format("{:.3g} / 255, estimated{}", error.value, text_along_ramps(error));
    }
    unreachable_enum();
}

std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities) {
    std::string text = "uses\n";
    const auto row = [&](const char* what, const std::string& value) { text += line(what, value); };
    row("method", name_of(plan.method));
    if (plan.method == Method::slice) {
        const SlicePlan& slice = plan.slice;
        row("context", capabilities.renderer);
        row("slabs",
            fmt::format("{} from {:.6g} to {:.6g} in front of the eye, {:.3g} voxels thick",
                        slice.slabs, facts.near_depth, facts.far_depth,
                        facts.voxels_along_view / slice.slabs));
        if (slice.slab_trial) {
            row("trials", fmt::format("{} rays, {} of them traced", slice.slab_trial->rays,
                                      slice.slab_trial->traced));
        }
        row("target", with_reason(name_of(slice.target), slice.target_reason));
        row("classification",
            with_reason(name_of(slice.classification), slice.classification_reason));
        if (slice.lighting) row("light", text_of_light(slice));
        row("order", name_of(slice.order));
        if (!slice.clip.empty()) row("clip", fmt::format("{} planes", slice.clip.size()));
        row("rays", slice.precise_rays ? "double" : "float");
        row("scalar", with_reason(text_of(slice.sampling, capabilities), slice.filter_reason));
        if (!capabilities.cpu) {
            row("textures", fmt::format("{} of {}", slice.bricks.size(),
                                        slice.float_texture ? "float" : name_of(facts.type)));
        }
        explain_compositing(slice, facts, row);
        if (slice.uses_table()) {
            row("table",
                fmt::format(
                    "{0} x {0} scalars, {1} lengths{2}; off by {3:.2g} / 255 on rays all over "
                    "this view and segments of all pieces",
                    slice.table.request.scalar_nodes, slice.table.request.length_layers,
                    slice.table.request.colored ? ", coloured" : "", slice.table.error));
        }
    }
    if (plan.method != Method::trace) row("error", error_text(plan));
    return text + work_and_left_out(plan);
}

std::string explain(const Plan& plan, const MeshFacts& facts, const Capabilities& capabilities) {
    std::string text = "uses\n";
    const auto row = [&](const char* what, const std::string& value) { text += line(what, value); };
    row("method", fmt::format("{} of the mesh", name_of(plan.method)));
    row("mesh", fmt::format("{} tets, {} points", facts.tets, facts.points));
    row("scalar",
        fmt::format("\"{}\" from {:.6g} to {:.6g}", facts.scalar, facts.range.lo, facts.range.hi));
    if (plan.method == Method::project) {
        row("context", capabilities.renderer);
        explain_projection(plan.project, facts, capabilities.cpu, row);
    }
    if (plan.method != Method::trace) row("error", error_text(plan));
    return text + work_and_left_out(plan);
}

}  // namespace lamina
