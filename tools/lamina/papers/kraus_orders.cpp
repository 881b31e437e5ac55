// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, section 6: the effect of incorrect visibility orderings.
#include <fmt/format.h>

#include "papers/compared_pictures.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"
#include "study/result_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

// The error that integration and float32 may add to a picture in the right order, in 1/255.
constexpr double right_linf = 1;

}  // namespace

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
    study::write_text(folder / "orders.csv", study::csv_of_rows(rows));
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
        {{"bluntfin", "combustor", "torso"}, "generated meshes are judged alone"});
}

}  // namespace lamina::papers
