// SPDX-License-Identifier: Apache-2.0
#include "loaded_mesh.h"

#include <fmt/format.h>

#include "mesh/scalar_range.h"

namespace lamina {
namespace {

void count_cells(const RenderRequest& request, const CellCounts& cells, RenderStats& stats) {
    stats.counts["split_cells"] = cells.split;
    stats.counts["skipped_cells"] = cells.skipped;
    stats.counts["straightened_cells"] = cells.straightened;
    stats.counts["ghost_cells"] = cells.ghosts;
    stats.counts["merged_points"] = cells.merged_points;
    if (cells.merged_points > 0) {
        request.message(fmt::format("{} points that pieces of the mesh share are one each",
                                    cells.merged_points));
    }
    if (cells.skipped > 0) {
        request.message(fmt::format("{} cells have no volume and are not drawn", cells.skipped));
    }
    if (cells.straightened > 0) {
        request.message(
            fmt::format("{} quadratic cells are drawn with straight edges", cells.straightened));
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

}  // namespace

void report_mesh(const RenderRequest& request, const SceneMesh& mesh, RenderStats& stats) {
    const MeshFindings& findings = mesh.mesh.findings();
    const std::int64_t non_finite = measure_range(mesh.scalar.values).non_finite;
    stats.counts["tets"] = static_cast<std::int64_t>(mesh.mesh.tets().size());
    stats.counts["degenerate_tets"] = findings.degenerate;
    stats.counts["inverted_tets"] = findings.inverted;
    stats.counts["duplicate_tets"] = findings.duplicates;
    stats.counts["nonmanifold_faces"] = findings.nonmanifold_faces;
    stats.counts["folded_faces"] = findings.folded_faces;
    stats.counts["non_finite_values"] = non_finite;
    count_cells(request, findings.cells, stats);
    if (mesh.averaged) {
        stats.counts["averaged_arrays"] = 1;
        request.message(fmt::format("\"{}\" is cell data: averaged to points", mesh.scalar.name));
    }
    if (non_finite > 0) {
        request.message(fmt::format(
            "{} values are NaN or infinite: their tets are drawn transparent", non_finite));
    }
    if (mesh.report) report_made(request, *mesh.report, stats);
}

}  // namespace lamina
