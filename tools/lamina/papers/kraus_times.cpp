// SPDX-License-Identifier: Apache-2.0
// Kraus 2004, Tables 1 and 2: times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "papers/compared_pictures.h"
#include "papers/figure_files.h"
#include "papers/kraus.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

// A technique of Table 1 with the numbers that the paper prints, 0 if it prints none.
struct Technique {
    std::string name;
    Scene scene;
    double paper_seconds = 0;
};

std::vector<Technique> techniques(const Scene& best) {
    std::vector<Technique> ladder;
    const Scene fans = with_geometry(best, ProjectGeometry::triangles);
    Scene scene = with_linear_interpolation(with_target(fans, Target::fixed8));
    scene.project.table->format = TableFormat::fixed8;
    scene.project.table->mapping = LengthMapping::linear;
    ladder.push_back({"basic pre-integrated PT (i)", scene, 0.195});
    scene.project.interpolation = Interpolation::perspective;
    ladder.push_back({"+ perspective interpolation (ii)", scene, 0.243});
    scene.project.table->format = TableFormat::fixed16;
    ladder.push_back({"+ 16-bit table (iii)", scene, 0.274});
    scene.project.table->mapping = LengthMapping::log2;
    ladder.push_back({"+ log2 lookup (iv)", scene, 0.314});
    ladder.push_back({"+ octave lookup", with_mapping(scene, LengthMapping::octave)});
    ladder.push_back(
        {"log2, alpha dithering", with_target(scene, Target::fixed8, ProjectDither::alpha), 0.621});
    // OpenGL composites silhouettes alone on codes.
    const Scene silhouettes = with_geometry(scene, ProjectGeometry::silhouette);
    ladder.push_back({"log2, dithering after the blend, silhouettes",
                      with_target(silhouettes, Target::fixed8, ProjectDither::after_blend)});
    ladder.push_back({"log2, float16 buffer", with_target(scene, Target::float16)});
    ladder.push_back({"log2, float32 buffer", with_target(scene, Target::float32), 1.781});
    ladder.push_back({"ours, triangles", with_default_integration(fans)});
    ladder.push_back({"ours, silhouettes",
                      with_default_integration(with_geometry(best, ProjectGeometry::silhouette))});
    ladder.push_back(
        {"ours, the default", with_default_integration(with_geometry(best, Automatic()))});
    return ladder;
}

Scene timed_scene(Scene scene, const KrausSizes& sizes) {
    scene.width = sizes.timed_width;
    scene.height = sizes.timed_height;
    return scene;
}

void add_stages(Json& row, const MeshFrame& frame) {
    for (const auto& [stage, ms] : frame.pipeline->renderer().renderer().stages_ms())
        row[stage + "_ms"] = ms;
    row["tets_drawn"] = frame.pipeline->statistics().tets_drawn;
}

double ratio(const Json& rows, std::size_t of, std::size_t to) {
    return rows[of]["ms"].get<double>() / rows[to]["ms"].get<double>();
}

std::string against(double measured, double paper) {
    return fmt::format("{:.2f} times as long; the paper's: {:.2f}", measured, paper);
}

// Judges the rows, which are in the order of techniques(). The paper's times are of a graphics card
// of 2004.
void judge_table1(Findings& findings, const Json& rows) {
    enum : std::size_t { basic, perspective, fixed16, log2, octave, alpha, after, half, full };
    const auto overhead = [&](const char* says, std::size_t of, std::size_t to, double paper) {
        findings.add_untestable(says, ratio(rows, of, to) <= paper,
                                against(ratio(rows, of, to), paper));
    };
    overhead(
        "basic pre-integrated PT algorithm (i) 0.195; overhead for perspective interpolation (ii) "
        "0.048",
        perspective, basic, 0.243 / 0.195);
    overhead("overhead for HILO lookup textures (iii) 0.031", fixed16, perspective, 0.274 / 0.243);
    overhead("overhead for logarithmic lookup (iv) 0.040", log2, fixed16, 0.314 / 0.274);
    overhead(
        "basic pre-integrated PT algorithm (i) 0.195; total for frame buffer (i+ii+iii+iv) 0.314",
        log2, basic, 0.314 / 0.195);
    findings.add_untestable(
        "total for frame buffer (i+ii+iii+iv) 0.314; total with alpha dithering 0.621",
        ratio(rows, alpha, log2) > 1.5, against(ratio(rows, alpha, log2), 0.621 / 0.314));
    findings.add_untestable(
        "the color compositing in a floating-point color buffer is considerably slower than in a "
        "frame buffer.",
        ratio(rows, full, log2) > 1.5, against(ratio(rows, full, log2), 1.781 / 0.314));
    findings.add_untestable(
        "the rendering with hardware-supported blending to a 16-bit floating-point color buffer is "
        "only less than 1 % slower than the rendering to an 8-bit frame buffer",
        ratio(rows, half, log2) < 1.01,
        fmt::format("{:.2f} times as long; the paper's, on a GeForce FX 6800: less than 1.01",
                    ratio(rows, half, log2)));
}

// Size of the picture from which the extinctions of the boxes are derived.
constexpr int coarse_width = 160, coarse_height = 120;

struct TimedMesh {
    std::string name;
    const study::TracedMesh* mesh;
    Scene scene;
};

struct PaperMesh {
    const char* name;
    std::int64_t tets;
    double seconds;
};
constexpr PaperMesh paper_meshes[] = {{"heat sink", 121668, 0.252},
                                      {"blunt fin", 187318, 0.314},
                                      {"cylinder", 624960, 0.929},
                                      {"X38", 1943483, 3.07}};

Json printed_table2() {
    Json printed = Json::array();
    for (const PaperMesh& mesh : paper_meshes) {
        printed.push_back({{"mesh", mesh.name},
                           {"tets", mesh.tets},
                           {"seconds", mesh.seconds},
                           {"tets_per_second", static_cast<double>(mesh.tets) / mesh.seconds}});
    }
    return printed;
}

// Returns the meshes of Table 2: boxes from small to large, then data sets.
std::vector<TimedMesh> meshes_of_table2(KrausStage& stage, std::deque<study::TracedMesh>& boxes) {
    std::vector<TimedMesh> meshes;
    const Scene box_scene =
        timed_scene(make_kraus_subject(study::TracedMesh(make_box_mesh({8, 8, 8})), "box",
                                       coarse_width, coarse_height)
                        .dense,
                    stage.sizes());
    for (const std::int32_t cells : stage.sizes().timed_box_cells) {
        boxes.emplace_back(make_box_mesh({cells, cells, cells}));
        meshes.push_back({fmt::format("box of {} cubes an edge", cells), &boxes.back(), box_scene});
    }
    for (const char* name : {"torso", "bluntfin", "combustor"}) {
        if (!stage.has(name)) continue;
        KrausSubject& subject = stage.subject(name);
        meshes.push_back({name, &subject.mesh, timed_scene(subject.dense, stage.sizes())});
    }
    return meshes;
}

}  // namespace

Json draw_kraus_table1(const std::filesystem::path& folder, KrausStage& stage) {
    KrausSubject& subject = stage.subject("bluntfin");
    const std::vector<Technique> ladder = techniques(timed_scene(subject.smooth, stage.sizes()));
    std::vector<MeshFrame> frames;
    for (const Technique& technique : ladder) {
        frames.emplace_back(technique.name, subject.mesh, technique.scene, stage.capabilities(),
                            stage.tables());
    }
    const auto to_time = timed(frames);
    Json rows =
        time_rows(to_time, study::time_interleaved("table1", to_time, stage.sizes().rounds));
    for (std::size_t i = 0; i < ladder.size(); ++i) {
        add_stages(rows[i], frames[i]);
        const double seconds = ladder[i].paper_seconds;
        rows[i]["paper_s"] = seconds > 0 ? Json(seconds) : Json();
        rows[i]["paper_ratio"] = seconds > 0 ? Json(seconds / ladder[0].paper_seconds) : Json();
    }
    study::write_text(folder / "table1.csv", csv_of_rows(rows));
    Findings findings;
    judge_table1(findings, rows);
    const Json printed{{"basic pre-integrated PT algorithm (i)", 0.195},
                       {"overhead for perspective interpolation (ii)", 0.048},
                       {"overhead for HILO lookup textures (iii)", 0.031},
                       {"overhead for logarithmic lookup (iv)", 0.040},
                       {"total for frame buffer (i+ii+iii+iv)", 0.314},
                       {"total with alpha dithering", 0.621},
                       {"total for floating-point color buffer", 1.781}};
    return result_with_data(
        findings,
        {{"files", {"table1.csv"}},
         {"mesh", subject.name},
         {"pixels", {stage.sizes().timed_width, stage.sizes().timed_height}},
         {"renderer", renderer_and_threads(stage.capabilities())},
         {"rounds", stage.sizes().rounds},
         {"rows", rows}},
        printed,
        fmt::format("Whole frames, cell sorting included; the default takes {:.2f} times the time "
                    "of the paper's frame buffer total, its silhouettes {:.2f} times that of its "
                    "triangles.",
                    ratio(rows, 11, 3), ratio(rows, 10, 9)),
        stage, {"bluntfin"}, "a generated box stands in");
}

Json draw_kraus_table2(const std::filesystem::path& folder, KrausStage& stage) {
    std::deque<study::TracedMesh> boxes;
    const std::vector<TimedMesh> meshes = meshes_of_table2(stage, boxes);
    std::vector<MeshFrame> frames;
    for (const TimedMesh& mesh : meshes) {
        frames.emplace_back(mesh.name, *mesh.mesh, mesh.scene, stage.capabilities(),
                            stage.tables());
    }
    const auto to_time = timed(frames);
    const auto times = study::time_interleaved("table2", to_time, stage.sizes().rounds);
    Json rows = Json::array();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const auto tets = static_cast<double>(meshes[i].mesh->tets().tets().size());
        Json row{{"mesh", meshes[i].name},
                 {"tets", tets},
                 {"ms", times[i].ms},
                 {"cpu_ms", times[i].cpu_ms},
                 {"slowest_over_fastest", times[i].max / times[i].min},
                 {"tets_per_second", 1e3 * tets / times[i].ms}};
        add_stages(row, frames[i]);
        row["order_share"] = row["order_ms"].get<double>() /
                             (row["order_ms"].get<double>() + row["draw_ms"].get<double>());
        rows.push_back(row);
    }
    study::write_text(folder / "table2.csv", csv_of_rows(rows));
    double least = INFINITY, most = 0, order = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        order = std::max(order, rows[i]["order_share"].get<double>());
        if (i == 0 || i >= boxes.size()) continue;  // only boxes of the paper's sizes
        least = std::min(least, rows[i]["tets_per_second"].get<double>());
        most = std::max(most, rows[i]["tets_per_second"].get<double>());
    }
    Findings findings;
    findings.add_untestable(
        "The times are roughly linear in the number of projected tetrahedra but also depend "
        "strongly on the number of rasterized fragments.",
        most <= 673.0 / 483 * least,
        fmt::format("boxes of the paper's sizes: {:.0f}K to {:.0f}K tets per second; the paper's: "
                    "483K to 673K",
                    least / 1e3, most / 1e3));
    return result_with_data(
        findings,
        {{"files", {"table2.csv"}},
         {"pixels", {stage.sizes().timed_width, stage.sizes().timed_height}},
         {"renderer", renderer_and_threads(stage.capabilities())},
         {"rounds", stage.sizes().rounds},
         {"rows", rows}},
        printed_table2(), fmt::format("Cell sorting takes up to {:.0f} % of a frame.", 100 * order),
        stage, {"bluntfin", "combustor", "torso"}, "the data sets are left out");
}

}  // namespace lamina::papers
