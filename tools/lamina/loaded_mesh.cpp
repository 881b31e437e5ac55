// SPDX-License-Identifier: Apache-2.0
#include "loaded_mesh.h"

#include <fmt/format.h>

#include "base/stage.h"

namespace lamina {
namespace {

void count_cells(const RenderRequest& request, const CellCounts& cells, RenderStats& stats) {
    stats.counts["split_cells"] = cells.split;
    stats.counts["skipped_cells"] = cells.skipped;
    stats.counts["straightened_cells"] = cells.straightened;
    if (cells.skipped > 0) {
        request.message(fmt::format("{} cells have no volume and are not drawn", cells.skipped));
    }
    if (cells.straightened > 0) {
        request.message(
            fmt::format("{} quadratic tets are drawn with straight edges", cells.straightened));
    }
}

void report_made(const RenderRequest& request, const MeshReport& report, RenderStats& stats) {
    stats.mesh_error = report.relative_error();
    if (!report.within_tolerance && !request.scene.mesh_request->kuhn) {
        request.message(fmt::format(
            "the mesh stopped {} with {} tets: it differs from the volume by up to {:.3g} of "
            "the range of values, wanted {:.3g}",
            report.stopped_by_max_tets ? "at max_tets" : "where points would lie too close",
            report.tets, report.relative_error(), request.scene.mesh_request->tolerance));
    }
}

void count_findings(const RenderRequest& request, const LoadedMesh& mesh, RenderStats& stats) {
    const MeshFindings& findings = mesh.facts.findings;
    stats.counts["tets"] = mesh.facts.tets;
    stats.counts["degenerate_tets"] = findings.degenerate;
    stats.counts["inverted_tets"] = findings.inverted;
    stats.counts["duplicate_tets"] = findings.duplicates;
    stats.counts["nonmanifold_faces"] = findings.nonmanifold_faces;
    stats.counts["folded_faces"] = findings.folded_faces;
    stats.counts["non_finite_values"] = mesh.facts.non_finite;
    count_cells(request, findings.cells, stats);
    if (mesh.data.averaged) {
        stats.counts["averaged_arrays"] = 1;
        request.message(fmt::format("\"{}\" is cell data: averaged to points", mesh.facts.scalar));
    }
    if (mesh.facts.non_finite > 0) {
        request.message(
            fmt::format("{} values are NaN or infinite: their tets are drawn transparent",
                        mesh.facts.non_finite));
    }
    if (mesh.data.report) report_made(request, *mesh.data.report, stats);
}

SceneMesh load(const RenderRequest& request, RenderStats& stats) {
    Stage loading("load");
    SceneMesh mesh = load_mesh(request.scene);
    stats.stages_ms["load"] = loading.end();
    return mesh;
}

}  // namespace

LoadedMesh::LoadedMesh(const RenderRequest& request, RenderStats& stats)
    : data(load(request, stats)) {
    Stage measuring("measure");
    facts = measure(request.scene, data);
    stats.stages_ms["measure"] = measuring.end();
    count_findings(request, *this, stats);
}

}  // namespace lamina
