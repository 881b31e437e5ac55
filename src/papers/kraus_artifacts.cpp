// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, section 5.2: the effect of each remedy, on all meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/findings.h"
#include "papers/kraus.h"
#include "papers/kraus_stage.h"
#include "papers/kraus_variants.h"
#include "study/text_file.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* all_remedies = "all remedies";
constexpr double visible = 1;    // from this error on, in 1/255
constexpr double graded = 1000;  // edge ratio, from which a mesh counts as graded

// `scene` has every remedy of the paper. The last variant has ours, too.
std::vector<Variant> ladder(const Scene& scene) {
    return {{all_remedies, scene},
            {"linear interpolation", with_linear_interpolation(scene)},
            {"depth as thickness", with_depth_as_thickness(scene)},
            {"vertex coloring", with_coloring(scene, Coloring::vertex)},
            {"attenuation coloring", with_coloring(scene, Coloring::attenuation)},
            {"fixed8 table", with_table_format(scene, TableFormat::fixed8)},
            {"linear mapping", with_mapping(scene, LengthMapping::linear)},
            {"log2 mapping", with_mapping(scene, LengthMapping::log2)},
            {"fixed8 buffer", with_target(scene, Target::fixed8)},
            {"fixed8 buffer, alpha", with_target(scene, Target::fixed8, ProjectDither::alpha)},
            {"fixed8 buffer, after_blend",
             with_target(scene, Target::fixed8, ProjectDither::after_blend)},
            {"fixed16 buffer", with_target(scene, Target::fixed16)},
            {"float16 buffer", with_target(scene, Target::float16)},
            {"default", with_default_integration(scene)}};
}

// The variants of the frame buffer, for tets of low opacity.
std::vector<Variant> buffers(const Scene& scene) {
    return {{all_remedies, scene},
            {"fixed8 buffer", with_target(scene, Target::fixed8)},
            {"fixed8 buffer, alpha", with_target(scene, Target::fixed8, ProjectDither::alpha)},
            {"fixed8 buffer, after_blend",
             with_target(scene, Target::fixed8, ProjectDither::after_blend)}};
}

const VariantErrors& find(const std::vector<VariantErrors>& errors, const std::string& name) {
    const auto found = std::find_if(errors.begin(), errors.end(),
                                    [&](const VariantErrors& e) { return e.name == name; });
    assert(found != errors.end());
    return *found;
}

// Each variant should be worse than the next, by L2.
void judge_chain(Findings& findings, const std::string& says,
                 const std::vector<VariantErrors>& errors, const std::vector<std::string>& names) {
    bool holds = true;
    std::string measured = "L2";
    double last = INFINITY;
    for (const std::string& name : names) {
        const ErrorNorms& all = find(errors, name).all;
        holds = holds && all.l2 < last;
        measured += fmt::format("{} {:.4g} with {} (L1 {:.3g}, Linf {:.3g})",
                                std::isinf(last) ? "" : ",", all.l2, name, all.l1, all.linf);
        last = all.l2;
    }
    findings.add(says, holds, measured);
}

void judge(Findings& findings, const KrausSubject& subject,
           const std::vector<VariantErrors>& errors) {
    const std::string on = subject.name + ": ";
    judge_chain(findings, on + "linear interpolation is worse than perspective", errors,
                {"linear interpolation", all_remedies});
    const ErrorNorms& depth = find(errors, "depth as thickness").all;
    findings.add(on + "it is often possible to simplify the computation of l without introducing "
                      "visible rendering artifacts with the help of the approximation [by depths]",
                 depth.linf <= visible,
                 fmt::format("Linf {:.3g}, L1 {:.3g}, L2 {:.3g}", depth.linf, depth.l1, depth.l2));
    judge_chain(findings, on + "an 8-bit table is worse than one of 16 bits", errors,
                {"fixed8 table", all_remedies});
    if (edge_lengths(subject.mesh.tets()).ratio() > graded) {
        judge_chain(findings, on + "linear lengths are worse than log2", errors,
                    {"linear mapping", "log2 mapping"});
        judge_chain(findings, on + "log2 is worse than octaves", errors,
                    {"log2 mapping", all_remedies});
    }
    judge_chain(findings, on + "an 8-bit buffer is worse than one with the paper's dithering",
                errors, {"fixed8 buffer", "fixed8 buffer, alpha"});
    judge_chain(findings, on + "8 bits with the paper's dithering are worse than a float buffer",
                errors, {"fixed8 buffer, alpha", all_remedies});
    const double bias = find(errors, "fixed8 buffer, after_blend").all.l1;
    findings.add(on + "8 bits dithered after the blend have no bias: |L1| <= 0.3",
                 std::abs(bias) <= 0.3, fmt::format("L1 {:.3f}", bias));
}

void judge_faint(Findings& findings, const KrausSubject& subject,
                 const std::vector<VariantErrors>& errors) {
    const std::string on = subject.name + ", total opacity .1: ";
    judge_chain(findings, on + "8 bits are worse than dithered by the paper, and these than float",
                errors, {"fixed8 buffer", "fixed8 buffer, alpha", all_remedies});
    judge_chain(findings,
                on + "8 bits are worse than dithered after the blend, and these than float", errors,
                {"fixed8 buffer", "fixed8 buffer, after_blend", all_remedies});
}

}  // namespace

Json draw_kraus_artifacts(const std::filesystem::path& folder, KrausStage& stage) {
    Findings findings;
    Json rows = Json::array();
    for (KrausSubject* subject : stage.subjects()) {
        const auto add = [&](const char* transfer_function, const std::vector<Variant>& variants) {
            const auto errors = variant_errors("artifacts: " + subject->name, *subject, variants,
                                               stage.capabilities());
            for (const VariantErrors& e : errors) {
                Json row = error_row(*subject, e);
                row["transfer_function"] = transfer_function;
                rows.push_back(row);
            }
            return errors;
        };
        judge(findings, *subject, add("smooth", ladder(subject->smooth)));
        judge_faint(findings, *subject, add("faint", buffers(subject->faint)));
        add("isosurface", ladder(subject->isosurface));
    }
    study::write_text(folder / "artifacts.csv", study::csv_of_rows(rows));
    return with_data_note(
        findings.result(
            {{"files", {"artifacts.csv"}},
             {"pixels", {stage.sizes().width, stage.sizes().height}},
             {"rows", rows}},
            nullptr,
            "Judged with the smooth transfer functions, of total opacity up to .5 (.1 where "
            "said); tables hold opacity, 256 x 256 x 16."),
        stage, {"bluntfin", "combustor", "torso"}, "generated meshes are judged alone");
}

}  // namespace lamina::papers
