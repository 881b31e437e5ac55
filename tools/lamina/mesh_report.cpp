// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "base/output_file.h"
#include "file_report.h"
#include "image/png.h"
#include "json_vector.h"
#include "mesh/mesh_picture.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "mesh_files/mesh_file.h"
#include "statistics_report.h"
#include "volume/value_statistics.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr int panel_side = 480;  // pixels

Json describe(std::span<const MeshScalar> scalars) {
    Json list = Json::array();
    for (const MeshScalar& scalar : scalars) {
        const auto [range, non_finite] = measure_range(scalar.values);
        Json entry{{"name", scalar.name}, {"range", nullptr}};  // null: no finite value
        if (!range.empty()) entry["range"] = Json::array({range.lo, range.hi});
        entry["nan_count"] = non_finite;
        list.push_back(entry);
    }
    return list;
}

Json describe(const TetMesh& mesh, const ValueStatistics& statistics) {
    const MeshFindings& findings = mesh.findings();
    const double ratio = edge_lengths(mesh).ratio();
    Json info;
    info["kind"] = "mesh";
    info["points"] = mesh.points().size();
    info["tets"] = findings.tets_read;
    info["bounds"] = {{"min", json_vector(mesh.bounds().min)},
                      {"max", json_vector(mesh.bounds().max)}};
    info["scalars"] = describe(mesh.point_scalars());
    info["cell_scalars"] = describe(mesh.cell_scalars());
    info["boundary_faces"] = findings.boundary_faces;
    info["conforming"] = findings.conforming();
    info["degenerate"] = findings.degenerate;
    info["inverted"] = findings.inverted;
    info["duplicates"] = findings.duplicates;
    info["nonmanifold_faces"] = findings.nonmanifold_faces;
    info["folded_faces"] = findings.folded_faces;
    info["unused_points"] = findings.unused_points;
    info["edge_ratio"] = nullptr;  // infinite: an edge without length
    if (std::isfinite(ratio)) info["edge_ratio"] = ratio;
    info["convex"] = convex(mesh);
    info["split_cells"] = findings.cells.split;
    info["skipped_cells"] = findings.cells.skipped;
    info["straightened_cells"] = findings.cells.straightened;
    info["ghost_cells"] = findings.cells.ghosts;
    info["merged_points"] = findings.cells.merged_points;
    add_statistics(statistics, info);
    return info;
}

// Returns the first scalar at points, or nothing if the mesh has none.
std::span<const double> first_scalar(const TetMesh& mesh) {
    if (mesh.point_scalars().empty()) return {};
    return mesh.point_scalars().front().values;
}

CodedImage picture_of(const TetMesh& mesh, const ValueStatistics& statistics) {
    const std::span<const double> values = first_scalar(mesh);
    const ValueRange range = values.empty() ? ValueRange{0, 0} : measure_range(values).range;
    return above_one_another(mesh_picture(mesh, values, range, panel_side),
                             [&](int width) { return histogram_picture(statistics, width); });
}

}  // namespace

nlohmann::ordered_json report_on_mesh(const std::string& file, const std::string& png) {
    std::optional<AtomicFile> picture;  // first: a path that cannot be written fails at once
    if (!png.empty()) picture.emplace(png);
    const TetMesh mesh(read_mesh(file), file);
    const ValueStatistics statistics = measure_values(first_scalar(mesh));
    if (picture) {
        write_png(*picture, picture_of(mesh, statistics));
        picture->commit();
    }
    return describe(mesh, statistics);
}

}  // namespace lamina
