// SPDX-License-Identifier: Apache-2.0
#include "meshing/volume_mesh.h"

#include <glm/geometric.hpp>

#include <utility>

#include "meshing/adaptive_mesh.h"
#include "meshing/delaunay_process.h"
#include "meshing/kuhn_mesh.h"

namespace lamina {
namespace {

// How closely the error of a Kuhn split is measured, as a fraction of the range of values.
constexpr double kuhn_error_floor = 1e-4;

MeshData kuhn_mesh(const TrilinearField& field, const InterpolationError& error,
                   const MeshSettings& settings, MeshReport& report) {
    MeshData mesh = make_kuhn_mesh(field, settings.max_tets);
    report.error = error.largest(mesh.points, mesh.point_scalars[0].values, mesh.tets,
                                 kuhn_error_floor * report.range);
    report.within_tolerance = report.error <= settings.tolerance * report.range;
    return mesh;
}

MeshData adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                       const MeshSettings& settings, MeshReport& report) {
    const auto program = require_tetrahedralizer();
    const auto delaunay = [&](std::span<const glm::dvec3> points) {
        return delaunay_by_process(program, points);
    };
    return make_adaptive_mesh(field, error, delaunay, settings, report);
}

}  // namespace

void place_in_world(MeshData& mesh, const Grid& grid) {
    for (glm::dvec3& point : mesh.points) point = grid.to_world(point);
    const bool mirrored = glm::dot(glm::cross(grid.step[0], grid.step[1]), grid.step[2]) < 0;
    if (!mirrored) return;
    for (Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
}

MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report) {
    const TrilinearField field(volume);
    const CellRanges ranges(field);
    const InterpolationError error(field, ranges, transfer_function);
    report = {};
    report.kuhn_tets = kuhn_tet_count(field);
    report.range = field.range().hi - field.range().lo;
    MeshData mesh = settings.kuhn ? kuhn_mesh(field, error, settings, report)
                                  : adaptive_mesh(field, error, settings, report);
    report.points = static_cast<std::int64_t>(mesh.points.size());
    report.tets = static_cast<std::int64_t>(mesh.tets.size());
    place_in_world(mesh, volume.grid());
    return mesh;
}

}  // namespace lamina
