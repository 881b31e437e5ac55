// SPDX-License-Identifier: Apache-2.0
#include "study/kept_meshes.h"

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "mesh_files/mesh_file.h"
#include "study/picture_key.h"
#include "study/text_file.h"

namespace lamina::study {
namespace {

nlohmann::ordered_json facts_of(const SceneMesh& mesh, double ms) {
    const MeshReport& report = mesh.report.value();
    return {{"mesh", content_of(mesh)},
            {"ms", ms},
            {"points", report.points},
            {"tets", report.tets},
            {"kuhn_tets", report.kuhn_tets},
            {"rounds", report.rounds},
            {"range", report.range},
            {"error", report.error},
            {"within_tolerance", report.within_tolerance},
            {"stopped_by_max_tets", report.stopped_by_max_tets}};
}

MeshReport report_from(const nlohmann::json& facts) {
    MeshReport report;
    facts.at("points").get_to(report.points);
    facts.at("tets").get_to(report.tets);
    facts.at("kuhn_tets").get_to(report.kuhn_tets);
    facts.at("rounds").get_to(report.rounds);
    facts.at("range").get_to(report.range);
    facts.at("error").get_to(report.error);
    facts.at("within_tolerance").get_to(report.within_tolerance);
    facts.at("stopped_by_max_tets").get_to(report.stopped_by_max_tets);
    return report;
}

}  // namespace

std::optional<MadeMesh> KeptMeshes::find(const std::string& id, const Scene& scene) const {
    if (!std::filesystem::exists(file(id, ".json"))) return std::nullopt;
    try {
        const nlohmann::json facts = load_json(file(id, ".json"));
        Scene whole = scene;
        whole.scalar.clear();  // the file has one
        MadeMesh made{SceneData(whole, read_mesh(file(id, ".vtu")), report_from(facts)),
                      facts.at("ms").get<double>()};
        if (content_of(*made.data.mesh(whole)) != facts.at("mesh").get<std::string>())
            return std::nullopt;
        return made;
    } catch (const Error&) {
    } catch (const nlohmann::json::exception&) {
    }
    return std::nullopt;
}

// The mesh is written before the facts: a mesh with a .json is complete.
void KeptMeshes::keep(const std::string& id, MadeMesh& made) const {
    const SceneMesh& drawn = *made.data.mesh({});
    const TetMesh& tets = drawn.mesh;
    MeshData data;
    data.points.assign(tets.points().begin(), tets.points().end());
    data.tets.assign(tets.tets().begin(), tets.tets().end());
    data.point_scalars = {drawn.scalar};
    AtomicFile mesh(file(id, ".vtu"));
    write_vtu(mesh, data);
    mesh.commit();
    write_text(file(id, ".json"), json_text(facts_of(drawn, made.ms)) + "\n");
}

}  // namespace lamina::study
