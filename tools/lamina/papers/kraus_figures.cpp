// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, Figures 7 to 10.
#include <fmt/format.h>

#include <cmath>

#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* view_note = "View and transfer function are ours.";

std::string falls(const VariantErrors& from, const VariantErrors& to) {
    return fmt::format(
        "L2 {:.3g} with {}, {:.3g} with {}; Linf {:.3g} and {:.3g}; L1 {:.3g} and {:.3g}",
        from.all.l2, from.name, to.all.l2, to.name, from.all.linf, to.all.linf, from.all.mean,
        to.all.mean);
}

bool is_worse(const VariantErrors& one, const VariantErrors& other) {
    return one.all.l2 > other.all.l2;
}

// Returns `what`, followed by how to read the insets of write_compared_pictures().
std::string caption_of(const std::string& what) {
    return what +
           " The insets magnify the frame and its contrast; the differences from the exact picture "
           "are signed, blue below and red above.";
}

}  // namespace

Json draw_kraus_figure7(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("bluntfin");
    const Scene& scene = subject.smooth;
    auto made = write_compared_pictures(
        folder, "figure7", subject,
        {{"8-bit table, float buffer", with_table_format(scene, TableFormat::fixed8)},
         {"16-bit table, 8-bit buffer", with_target(scene, Target::fixed8)},
         {"16-bit table, float buffer", scene}},
        stage.capabilities());
    const auto& errors = made.errors;
    Findings findings;
    findings.add(
        "the structured artifacts shown in Figure 7a result from the coarsely quantized colors of "
        "such a lookup texture. On the other hand, HILO lookup textures produce artifact-free "
        "renderings as shown in Figure 7c.",
        is_worse(errors[0], errors[2]), falls(errors[0], errors[2]));
    findings.add(
        "Figure 7b shows a rendering using a frame buffer with only 8 bits per component for color "
        "compositing. This limited color depth results in structured artifacts, which are similar "
        "to those in Figure 7a.",
        is_worse(errors[1], errors[2]), falls(errors[1], errors[2]));
    made.values["caption"] = caption_of("The blunt fin with coarse tables and buffers.");
    return result_with_data(findings, made.values, nullptr, view_note, stage, {"bluntfin"},
                            "a generated box stands in");
}

Json draw_kraus_figure8(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("combustor");
    const Scene scene = with_default_integration(subject.isosurface);
    auto made = write_compared_pictures(folder, "figure8", subject,
                                        {{"linear interpolation", with_linear_interpolation(scene)},
                                         {"perspective interpolation", scene}},
                                        stage.capabilities());
    const auto& errors = made.errors;
    Findings findings;
    findings.add_untestable(
        "Without perspective interpolation, artifacts in the form of cracks and overlaps occur "
        "along "
        "the intersections of the isosurface with cell faces, as shown in the inset in Figure 8a.",
        is_worse(errors[0], errors[1]), falls(errors[0], errors[1]));
    made.values["caption"] = caption_of(
        "An isosurface of the combustor, which stands in for the paper's heat sink, with both "
        "interpolations.");
    return result_with_data(findings, made.values, nullptr,
                            std::string("The paper's heat sink is not to be had. ") + view_note,
                            stage, {"combustor"}, "a generated box stands in");
}

Json draw_kraus_figure9(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("combustor");
    const Scene& scene = subject.faint;
    auto made =
        write_compared_pictures(folder, "figure9", subject,
                                {{"8-bit buffer", with_target(scene, Target::fixed8)},
                                 {"8-bit buffer, alpha dithering",
                                  with_target(scene, Target::fixed8, ProjectDither::alpha)},
                                 {"8-bit buffer, dithered after blending",
                                  with_target(scene, Target::fixed8, ProjectDither::after_blend)},
                                 {"float buffer", scene}},
                                stage.capabilities());
    const auto& errors = made.errors;
    Findings findings;
    findings.add_untestable(
        "alpha dithering alleviates rendering artifacts resulting from quantization errors to a "
        "certain extent. Figure 9a shows the NASA tapered cylinder data set rendered with an 8-bit "
        "per component frame buffer.",
        is_worse(errors[0], errors[1]), falls(errors[0], errors[1]));
    findings.add_untestable(
        "With floating-point precision for the color compositing, alpha dithering is unnecessary, "
        "as shown in Figure 9c.",
        is_worse(errors[1], errors[3]), falls(errors[1], errors[3]));
    findings.add_own(
        "Dithered after a programmable blend the picture has no bias (docs/numerics.md, section 8)",
        std::abs(errors[2].all.mean) <= 0.3,
        fmt::format("L1 is {:.3f}; plain {:.3f}, with the paper's dithering {:.3f}",
                    errors[2].all.mean, errors[0].all.mean, errors[1].all.mean));
    made.values["caption"] = caption_of(
        "The combustor, which stands in for the paper's tapered cylinder, with a total opacity up "
        "to .1.");
    return result_with_data(
        findings, made.values, nullptr,
        std::string("The paper's tapered cylinder is not to be had; total opacity up to .1. ") +
            view_note,
        stage, {"combustor"}, "a generated box stands in");
}

Json draw_kraus_figure10(const std::filesystem::path& folder, KrausStage& stage) {
    Findings findings;
    Json values{{"files", Json::array()}, {"meshes", Json::array()}};
    bool darker = true, logarithmic_better = true;
    std::string uniform, logarithmic;
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
        const std::string on = fmt::format("{}{}: ", uniform.empty() ? "" : "; ", subject.name);
        darker = darker && errors[0].all.mean < 0;
        uniform +=
            on + fmt::format("L1 {:.3g}, Linf {:.3g}", errors[0].all.mean, errors[0].all.linf);
        logarithmic_better = logarithmic_better && is_worse(errors[0], errors[1]);
        logarithmic += on + falls(errors[0], errors[1]);
        findings.add_own(subject.name +
                             ": linear inside each octave is better than Equation 1 "
                             "(docs/numerics.md, section 5)",
                         is_worse(errors[1], errors[2]), falls(errors[1], errors[2]));
        for (const Json& file : made.values["files"]) values["files"].push_back(file);
        made.values.erase("files");
        made.values["edge_ratio"] = edge_lengths(subject.mesh.tets()).ratio();
        values["meshes"].push_back(made.values);
    };
    add(stage.subject("graded"));
    add(stage.subject("plate"));
    if (stage.has("bluntfin")) add(stage.subject("bluntfin"));
    findings.add_untestable(
        "This results in darker renderings with substantial edge artifacts (Figure 10a)", darker,
        "with a uniform lookup texture, " + uniform);
    findings.add_untestable(
        "as opposed to the artifact-free rendering with a logarithmic lookup texture (Figure 10b).",
        logarithmic_better, logarithmic);
    values["caption"] = caption_of(
        "Isosurfaces of generated boundary layers and of the blunt fin, which stand in for the "
        "paper's X38, with lengths spaced evenly and logarithmically in the table.");
    return result_with_data(findings, values, nullptr,
                            std::string("The paper's X38 is not to be had: generated boundary "
                                        "layers of edge ratio 1e4 stand in. ") +
                                view_note,
                            stage, {"bluntfin"}, "that mesh is left out");
}

}  // namespace lamina::papers
