// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, section 5.2: the effect of each remedy, on all meshes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"
#include "study/result_files.h"

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

// One statement, asked of every mesh. It holds if it holds on all of them.
class OnMeshes {
  public:
    // `measured`: the text for meshes for which the statement does not hold.
    void add(const std::string& mesh, bool holds, const std::string& measured) {
        if (holds)
            true_of_.push_back(mesh);
        else
            false_of_.push_back(fmt::format("{} ({})", mesh, measured));
    }
    bool asked() const { return !true_of_.empty() || !false_of_.empty(); }
    bool holds() const { return false_of_.empty(); }
    std::string measured() const {
        std::string text = fmt::format("true of {}", fmt::join(true_of_, "; "));
        if (true_of_.empty()) text = "true of no mesh";
        if (!false_of_.empty()) text += fmt::format("; not of {}", fmt::join(false_of_, "; "));
        return text;
    }

  private:
    std::vector<std::string> true_of_, false_of_;
};

struct Judged {
    OnMeshes linear, depth, coarse_table, linear_lengths, octaves, alpha, float_buffer, after_blend,
        faint_after;
};

// Adds whether each variant is worse than the next, by L2.
void add_chain(OnMeshes& statement, const std::string& mesh,
               const std::vector<VariantErrors>& errors, const std::vector<std::string>& names) {
    bool holds = true;
    std::string measured = "L2";
    double last = INFINITY;
    for (const std::string& name : names) {
        const ErrorNorms& all = find(errors, name).all;
        holds = holds && all.l2 < last;
        measured += fmt::format("{} {:.3g} with {}", std::isinf(last) ? "" : ",", all.l2, name);
        last = all.l2;
    }
    statement.add(mesh, holds, measured);
}

void judge(Judged& judged, const KrausSubject& subject, const std::vector<VariantErrors>& errors) {
    const std::string& on = subject.name;
    add_chain(judged.linear, on, errors, {"linear interpolation", all_remedies});
    const ErrorNorms& depth = find(errors, "depth as thickness").all;
    judged.depth.add(on, depth.linf <= visible, fmt::format("Linf {:.3g}", depth.linf));
    add_chain(judged.coarse_table, on, errors, {"fixed8 table", all_remedies});
    if (edge_lengths(subject.mesh.tets()).ratio() > graded) {
        add_chain(judged.linear_lengths, on, errors, {"linear mapping", "log2 mapping"});
        add_chain(judged.octaves, on, errors, {"log2 mapping", all_remedies});
    }
    add_chain(judged.alpha, on, errors, {"fixed8 buffer", "fixed8 buffer, alpha"});
    add_chain(judged.float_buffer, on, errors, {"fixed8 buffer, alpha", all_remedies});
    const double bias = find(errors, "fixed8 buffer, after_blend").all.l1;
    judged.after_blend.add(on, std::abs(bias) <= 0.3, fmt::format("L1 {:.3f}", bias));
}

void judge_faint(Judged& judged, const KrausSubject& subject,
                 const std::vector<VariantErrors>& errors) {
    const std::string on = subject.name + ", total opacity .1";
    add_chain(judged.alpha, on, errors, {"fixed8 buffer", "fixed8 buffer, alpha"});
    add_chain(judged.float_buffer, on, errors, {"fixed8 buffer, alpha", all_remedies});
    add_chain(judged.faint_after, on, errors,
              {"fixed8 buffer", "fixed8 buffer, after_blend", all_remedies});
}

Findings findings_of(const Judged& judged) {
    Findings findings;
    const auto add = [&](const char* says, const OnMeshes& on) {
        if (on.asked()) findings.add(says, on.holds(), on.measured());
    };
    const auto add_own = [&](const char* claim, const OnMeshes& on) {
        if (on.asked()) findings.add_own(claim, on.holds(), on.measured());
    };
    add("Perspective interpolation of vertex attributes is required in the PT algorithm since an "
        "incorrect linear interpolation of texture coordinates causes erroneous coloring",
        judged.linear);
    add("it is often possible to simplify the computation of l without introducing visible "
        "rendering artifacts with the help of the approximation",
        judged.depth);
    add("An 8-bit per component pre-integrated lookup texture does not offer sufficient color "
        "depth",
        judged.coarse_table);
    add("a uniform lookup texture is inappropriate if the ratio between the lengths of the longest "
        "and the shortest mesh edges is very high",
        judged.linear_lengths);
    add("alpha dithering alleviates rendering artifacts resulting from quantization errors to a "
        "certain extent.",
        judged.alpha);
    add("With floating-point precision for the color compositing, alpha dithering is unnecessary",
        judged.float_buffer);
    add_own("Octaves are better than Equation 1", judged.octaves);
    add_own("8 bits dithered after the blend have no bias: |L1| <= 0.3", judged.after_blend);
    add_own(
        "8 bits dithered after the blend are better than 8 bits, and a float buffer is better "
        "than both",
        judged.faint_after);
    return findings;
}

}  // namespace

Json draw_kraus_artifacts(const std::filesystem::path& folder, KrausStage& stage) {
    Judged judged;
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
        judge(judged, *subject, add("smooth", ladder(subject->smooth)));
        judge_faint(judged, *subject, add("faint", buffers(subject->faint)));
        add("isosurface", ladder(subject->isosurface));
    }
    study::write_text(folder / "artifacts.csv", study::csv_of_rows(rows));
    return result_with_data(
        findings_of(judged),
        {{"files", {"artifacts.csv"}},
         {"pixels", {stage.sizes().width, stage.sizes().height}},
         {"rows", rows}},
        nullptr,
        "Judged with the smooth transfer functions, of total opacity up to .5 (.1 where said), on "
        "all meshes together; tables hold opacity, 256 x 256 x 16.",
        stage, {{"bluntfin", "combustor", "torso"}, "generated meshes are judged alone"});
}

}  // namespace lamina::papers
