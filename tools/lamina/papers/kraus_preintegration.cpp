// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, section 6: numerical against analytic pre-integration.
#include <fmt/format.h>

#include <algorithm>

#include "base/profile.h"
#include "papers/compared_pictures.h"
#include "papers/figure_files.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"
#include "preintegration/preintegration_table.h"
#include "scene/camera.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

// Returns half of a side: frames that are timed many times are smaller.
int half(int pixels) {
    return std::max(1, pixels / 2);
}

enum TableVariant : std::size_t { incremental, exact, ours_incremental, ours, automatic, analytic };

std::vector<Variant> variants_of(const Scene& scene) {
    const auto table = [&](TableStore store, TableConstruction construction) {
        Scene made = scene;
        made.project.table->store = store;
        made.project.table->construction = construction;
        return made;
    };
    const Scene default_integration = with_default_integration(scene);
    Scene closed_form = scene;
    closed_form.project.coloring = Coloring::analytic;
    using enum TableStore;
    return {
        {"opacity, incremental", table(opacity, TableConstruction::incremental)},
        {"opacity, exact", table(opacity, TableConstruction::exact)},
        {"mean extinction, incremental", table(mean_extinction, TableConstruction::incremental)},
        {"mean extinction, exact", table(mean_extinction, TableConstruction::exact)},
        {"default", default_integration},
        {"analytic", closed_form}};
}

// Returns the milliseconds to build the scene's table, or null if its plan uses no such table.
Json build_ms(const KrausSubject& subject, const Scene& scene, const Capabilities& capabilities) {
    Pipeline pipeline(scene, subject.mesh.data(),
                      {.capabilities = capabilities, .tables = subject.tables});
    const Plan& plan = pipeline.plan();
    if (plan.project.source != SegmentSource::table) return nullptr;
    const TransferFunction transfer_function =
        in_units(*scene.transfer_function, plan.project.unit);
    const Stopwatch watch;
    const auto table = build_table(transfer_function, plan.project.table.request);
    return watch.milliseconds();
}

Json measured_rows(KrausSubject& subject, const char* transfer_function, const Scene& scene,
                   KrausStage& stage, std::vector<VariantErrors>& errors) {
    const std::vector<Variant> variants = variants_of(scene);
    std::vector<MeshFrame> frames;
    for (const Variant& variant : variants) {
        frames.emplace_back(variant.name, subject.mesh, variant.scene, stage.capabilities(),
                            subject.tables);
        Pipeline& pipeline = *frames.back().pipeline;
        pipeline.draw_frame();
        errors.push_back(errors_of(
            variant.name, difference(pipeline.renderer().picture(), subject.mesh.exact(scene))));
    }
    const auto to_time = timed(frames);
    const Json times = time_rows(
        to_time, study::time_interleaved("preintegration: times", to_time, stage.sizes().rounds));
    Json rows = Json::array();
    for (std::size_t i = 0; i < variants.size(); ++i) {
        Json row = error_row(subject, errors[i]);
        row["transfer_function"] = transfer_function;
        row["ms"] = times[i]["ms"];
        row["ratio"] = times[i]["ratio"];
        row["build_ms"] = build_ms(subject, variants[i].scene, stage.capabilities());
        rows.push_back(row);
    }
    return rows;
}

void judge(Findings& findings, const std::string& on, const std::vector<VariantErrors>& errors,
           const Json& rows) {
    const auto l2 = [&](TableVariant variant) { return errors[variant].all.l2; };
    findings.add_own(
        on + "the analytic solution is nearer to the tracer than the paper's numerical "
             "pre-integration",
        l2(analytic) < l2(incremental),
        fmt::format("L2 {:.4g} and {:.4g} ({:.4g} from a table of exact entries), Linf "
                    "{:.3g} and {:.3g}; a frame takes {:.2f} times as long",
                    l2(analytic), l2(incremental), l2(exact), errors[analytic].all.linf,
                    errors[incremental].all.linf, rows[analytic]["ratio"].get<double>()));
    findings.add_own(
        on + "what the table holds weighs more than how it was made",
        l2(ours_incremental) < l2(exact),
        fmt::format("L2 {:.4g} with mean extinction made incrementally, {:.4g} with exact "
                    "opacities, {:.4g} with both, {:.4g} automatic",
                    l2(ours_incremental), l2(exact), l2(ours), l2(automatic)));
}

}  // namespace

Json draw_kraus_preintegration(const std::filesystem::path& folder, KrausStage& stage) {
    Findings findings;
    Json rows = Json::array();
    for (const char* name : {"bluntfin", "graded"}) {
        KrausSubject& subject = stage.subject(name);
        const auto add = [&](const char* transfer_function, Scene scene) {
            scene.width = half(stage.sizes().width);
            scene.height = half(stage.sizes().height);
            std::vector<VariantErrors> errors;
            const Json measured = measured_rows(subject, transfer_function, scene, stage, errors);
            judge(findings, fmt::format("{}, {}: ", subject.name, transfer_function), errors,
                  measured);
            for (const Json& row : measured) rows.push_back(row);
        };
        add("dense", subject.dense);
        add("isosurface", subject.isosurface);
    }
    study::write_text(folder / "preintegration.csv", csv_of_rows(rows));
    return result_with_data(findings,
                            {{"files", {"preintegration.csv"}},
                             {"pixels", {half(stage.sizes().width), half(stage.sizes().height)}},
                             {"rounds", stage.sizes().rounds},
                             {"rows", rows}},
                            nullptr,
                            "Tables: 256 x 256 x 16, 16 bits, octaves; float32 target. `ratio`: to "
                            "the first row of the same mesh and transfer function.",
                            stage, {"bluntfin"}, "a generated box stands in");
}

}  // namespace lamina::papers
