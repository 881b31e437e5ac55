// SPDX-License-Identifier: Apache-2.0
// Kraus 2004: the effect of each remedy on all meshes (section 5.2), and of incorrect visibility
// orderings (section 6).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/figure_files.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* all_remedies = "all remedies";
constexpr double visible = 1;    // smallest visible error, in 1/255
constexpr double graded = 1000;  // edge ratio above which a mesh counts as graded

// Returns the variants of `scene`, which has every remedy of the paper, each with one remedy off.
// The last one has lamina's remedies, too.
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

// Returns variants of the frame buffer, for tets of low opacity.
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

// A statement about meshes, which holds if it is true of every mesh that was added.
class OnMeshes {
  public:
    // `measured`: shown for meshes on which the statement does not hold.
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

// Adds a mesh: the statement holds if each of the named variants has a larger L2 than the next one.
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
    const double bias = find(errors, "fixed8 buffer, after_blend").all.mean;
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

// Error that integration and float32 may add to a picture in the right order, in 1/255.
constexpr double right_linf = 1;

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
    study::write_text(folder / "artifacts.csv", csv_of_rows(rows));
    return result_with_data(
        findings_of(judged),
        {{"files", {"artifacts.csv"}},
         {"pixels", {stage.sizes().width, stage.sizes().height}},
         {"rows", rows}},
        nullptr,
        "Judged with the smooth transfer functions, of total opacity up to .5 (.1 where said), on "
        "all meshes together; tables hold opacity, 256 x 256 x 16.",
        stage, {"bluntfin", "combustor", "torso"}, "generated meshes are judged alone");
}

Json draw_kraus_orders(const std::filesystem::path& folder, KrausStage& stage) {
    Findings findings;
    Json files{"orders.csv"}, rows = Json::array(), panels = Json::array();
    int right = 0, meshes = 0;
    std::string williams;
    for (KrausSubject* subject : stage.subjects()) {
        const Scene scene = with_default_integration(subject->dense);
        const auto made =
            write_compared_pictures(folder, "orders_" + subject->name, *subject,
                                    {{"none", with_order(scene, ProjectOrder::none)},
                                     {"centroid", with_order(scene, ProjectOrder::centroid)},
                                     {"mpvo", with_order(scene, ProjectOrder::mpvo)},
                                     {"exact", with_order(scene, ProjectOrder::exact)}},
                                    stage.capabilities());
        for (const Json& file : made.values["files"]) files.push_back(file);
        for (const Json& row : made.values["rows"]) rows.push_back(row);
        for (const Json& panel : made.values["panels"]) panels.push_back(panel);
        const ErrorNorms& mpvo = made.errors[2].all;
        right += mpvo.linf <= right_linf;
        ++meshes;
        williams += fmt::format("{}{}: Linf {:.3g}, L2 {:.3g}", williams.empty() ? "" : "; ",
                                subject->name, mpvo.linf, mpvo.l2);
        const ErrorNorms& centroid = made.errors[1].all;
        findings.add_own(subject->name + ": with the exact order nothing is left of the errors",
                         made.errors[3].all.linf <= right_linf,
                         fmt::format("Linf {:.3g} and L2 {:.3g}; by centroids {:.3g} and {:.3g}, "
                                     "without an order {:.3g} and {:.3g}",
                                     made.errors[3].all.linf, made.errors[3].all.l2, centroid.linf,
                                     centroid.l2, made.errors[0].all.linf, made.errors[0].all.l2));
    }
    findings.add(
        "the extension of the meshed polyhedra visibility ordering (MPVO) algorithm for nonconvex "
        "meshes suggested by Williams [22], which computes a correct ordering for most tetrahedral "
        "meshes.",
        2 * right > meshes,
        fmt::format("within {} / 255 on {} of {} meshes ({})", right_linf, right, meshes,
                    williams));
    study::write_text(folder / "orders.csv", csv_of_rows(rows));
    return result_with_data(
        findings,
        {{"files", files},
         {"pixels", {stage.sizes().width, stage.sizes().height}},
         {"rows", rows},
         {"panels", panels},
         {"caption",
          "Each mesh without an order of its tets, and in three orders. The insets magnify the "
          "frame and its contrast; the differences from the exact picture are signed, blue below "
          "and red above."}},
        nullptr, "Total opacity up to .95, default integration, float32.", stage,
        {"bluntfin", "combustor", "torso"}, "generated meshes are judged alone");
}

}  // namespace lamina::papers
