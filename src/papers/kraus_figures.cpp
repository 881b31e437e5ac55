// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, Figures 7 to 10.
#include <fmt/format.h>

#include <cmath>

#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/findings.h"
#include "papers/kraus.h"
#include "papers/kraus_stage.h"
#include "papers/kraus_variants.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* view_note = "View and transfer function are ours.";

std::string falls(const VariantErrors& from, const VariantErrors& to) {
    return fmt::format(
        "L2 {:.3g} with {}, {:.3g} with {}; Linf {:.3g} and {:.3g}; L1 {:.3g} and "
        "{:.3g}",
        from.all.l2, from.name, to.all.l2, to.name, from.all.linf, to.all.linf, from.all.l1,
        to.all.l1);
}

void add_better(Findings& findings, const std::string& says, const VariantErrors& worse,
                const VariantErrors& better) {
    findings.add(says, worse.all.l2 > better.all.l2, falls(worse, better));
}

}  // namespace

Json draw_kraus_figure7(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("bluntfin");
    const Scene& scene = subject.smooth;
    const auto made = write_compared_pictures(
        folder, "figure7", subject,
        {{"8-bit table, float buffer", with_table_format(scene, TableFormat::fixed8)},
         {"16-bit table, 8-bit buffer", with_target(scene, Target::fixed8)},
         {"16-bit table, float buffer", scene}},
        stage.capabilities());
    Findings findings;
    add_better(findings,
               "the structured artifacts shown in Figure 7a result from the coarsely quantized "
               "colors of such a lookup texture. On the other hand, HILO lookup textures produce "
               "artifact-free renderings as shown in Figure 7c",
               made.errors[0], made.errors[2]);
    add_better(findings,
               "Figure 7b shows a rendering using a frame buffer with only 8 bits per component "
               "[...]. This limited color depth results in structured artifacts, which are similar "
               "to those in Figure 7a",
               made.errors[1], made.errors[2]);
    return with_data_note(findings.result(made.values, nullptr, view_note), stage, {"bluntfin"},
                          "a generated box stands in");
}

Json draw_kraus_figure8(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("combustor");
    const Scene scene = with_default_integration(subject.isosurface);
    const auto made =
        write_compared_pictures(folder, "figure8", subject,
                                {{"linear interpolation", with_linear_interpolation(scene)},
                                 {"perspective interpolation", scene}},
                                stage.capabilities());
    Findings findings;
    add_better(findings,
               "Without perspective interpolation, artifacts in the form of cracks and overlaps "
               "occur along the intersections of the isosurface with cell faces",
               made.errors[0], made.errors[1]);
    return with_data_note(
        findings.result(made.values, nullptr,
                        std::string("The paper's heat sink is not to be had. ") + view_note),
        stage, {"combustor"}, "a generated box stands in");
}

Json draw_kraus_figure9(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("combustor");
    const Scene& scene = subject.faint;
    const auto made =
        write_compared_pictures(folder, "figure9", subject,
                                {{"8-bit buffer", with_target(scene, Target::fixed8)},
                                 {"8-bit buffer, alpha dithering",
                                  with_target(scene, Target::fixed8, ProjectDither::alpha)},
                                 {"8-bit buffer, dithered after blending",
                                  with_target(scene, Target::fixed8, ProjectDither::after_blend)},
                                 {"float buffer", scene}},
                                stage.capabilities());
    Findings findings;
    add_better(findings,
               "alpha dithering alleviates rendering artifacts resulting from quantization errors "
               "to a certain extent",
               made.errors[0], made.errors[1]);
    add_better(findings,
               "With floating-point precision for the color compositing, alpha dithering is "
               "unnecessary",
               made.errors[1], made.errors[3]);
    findings.add(
        "Dithered after a programmable blend the picture has no bias (docs/numerics.md, "
        "section 8)",
        std::abs(made.errors[2].all.l1) <= 0.3,
        fmt::format("L1 is {:.3f}; plain {:.3f}, with the paper's dithering {:.3f}",
                    made.errors[2].all.l1, made.errors[0].all.l1, made.errors[1].all.l1));
    return with_data_note(
        findings.result(
            made.values, nullptr,
            std::string("The paper's tapered cylinder is not to be had; total opacity up to .1. ") +
                view_note),
        stage, {"combustor"}, "a generated box stands in");
}

Json draw_kraus_figure10(const std::filesystem::path& folder, KrausStage& stage) {
    Findings findings;
    Json values{{"files", Json::array()}, {"meshes", Json::array()}};
    const auto add = [&](KrausSubject& subject) {
        const Scene& scene = subject.isosurface;
        auto made = write_compared_pictures(
            folder, "figure10_" + subject.name, subject,
            {{"linear lengths", with_mapping(scene, LengthMapping::linear)},
             {"log2 (Equation 1)", with_mapping(scene, LengthMapping::log2)},
             {"octaves", scene},
             {"default", with_default_integration(scene)}},
            stage.capabilities());
        const auto& errors = made.errors;
        add_better(findings,
                   subject.name +
                       ": artifact-free rendering with a logarithmic lookup texture (Figure 10b)",
                   errors[0], errors[1]);
        findings.add(subject.name +
                         ": Uniform lookup textures [...] results in darker renderings with "
                         "substantial edge artifacts (Figure 10a)",
                     errors[0].all.l1 < 0,
                     fmt::format("L1 {:.3g}, Linf {:.3g}", errors[0].all.l1, errors[0].all.linf));
        add_better(findings,
                   subject.name +
                       ": linear inside each octave is better than Equation 1 "
                       "(docs/numerics.md, section 5)",
                   errors[1], errors[2]);
        for (const Json& file : made.values["files"]) values["files"].push_back(file);
        made.values.erase("files");
        const EdgeLengths edges = edge_lengths(subject.mesh.tets());
        made.values["edge_ratio"] = edges.ratio();
        values["meshes"].push_back(made.values);
    };
    add(stage.subject("graded"));
    add(stage.subject("plate"));
    if (stage.has("bluntfin")) add(stage.subject("bluntfin"));
    return with_data_note(
        findings.result(values, nullptr,
                        std::string("The paper's X38 is not to be had: generated boundary layers "
                                    "of edge ratio 1e4 stand in. ") +
                            view_note),
        stage, {"bluntfin"}, "that mesh is left out");
}

}  // namespace lamina::papers
