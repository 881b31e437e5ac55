// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "mesh/point_gradients.h"
#include "reference/mesh_tile.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

// No point of the mesh is farther from the eye.
double reach_of(const TetMesh& mesh, const View& view) {
    const glm::dvec3 lo = mesh.bounds().min - view.eye, hi = mesh.bounds().max - view.eye;
    return glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
}

// Marks tets with a value that is not finite. The list is empty where there are none.
std::vector<char> tets_without_value(const TetMesh& mesh, std::span<const double> scalar) {
    if (std::all_of(scalar.begin(), scalar.end(), [](double s) { return std::isfinite(s); }))
        return {};
    std::vector<char> marked;
    marked.reserve(mesh.tets().size());
    for (const Tet& tet : mesh.tets()) {
        marked.push_back(std::any_of(tet.begin(), tet.end(), [&](std::int32_t corner) {
            return !std::isfinite(scalar[static_cast<std::size_t>(corner)]);
        }));
    }
    return marked;
}

}  // namespace

MeshTraceResult trace_mesh(const TetMesh& mesh, const FaceTree& open_faces,
                           std::span<const double> scalar,
                           const TransferFunction& transfer_function, const View& view,
                           const TraceOptions& options, const TileDone& tile_done) {
    check(options);
    MeshTraceResult result{PreciseImage(view.width, view.height)};
    const TransferIntervals intervals(transfer_function);
    const std::vector<char> no_value = tets_without_value(mesh, scalar);
    std::vector<glm::dvec3> gradients;
    if (options.lighting) gradients = point_gradients(mesh, scalar);
    const MeshTile::Picture picture{mesh,      open_faces,          scalar,    no_value,
                                    gradients, transfer_function,   intervals, view,
                                    options,   reach_of(mesh, view)};
    const std::vector<PictureTile> tiles = tiles_to_trace(view.width, view.height);
    std::vector<MeshTile::Totals> totals(tiles.size());
    const auto trace = [&](const PictureTile& tile, std::size_t number, const RowDone& row_done) {
        totals[number] = MeshTile(picture, tile, result.image, row_done).trace();
    };
    trace_tiles(tiles, trace, result.image, tile_done);
    for (const MeshTile::Totals& tile : totals) {
        result.error_estimate = std::max(result.error_estimate, tile.error_estimate);
        result.segments += tile.segments;
        result.overlapping_rays += tile.overlapping;
    }
    return result;
}

}  // namespace lamina
