// SPDX-License-Identifier: Apache-2.0
#include "meshing/volume_mesh.h"

#include <array>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include "base/error.h"
#include "base/parallel.h"
#include "meshing/adaptive_mesh.h"
#include "meshing/delaunay.h"

namespace lamina {

namespace {

// The corners (x + 2y + 4z) of the six tets, one for each order in which a path along the edges
// from corner 0 to corner 7 can take the axes; all positively oriented.
constexpr std::array<Tet, 6> cell_tets{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

void check_size(const TrilinearField& field, std::int64_t max_tets) {
    const std::int64_t tets = kuhn_tet_count(field);
    if (tets > max_tets) {
        fail(
            "the Kuhn split of {} x {} x {} cells has {} tets, more than the {} allowed "
            "(--max-tets, mesh.max_tets)",
            field.cell_count(0), field.cell_count(1), field.cell_count(2), tets, max_tets);
    }
    std::int64_t points = 1;
    for (int axis = 0; axis < 3; ++axis)
        points *= static_cast<std::int64_t>(field.planes(axis).size());
    if (points > std::numeric_limits<std::int32_t>::max()) {
        fail("the Kuhn split has {} points: expected fewer than 2^31", points);
    }
}

}  // namespace

std::int64_t kuhn_tet_count(const TrilinearField& field) {
    return std::int64_t{6} * field.cell_count(0) * field.cell_count(1) * field.cell_count(2);
}

MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets) {
    check_size(field, max_tets);
    const std::int32_t nx = field.cell_count(0) + 1, ny = field.cell_count(1) + 1;
    const std::int32_t nz = field.cell_count(2) + 1;
    const std::int32_t row = nx, slice = nx * ny;
    MeshData mesh;
    mesh.points.resize(static_cast<std::size_t>(slice) * nz);
    mesh.point_scalars = {{mesh_scalar_name, std::vector<double>(mesh.points.size())}};
    parallel_for(std::int64_t{ny} * nz, 64, [&](std::int64_t line) {
        const auto y = static_cast<std::int32_t>(line % ny);
        const auto z = static_cast<std::int32_t>(line / ny);
        for (std::int32_t x = 0; x < nx; ++x) {
            const auto point = static_cast<std::size_t>(line * nx + x);
            mesh.points[point] = {field.planes(0)[x], field.planes(1)[y], field.planes(2)[z]};
            mesh.point_scalars[0].values[point] = field.at_plane({x, y, z});
        }
    });

    mesh.tets.resize(static_cast<std::size_t>(kuhn_tet_count(field)));
    parallel_for(std::int64_t{ny - 1} * (nz - 1), 64, [&](std::int64_t line) {
        const auto y = static_cast<std::int32_t>(line % (ny - 1));
        const auto z = static_cast<std::int32_t>(line / (ny - 1));
        auto next = mesh.tets.begin() + 6 * line * (nx - 1);
        for (std::int32_t x = 0; x < nx - 1; ++x) {
            const std::int32_t first = z * slice + y * row + x;
            for (Tet tet : cell_tets) {
                for (std::int32_t& corner : tet) {
                    corner =
                        first + (corner & 1) + ((corner >> 1) & 1) * row + (corner >> 2) * slice;
                }
                *next++ = tet;
            }
        }
    });
    return mesh;
}

namespace {

// Share of the range of values up to which the error of a Kuhn split is measured.
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
