// SPDX-License-Identifier: Apache-2.0
#include "loaded_mesh.h"

#include "mesh/scalar_range.h"

namespace lamina {

void report_mesh(const SceneMesh& mesh, RenderStats& stats) {
    const MeshFindings& findings = mesh.mesh.findings();
    const CellCounts& cells = findings.cells;
    stats.counts["tets"] = static_cast<std::int64_t>(mesh.mesh.tets().size());
    stats.counts["degenerate_tets"] = findings.degenerate;
    stats.counts["inverted_tets"] = findings.inverted;
    stats.counts["duplicate_tets"] = findings.duplicates;
    stats.counts["nonmanifold_faces"] = findings.nonmanifold_faces;
    stats.counts["folded_faces"] = findings.folded_faces;
    stats.counts["non_finite_values"] = measure_range(mesh.scalar.values).non_finite;
    stats.counts["split_cells"] = cells.split;
    stats.counts["skipped_cells"] = cells.skipped;
    stats.counts["straightened_cells"] = cells.straightened;
    stats.counts["ghost_cells"] = cells.ghosts;
    stats.counts["merged_points"] = cells.merged_points;
    if (mesh.averaged) stats.counts["averaged_arrays"] = 1;
    if (mesh.report) stats.mesh_error = mesh.report->relative_error();
}

}  // namespace lamina
